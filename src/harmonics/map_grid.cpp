#include "harmonics/map_grid.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "core/flush_denormals.h"
#include "core/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "harmonics/map_grid.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "harmonics/fourier-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mirrorball::detail {
namespace HWY_NAMESPACE {

using Texel4 = hn::FixedTag<float, 4>;

// The value at a point from 8 x 8 of the grid: `rings` and `columns` are its weights, `from` the
// first ring on column 0.
void make_texel(const float* from, int first_column, int column_count, std::size_t stride,
                const float* rings, const float* columns, float* texel) {
    const Texel4 d;
    auto sum = hn::Zero(d);
    for (int i = 0; i < kTapCount; ++i) {
        const float* const column =
            from + static_cast<std::size_t>((first_column + i) % column_count) * stride * 4;
        auto along = hn::Zero(d);
        HWY_UNROLL(8)
        for (int k = 0; k < kTapCount; ++k)
            along = hn::MulAdd(hn::Load(d, column + 4 * k), hn::Set(d, rings[k]), along);
        sum = hn::MulAdd(along, hn::Set(d, columns[i]), sum);
    }
    hn::Store(sum, d, texel);
}

void spread_texel(const float* texel, float solid_angle, float* to, int first_column,
                  int column_count, std::size_t stride, const float* rings, const float* columns) {
    const Texel4 d;
    const auto value = hn::Mul(hn::LoadU(d, texel), hn::Set(d, solid_angle));
    for (int i = 0; i < kTapCount; ++i) {
        float* const column =
            to + static_cast<std::size_t>((first_column + i) % column_count) * stride * 4;
        const auto share = hn::Mul(value, hn::Set(d, columns[i]));
        HWY_UNROLL(8)
        for (int k = 0; k < kTapCount; ++k) {
            float* const at = column + 4 * k;
            hn::Store(hn::MulAdd(share, hn::Set(d, rings[k]), hn::Load(d, at)), d, at);
        }
    }
}

// The rings in the lanes of a group, to the columns of the grid and back. `north` is the first of
// them on column 0, `south` the mate of the last.
void scatter_rings(const float* const* planes, int column_count, float* north, float* south,
                   std::size_t stride) {
    const Lanes d;
    const Vec zero = hn::Zero(d);
    for (int k = 0; k < column_count; ++k) {
        const Complexes r = load(planes[0], k), g = load(planes[1], k), b = load(planes[2], k);
        hn::StoreInterleaved4(r.re, g.re, b.re, zero, d, north + k * stride * 4);
        hn::StoreInterleaved4(hn::Reverse(d, r.im), hn::Reverse(d, g.im), hn::Reverse(d, b.im),
                              zero, d, south + k * stride * 4);
    }
}

void gather_rings(const float* north, const float* south, int column_count, std::size_t stride,
                  float* const* planes) {
    const Lanes d;
    const std::size_t n = hn::Lanes(d);
    for (int k = 0; k < column_count; ++k) {
        Vec r, g, b, unused;
        hn::LoadInterleaved4(d, north + k * stride * 4, r, g, b, unused);
        hn::Store(r, d, planes[0] + 2 * n * k);
        hn::Store(g, d, planes[1] + 2 * n * k);
        hn::Store(b, d, planes[2] + 2 * n * k);
        hn::LoadInterleaved4(d, south + k * stride * 4, r, g, b, unused);
        hn::Store(hn::Reverse(d, r), d, planes[0] + 2 * n * k + n);
        hn::Store(hn::Reverse(d, g), d, planes[1] + 2 * n * k + n);
        hn::Store(hn::Reverse(d, b), d, planes[2] + 2 * n * k + n);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace mirrorball::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mirrorball::detail {
namespace {

HWY_EXPORT(make_texel);
HWY_EXPORT(spread_texel);
HWY_EXPORT(scatter_rings);
HWY_EXPORT(gather_rings);

constexpr int kBeyondPole = 4;  // rings
constexpr std::int64_t kTexelsPerTask = 2048;

}  // namespace

MapGrid::MapGrid(const MapShape& shape, const RingTransform& rings, const GridTaps& taps)
    : scratch_(rings.scratch()),
      ring_count_(rings.ring_count()),
      column_count_(rings.column_count()),
      lane_count_(rings.lane_count()),
      stride_(static_cast<std::size_t>(ring_count_ + 2 * kBeyondPole)) {
    const int width = shape.size, height = shape.size / aspect(shape.projection);
    const std::vector<double> solid_angles = solid_angle_table(shape.projection, width, height);
    struct Position {
        double ring, column;
    };
    std::vector<Texel> texels;
    std::vector<Position> positions;
    visit(shape.projection, [&](auto p) {
        using P = decltype(p);
        for (int face = 0; face < P::face_count; ++face) {
            for (int i = 0; i < width * height; ++i) {
                if (solid_angles[i] == 0) continue;
                const FacePoint<double> centre{face, (i % width + 0.5) / width,
                                               (i / width + 0.5) / height};
                const Vec3d d = shape.axes.to_world(P::direction(centre));
                const double theta = std::atan2(std::hypot(d.x, d.z), d.y);
                const double psi = std::atan2(d.x, d.z);
                const double turns = psi / (2 * kPi) + (psi < 0 ? 1 : 0);
                texels.push_back({face, 3 * i, static_cast<float>(solid_angles[i])});
                positions.push_back({theta * ring_count_ / kPi - 0.5, turns * column_count_});
            }
        }
    });

    // In blocks of columns, so that what blocks of the same parity add to does not overlap.
    const std::size_t block_count = static_cast<std::size_t>(column_count_) / 32 * 2;
    const auto block_of = [&](const Position& p) {
        const auto column = static_cast<std::size_t>(p.column) % column_count_;
        return column * block_count / column_count_;
    };
    block_begins_.resize(block_count + 1);
    for (const Position& p : positions) ++block_begins_[block_of(p) + 1];
    std::partial_sum(block_begins_.begin(), block_begins_.end(), block_begins_.begin());
    std::vector<std::size_t> next(block_begins_.begin(), block_begins_.end() - 1);
    texels_.resize(texels.size());
    std::vector<Position> sorted(positions.size());
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const std::size_t to = next[block_of(positions[i])]++;
        texels_[to] = texels[i], sorted[to] = positions[i];
    }

    rings_ = TapList(texels_.size());
    columns_ = TapList(texels_.size());
    for (std::size_t i = 0; i < texels_.size(); ++i) {
        rings_.set(i, sorted[i].ring + kBeyondPole, taps.along_columns);
        columns_.set(i, sorted[i].column + column_count_, taps.along_rings);
    }
}

MapGrid::Buffer MapGrid::make_buffer() const {
    return Buffer(scratch_, stride_ * 4 * column_count_);
}

void MapGrid::scatter_group(int group, const std::array<GroupValues, 3>& planes,
                            Buffer& buffer) const {
    const float* const from[3] = {planes[0].data(), planes[1].data(), planes[2].data()};
    const int ring = group * lane_count_;
    float* const rings = buffer.data() + 4 * kBeyondPole;
    HWY_DYNAMIC_DISPATCH(scatter_rings)
    (from, column_count_, rings + 4 * ring, rings + 4 * (ring_count_ - ring - lane_count_),
     stride_);
}

void MapGrid::make_texels(Buffer& buffer, const Vec3f& lowest, const Vec3f& highest,
                          std::vector<Image>& faces) const {
    // rings beyond a pole are those before it, half way round
    for (int column = 0; column < column_count_; ++column) {
        const int opposite = (column + column_count_ / 2) % column_count_;
        float* const to = buffer.data() + column * stride_ * 4;
        const float* const from = buffer.data() + opposite * stride_ * 4;
        const std::size_t last = stride_ - 1;
        for (std::size_t i = 0; i < kBeyondPole; ++i) {
            std::copy_n(from + (2 * kBeyondPole - 1 - i) * 4, 4, to + i * 4);
            std::copy_n(from + (last - (2 * kBeyondPole - 1 - i)) * 4, 4, to + (last - i) * 4);
        }
    }
    const auto count = static_cast<std::int64_t>(texels_.size());
    parallel_for((count + kTexelsPerTask - 1) / kTexelsPerTask, [&](std::int64_t task) {
        const FlushDenormals flush;
        const std::int64_t end = std::min(count, (task + 1) * kTexelsPerTask);
        for (std::int64_t i = task * kTexelsPerTask; i < end; ++i) {
            alignas(16) float rgb[4];
            HWY_DYNAMIC_DISPATCH(make_texel)
            (buffer.data() + 4 * static_cast<std::size_t>(rings_.first[i]), columns_.first[i],
             column_count_, stride_, rings_.weights.data() + i * kTapCount,
             columns_.weights.data() + i * kTapCount, rgb);
            float* const to = faces[texels_[i].face].values().data() + texels_[i].offset;
            for (int c = 0; c < 3; ++c) to[c] = std::clamp(rgb[c], lowest[c], highest[c]);
        }
    });
}

void MapGrid::spread_texels(const std::vector<Image>& faces, Buffer& buffer) const {
    std::fill(buffer.begin(), buffer.end(), 0.0f);
    const auto block_count = static_cast<std::int64_t>(block_begins_.size()) - 1;
    for (const int parity : {0, 1}) {
        parallel_for(block_count / 2, [&](std::int64_t half) {
            const FlushDenormals flush;
            const std::int64_t block = 2 * half + parity;
            for (std::size_t i = block_begins_[block]; i < block_begins_[block + 1]; ++i) {
                HWY_DYNAMIC_DISPATCH(spread_texel)
                (faces[texels_[i].face].values().data() + texels_[i].offset, texels_[i].solid_angle,
                 buffer.data() + 4 * static_cast<std::size_t>(rings_.first[i]), columns_.first[i],
                 column_count_, stride_, rings_.weights.data() + i * kTapCount,
                 columns_.weights.data() + i * kTapCount);
            }
        });
    }
    for (int column = 0; column < column_count_; ++column) {
        const int opposite = (column + column_count_ / 2) % column_count_;
        const float* const from = buffer.data() + column * stride_ * 4;
        float* const to = buffer.data() + opposite * stride_ * 4;
        const std::size_t last = stride_ - 1;
        for (std::size_t i = 0; i < kBeyondPole; ++i) {
            for (std::size_t c = 0; c < 4; ++c) {
                to[(2 * kBeyondPole - 1 - i) * 4 + c] += from[i * 4 + c];
                to[(last - (2 * kBeyondPole - 1 - i)) * 4 + c] += from[(last - i) * 4 + c];
            }
        }
    }
}

void MapGrid::gather_group(int group, const Buffer& buffer,
                           std::array<GroupValues, 3>& planes) const {
    float* const to[3] = {planes[0].data(), planes[1].data(), planes[2].data()};
    const int ring = group * lane_count_;
    const float* const rings = buffer.data() + 4 * kBeyondPole;
    HWY_DYNAMIC_DISPATCH(gather_rings)
    (rings + 4 * ring, rings + 4 * (ring_count_ - ring - lane_count_), column_count_, stride_, to);
}

}  // namespace mirrorball::detail
#endif
