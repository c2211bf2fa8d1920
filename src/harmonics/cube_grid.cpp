#include "harmonics/cube_grid.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/flush_denormals.h"
#include "core/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "harmonics/cube_grid.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "harmonics/fourier-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mirrorball::detail {
namespace HWY_NAMESPACE {

/// One texel, RGBx.
using Texel = hn::FixedTag<float, 4>;
using TexelVec = hn::Vec<Texel>;

// Eight values `step` texels apart.
HWY_INLINE TexelVec weighted(const float* HWY_RESTRICT values, std::ptrdiff_t step,
                             const float* HWY_RESTRICT weights) {
    const Texel d;
    TexelVec a = hn::Mul(hn::Load(d, values), hn::Set(d, weights[0]));
    TexelVec b = hn::Mul(hn::Load(d, values + 4 * step), hn::Set(d, weights[1]));
    HWY_UNROLL(6)
    for (int i = 2; i < kTapCount; i += 2) {
        a = hn::MulAdd(hn::Load(d, values + 4 * i * step), hn::Set(d, weights[i]), a);
        b = hn::MulAdd(hn::Load(d, values + 4 * (i + 1) * step), hn::Set(d, weights[i + 1]), b);
    }
    return hn::Add(a, b);
}

HWY_INLINE void add_weighted(TexelVec value, float* HWY_RESTRICT values, std::ptrdiff_t step,
                             const float* HWY_RESTRICT weights) {
    const Texel d;
    HWY_UNROLL(8)
    for (int i = 0; i < kTapCount; ++i) {
        float* const to = values + 4 * i * step;
        hn::Store(hn::MulAdd(value, hn::Set(d, weights[i]), hn::Load(d, to)), d, to);
    }
}

HWY_INLINE void store_rgb(TexelVec value, float* to) {
    HWY_ALIGN float texel[4];
    hn::Store(value, Texel(), texel);
    std::memcpy(to, texel, 3 * sizeof(float));
}

HWY_INLINE TexelVec clamped(TexelVec value, const Range& range) {
    const Texel d;
    return hn::Min(hn::Max(value, hn::Load(d, range.lowest)), hn::Load(d, range.highest));
}

// Sides --------------------------------------------------------------------------------------

// Where the taps of (u, v) are: the right half mirrors the left one.
HWY_INLINE std::size_t mirrored(int u, int v, int size, int half) {
    return static_cast<std::size_t>(v) * half + std::min(u, size - 1 - u);
}

void make_side(const Block& block, int size, const TapList& rings, const float* columns,
               std::size_t stride, const Range& range, float* to, std::ptrdiff_t along_u,
               std::ptrdiff_t along_v) {
    const int half = (size + 1) / 2;
    for (int v = block.v0; v < block.v1; ++v) {
        for (int u = block.u0; u < block.u1; ++u) {
            const std::size_t at = mirrored(u, v, size, half);
            const float* const from = columns + (u * stride + rings.first[at]) * 4;
            const TexelVec value = weighted(from, 1, rings.weights.data() + at * kTapCount);
            store_rgb(clamped(value, range), to + u * along_u + v * along_v);
        }
    }
}

void spread_side(const Block& block, int size, const TapList& rings, const float* solid_angles,
                 const float* from, std::ptrdiff_t along_u, std::ptrdiff_t along_v,
                 float* columns, std::size_t stride) {
    const Texel d;
    const int half = (size + 1) / 2;
    for (int v = block.v0; v < block.v1; ++v) {
        const std::size_t from_middle = std::max(v, size - 1 - v) - size / 2;
        const float* const row = solid_angles + from_middle * half;
        for (int u = block.u0; u < block.u1; ++u) {
            const std::size_t at = mirrored(u, v, size, half);
            const float solid_angle = row[std::max(u, size - 1 - u) - size / 2];
            const TexelVec value = hn::Mul(hn::LoadU(d, from + u * along_u + v * along_v),
                                           hn::Set(d, solid_angle));
            add_weighted(value, columns + (u * stride + rings.first[at]) * 4, 1,
                         rings.weights.data() + at * kTapCount);
        }
    }
}

// Interpolates rings in the lanes of a group along psi, to a column of texels on each side.
// `north` and `south` are the group's rings on column 0 of the sides.
void scatter_sides(const float* const* planes, int column_count, int size, const TapList& taps,
                   float* north, float* south, std::size_t stride) {
    const Lanes d;
    const Vec zero = hn::Zero(d);
    for (int side = 0; side < 4; ++side) {
        for (int u = 0; u < size; ++u) {
            const float* const w = taps.weights.data() + static_cast<std::size_t>(u) * kTapCount;
            const int first = taps.first[u] + side * (column_count / 4) + column_count;
            Vec sums[6];
            for (int c = 0; c < 3; ++c) {
                Complexes sum{zero, zero};
                for (int i = 0; i < kTapCount; ++i)
                    sum = plus_scaled(sum, w[i], load(planes[c], (first + i) % column_count));
                sums[c] = sum.re, sums[3 + c] = hn::Reverse(d, sum.im);
            }
            const std::size_t at = (static_cast<std::size_t>(side) * size + u) * stride * 4;
            hn::StoreInterleaved4(sums[0], sums[1], sums[2], zero, d, north + at);
            hn::StoreInterleaved4(sums[3], sums[4], sums[5], zero, d, south + at);
        }
    }
}

void gather_sides(float* const* planes, int column_count, int size, const TapList& taps,
                  const float* north, const float* south, std::size_t stride) {
    const Lanes d;
    for (int u = 0; u < size; ++u) {
        const float* const w = taps.weights.data() + static_cast<std::size_t>(u) * kTapCount;
        for (int side = 0; side < 4; ++side) {
            const std::size_t at = (static_cast<std::size_t>(side) * size + u) * stride * 4;
            const int first = taps.first[u] + side * (column_count / 4) + column_count;
            Vec re[3], im[3], unused;
            hn::LoadInterleaved4(d, north + at, re[0], re[1], re[2], unused);
            hn::LoadInterleaved4(d, south + at, im[0], im[1], im[2], unused);
            for (int c = 0; c < 3; ++c) {
                const Complexes value{re[c], hn::Reverse(d, im[c])};
                for (int i = 0; i < kTapCount; ++i) {
                    const int k = (first + i) % column_count;
                    store(plus_scaled(load(planes[c], k), w[i], value), planes[c], k);
                }
            }
        }
    }
}

// Caps ---------------------------------------------------------------------------------------

void scatter_caps(const float* const* planes, int column_count, float* north, float* south,
                  std::size_t stride) {
    const Lanes d;
    const Vec zero = hn::Zero(d);
    for (int k = 0; k < column_count; ++k) {
        const Complexes r = load(planes[0], k), g = load(planes[1], k), b = load(planes[2], k);
        hn::StoreInterleaved4(r.re, g.re, b.re, zero, d, north + k * stride * 4);
        hn::StoreInterleaved4(r.im, g.im, b.im, zero, d, south + k * stride * 4);
    }
}

// Adds to planes.
void gather_caps(float* const* planes, int column_count, const float* north, const float* south,
                 std::size_t stride) {
    const Lanes d;
    for (int k = 0; k < column_count; ++k) {
        Vec re[3], im[3], unused;
        hn::LoadInterleaved4(d, north + k * stride * 4, re[0], re[1], re[2], unused);
        hn::LoadInterleaved4(d, south + k * stride * 4, im[0], im[1], im[2], unused);
        for (int c = 0; c < 3; ++c)
            store(load(planes[c], k) + Complexes{re[c], im[c]}, planes[c], k);
    }
}

// Texels at distances a0 <= a < a1 along the quadrant's axis. `middle` is the texel at a = 0 and
// b = 0; texel (a, b) is a * along + b * across values from it, and (a, -b) is
// a * along + to_negative - b * across.
void make_cap(const Quadrant& q, int a0, int a1, const float* cap, const Range& range,
              float* line, float* middle, std::ptrdiff_t along, std::ptrdiff_t across,
              std::ptrdiff_t to_negative, bool whole_middle) {
    const Texel d;
    const std::size_t width = 2 * q.reach + 1;
    for (int c = -q.reach; c <= q.reach; ++c) {
        const int column = (q.axis_column + c + q.column_count) % q.column_count;
        const float* const from = cap + column * q.stride * 4;
        for (int a = a0; a < a1; ++a) {
            const std::size_t at = static_cast<std::size_t>(a) * (q.reach + 1) + std::abs(c);
            const TexelVec value =
                weighted(from + q.rings->first[at] * 4, 1, q.rings->weights.data() + at * kTapCount);
            hn::Store(value, d, line + ((a - a0) * width + (c + q.reach)) * 4);
        }
    }
    for (int a = a0; a < a1; ++a) {
        const float* const centre = line + ((a - a0) * width + q.reach) * 4;
        float* const row = middle + a * along;
        for (int b = 0; b <= a; ++b) {
            const std::size_t at = static_cast<std::size_t>(a) * q.half + b;
            const float* const w = q.columns->weights.data() + at * kTapCount;
            const std::ptrdiff_t first = q.columns->first[at];
            if (a == 0 && q.size % 2 == 1 && !whole_middle) continue;
            store_rgb(clamped(weighted(centre + first * 4, 1, w), range), row + b * across);
            // the other side of the axis; its diagonal is the next quadrant's, its b = 0 this one
            if (b == a || (b == 0 && q.size % 2 == 1)) continue;
            store_rgb(clamped(weighted(centre - first * 4, -1, w), range),
                      row + to_negative - b * across);
        }
    }
}

void spread_cap(const Quadrant& q, int a0, int a1, const float* solid_angles, const float* middle,
                std::ptrdiff_t along, std::ptrdiff_t across, std::ptrdiff_t to_negative,
                bool whole_middle, float* line, float* cap) {
    const Texel d;
    const std::size_t width = 2 * q.reach + 1;
    std::memset(line, 0, (a1 - a0) * width * 4 * sizeof(float));
    for (int a = a0; a < a1; ++a) {
        float* const centre = line + ((a - a0) * width + q.reach) * 4;
        const float* const row = middle + a * along;
        for (int b = 0; b <= a; ++b) {
            const std::size_t at = static_cast<std::size_t>(a) * q.half + b;
            const float* const w = q.columns->weights.data() + at * kTapCount;
            const std::ptrdiff_t first = q.columns->first[at];
            const TexelVec solid_angle = hn::Set(d, solid_angles[at]);
            if (a == 0 && q.size % 2 == 1 && !whole_middle) continue;
            add_weighted(hn::Mul(hn::LoadU(d, row + b * across), solid_angle), centre + first * 4,
                         1, w);
            if (b == a || (b == 0 && q.size % 2 == 1)) continue;
            add_weighted(
                hn::Mul(hn::LoadU(d, row + to_negative - b * across), solid_angle),
                centre - first * 4, -1, w);
        }
    }
    for (int c = -q.reach; c <= q.reach; ++c) {
        const int column = (q.axis_column + c + q.column_count) % q.column_count;
        float* const to = cap + column * q.stride * 4;
        for (int a = a0; a < a1; ++a) {
            const std::size_t at = static_cast<std::size_t>(a) * (q.reach + 1) + std::abs(c);
            const TexelVec value = hn::Load(d, line + ((a - a0) * width + (c + q.reach)) * 4);
            add_weighted(value, to + q.rings->first[at] * 4, 1,
                         q.rings->weights.data() + at * kTapCount);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace mirrorball::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mirrorball::detail {
namespace {

HWY_EXPORT(make_side);
HWY_EXPORT(spread_side);
HWY_EXPORT(scatter_sides);
HWY_EXPORT(gather_sides);
HWY_EXPORT(scatter_caps);
HWY_EXPORT(gather_caps);
HWY_EXPORT(make_cap);
HWY_EXPORT(spread_cap);

constexpr int kBeyondPole = 4;  // rings
// Texels of a block of a side: its columns of rings stay in the cache while its rows are made.
constexpr int kBlock = 32;
constexpr int kLines = 8;  // across a quadrant, that are worked on at once

Range range_of(const Vec3f& lowest, const Vec3f& highest) {
    Range range{};
    for (int c = 0; c < 3; ++c) range.lowest[c] = lowest[c], range.highest[c] = highest[c];
    return range;
}

int blocks(int size) {
    return (size + kBlock - 1) / kBlock;
}

}  // namespace

bool place_cube(int size, const Axes& map_in_grid, CubePlacement& placement) {
    for (const Vec3d& axis : {map_in_grid.x, map_in_grid.y, map_in_grid.z}) {
        if (std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)}) < 1 - 1e-12)
            return false;
    }
    struct FaceOfGrid {
        Vec3d centre, along_u, along_v;
    };
    const Vec3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    const FaceOfGrid grid_faces[6] = {{z, x, -y},  {x, -z, -y}, {-z, -x, -y},
                                      {-x, z, -y}, {y, x, z},   {-y, x, z}};
    for (int f = 0; f < 6; ++f) {
        // the values' index of a texel a little off the middle of the face's first ones
        const auto index = [&](double u, double v, int& face) {
            const FaceOfGrid& g = grid_faces[f];
            const auto p =
                Cube::project(map_in_grid.to_map(g.centre + g.along_u * u + g.along_v * v));
            face = p.face;
            const auto px = static_cast<std::ptrdiff_t>(p.s * size);
            const auto py = static_cast<std::ptrdiff_t>(p.t * size);
            return 3 * (py * size + px);
        };
        const double first = 1.0 / size - 1, step = 2.0 / size;
        FacePlacement& to = placement[f];
        to.origin = index(first, first, to.face);
        to.along_u = to.along_v = 0;
        if (size > 1) {
            to.along_u = index(first + step, first, to.face) - to.origin;
            to.along_v = index(first, first + step, to.face) - to.origin;
        }
    }
    return true;
}

CubeGrid::CubeGrid(int size, const RingTransform& rings, std::span<const double> power)
    : scratch_(rings.scratch()),
      size_(size),
      half_((size + 1) / 2),
      ring_count_(rings.ring_count()),
      column_count_(rings.column_count()),
      lane_count_(rings.lane_count()),
      group_count_(rings.group_count()),
      cap_reach_(rings.column_count() / 8 + 5) {
    const TapDesign across_rings(power, kPi / ring_count_);
    const TapDesign along_rings(power, 2 * kPi / column_count_);
    const double rings_per_radian = ring_count_ / kPi;
    const double columns_per_radian = column_count_ / (2 * kPi);

    const int least_side_ring = std::max(0, ring_count_ / 4 - 5);
    first_side_ring_ = least_side_ring / lane_count_ * lane_count_;
    side_stride_ = static_cast<std::size_t>(ring_count_ - 2 * first_side_ring_);
    side_columns_ = TapList(size);
    for (int u = 0; u < size; ++u)
        side_columns_.set(u, std::atan(coordinate(u)) * columns_per_radian, along_rings);
    side_rings_ = TapList(static_cast<std::size_t>(size) * half_);
    parallel_for(size, [&](std::int64_t v) {
        for (int u = 0; u < half_; ++u) {
            const double a = coordinate(u), y = -coordinate(static_cast<int>(v));
            const double theta = std::atan2(std::sqrt(1 + a * a), y);
            side_rings_.set(static_cast<std::size_t>(v) * half_ + u,
                            theta * rings_per_radian - 0.5 - first_side_ring_, across_rings);
        }
    });

    const std::size_t reach = cap_reach_ + 1;
    cap_rings_ = TapList(half_ * reach);
    cap_columns_ = TapList(static_cast<std::size_t>(half_) * half_);
    parallel_for(half_, [&](std::int64_t i) {
        const double a = coordinate(size_ / 2 + static_cast<int>(i));
        for (std::size_t c = 0; c < reach; ++c) {
            const double theta = std::atan(a / std::cos(static_cast<double>(c) / columns_per_radian));
            cap_rings_.set(i * reach + c, theta * rings_per_radian - 0.5 + kBeyondPole,
                           across_rings);
        }
        for (int j = 0; j <= i; ++j) {
            const double b = coordinate(size_ / 2 + j);
            const double psi = a > 0 ? std::atan(b / a) : 0;
            cap_columns_.set(static_cast<std::size_t>(i) * half_ + j, psi * columns_per_radian,
                             along_rings);
        }
    });
    const int last = *std::max_element(cap_rings_.first.begin(), cap_rings_.first.end()) +
                     kTapCount - kBeyondPole;
    cap_group_count_ = std::min(group_count_, (last + lane_count_ - 1) / lane_count_);
    cap_stride_ = static_cast<std::size_t>(kBeyondPole + cap_group_count_ * lane_count_);

    const auto table = solid_angle_table(Projection::cube, size, size);
    solid_angles_.resize(static_cast<std::size_t>(half_) * half_);
    for (int v = 0; v < half_; ++v) {
        for (int u = 0; u < half_; ++u) {
            const std::size_t row = size / 2 + v;
            solid_angles_[static_cast<std::size_t>(v) * half_ + u] =
                static_cast<float>(table[row * size + size / 2 + u]);
        }
    }
}

CubeGrid::Buffers CubeGrid::make_buffers() const {
    return {ScratchArray(scratch_, 4 * side_stride_ * 4 * size_),
            ScratchArray(scratch_, 2 * cap_stride_ * 4 * column_count_)};
}

void CubeGrid::scatter_group(int group, const std::array<GroupValues, 3>& planes,
                             Buffers& buffers) const {
    const float* const from[3] = {planes[0].data(), planes[1].data(), planes[2].data()};
    const std::size_t ring = static_cast<std::size_t>(group) * lane_count_;
    if (group < cap_group_count_) {
        float* const north = buffers.caps.data() + (kBeyondPole + ring) * 4;
        HWY_DYNAMIC_DISPATCH(scatter_caps)
        (from, column_count_, north, north + cap_stride_ * 4 * column_count_, cap_stride_);
    }
    if (group >= first_group()) {
        float* const rings = buffers.sides.data();
        HWY_DYNAMIC_DISPATCH(scatter_sides)
        (from, column_count_, size_, side_columns_, rings + (ring - first_side_ring_) * 4,
         rings + (ring_count_ - ring - lane_count_ - first_side_ring_) * 4, side_stride_);
    }
}

void CubeGrid::gather_group(int group, const Buffers& buffers,
                            std::array<GroupValues, 3>& planes) const {
    float* const to[3] = {planes[0].data(), planes[1].data(), planes[2].data()};
    for (GroupValues& plane : planes) std::fill(plane.begin(), plane.end(), 0.0f);
    const std::size_t ring = static_cast<std::size_t>(group) * lane_count_;
    if (group < cap_group_count_) {
        const float* const north = buffers.caps.data() + (kBeyondPole + ring) * 4;
        HWY_DYNAMIC_DISPATCH(gather_caps)
        (to, column_count_, north, north + cap_stride_ * 4 * column_count_, cap_stride_);
    }
    if (group >= first_group()) {
        const float* const rings = buffers.sides.data();
        HWY_DYNAMIC_DISPATCH(gather_sides)
        (to, column_count_, size_, side_columns_, rings + (ring - first_side_ring_) * 4,
         rings + (ring_count_ - ring - lane_count_ - first_side_ring_) * 4, side_stride_);
    }
}

// Quadrants 0 to 3 have their axes along +z, +x, -z, -x, and b along +x, -z, -x, +z.
CubeGrid::QuadrantPlacement CubeGrid::place_quadrant(int cap, int quadrant,
                                                     const CubePlacement& placement) const {
    const FacePlacement& face = placement[4 + cap];
    const auto first = [&](bool positive) { return positive ? size_ / 2 : size_ - 1 - size_ / 2; };
    const bool along_is_v = quadrant % 2 == 0, along_up = quadrant < 2;
    const bool across_up = quadrant == 0 || quadrant == 3;
    const std::ptrdiff_t along = along_is_v ? face.along_v : face.along_u;
    const std::ptrdiff_t across = along_is_v ? face.along_u : face.along_v;
    return {face.face,
            face.origin + first(along_up) * along + first(across_up) * across,
            along_up ? along : -along, across_up ? across : -across};
}

void CubeGrid::make_texels(Buffers& buffers, const CubePlacement& placement, const Vec3f& lowest,
                           const Vec3f& highest, std::vector<Image>& faces) const {
    // rings beyond a pole are those before it, half way round
    for (int k = 0; k < 2 * column_count_; ++k) {
        const int cap = k / column_count_, column = k % column_count_;
        const int opposite = (column + column_count_ / 2) % column_count_;
        float* const to = buffers.caps.data() + k * cap_stride_ * 4;
        const float* const from =
            buffers.caps.data() + (cap * column_count_ + opposite) * cap_stride_ * 4;
        for (int i = 0; i < kBeyondPole; ++i)
            std::copy_n(from + (kBeyondPole + i) * 4, 4, to + (kBeyondPole - 1 - i) * 4);
    }
    const Range range = range_of(lowest, highest);
    const int per_side = blocks(size_) * blocks(size_);
    const int line_blocks = (half_ + kLines - 1) / kLines;
    parallel_for(4 * per_side + 8 * line_blocks, [&](std::int64_t task) {
        const FlushDenormals flush;
        if (task < 4 * per_side) {
            const int side = static_cast<int>(task) / per_side;
            const int block = static_cast<int>(task) % per_side;
            const int u = block % blocks(size_) * kBlock, v = block / blocks(size_) * kBlock;
            const Block texels{u, std::min(u + kBlock, size_), v, std::min(v + kBlock, size_)};
            const FacePlacement& face = placement[side];
            HWY_DYNAMIC_DISPATCH(make_side)
            (texels, size_, side_rings_,
             buffers.sides.data() + static_cast<std::size_t>(side) * size_ * side_stride_ * 4,
             side_stride_, range, faces[face.face].values().data() + face.origin, face.along_u,
             face.along_v);
            return;
        }
        const int which = static_cast<int>(task) - 4 * per_side;
        const int cap = which % 2, quadrant = which / 2 % 4, a = which / 8 * kLines;
        const QuadrantPlacement place = place_quadrant(cap, quadrant, placement);
        ScratchArray line(scratch_, static_cast<std::size_t>(kLines) * (2 * cap_reach_ + 1) * 4);
        const Quadrant q{size_,        half_,         cap_reach_,
                         column_count_, quadrant * column_count_ / 4, &cap_rings_,
                         &cap_columns_, cap_stride_};
        HWY_DYNAMIC_DISPATCH(make_cap)
        (q, a, std::min(a + kLines, half_),
         buffers.caps.data() + cap * cap_stride_ * 4 * column_count_, range, line.data(),
         faces[place.face].values().data() + place.middle, place.along, place.across,
         size_ % 2 == 0 ? -place.across : 0, quadrant == 0);
    });
}

void CubeGrid::spread_texels(const std::vector<Image>& faces, const CubePlacement& placement,
                             Buffers& buffers) const {
    std::fill(buffers.sides.begin(), buffers.sides.end(), 0.0f);
    std::fill(buffers.caps.begin(), buffers.caps.end(), 0.0f);
    const int side_blocks = blocks(size_);
    const auto spread_quadrant = [&](int cap, int quadrant) {
        const QuadrantPlacement place = place_quadrant(cap, quadrant, placement);
        ScratchArray line(scratch_, static_cast<std::size_t>(kLines) * (2 * cap_reach_ + 1) * 4);
        const Quadrant q{size_,        half_,         cap_reach_,
                         column_count_, quadrant * column_count_ / 4, &cap_rings_,
                         &cap_columns_, cap_stride_};
        for (int a = 0; a < half_; a += kLines) {
            HWY_DYNAMIC_DISPATCH(spread_cap)
            (q, a, std::min(a + kLines, half_), solid_angles_.data(),
             faces[place.face].values().data() + place.middle, place.along, place.across,
             size_ % 2 == 0 ? -place.across : 0, quadrant == 0, line.data(),
             buffers.caps.data() + cap * cap_stride_ * 4 * column_count_);
        }
    };
    // Neighbouring quadrants share columns of the grid, so they take turns.
    parallel_for(4 + 4 * side_blocks, [&](std::int64_t task) {
        const FlushDenormals flush;
        if (task < 4) return spread_quadrant(static_cast<int>(task) % 2, static_cast<int>(task) / 2 * 2);
        const int side = static_cast<int>(task - 4) / side_blocks;
        const int u = static_cast<int>(task - 4) % side_blocks * kBlock;
        const FacePlacement& face = placement[side];
        HWY_DYNAMIC_DISPATCH(spread_side)
        ({u, std::min(u + kBlock, size_), 0, size_}, size_, side_rings_, solid_angles_.data(),
         faces[face.face].values().data() + face.origin, face.along_u, face.along_v,
         buffers.sides.data() + static_cast<std::size_t>(side) * size_ * side_stride_ * 4,
         side_stride_);
    });
    parallel_for(4, [&](std::int64_t task) {
        const FlushDenormals flush;
        spread_quadrant(static_cast<int>(task) % 2, static_cast<int>(task) / 2 * 2 + 1);
    });
    for (int k = 0; k < 2 * column_count_; ++k) {
        const int cap = k / column_count_, column = k % column_count_;
        const int opposite = (column + column_count_ / 2) % column_count_;
        const float* const from = buffers.caps.data() + k * cap_stride_ * 4;
        float* const to =
            buffers.caps.data() + (cap * column_count_ + opposite) * cap_stride_ * 4;
        for (int i = 0; i < 4 * kBeyondPole; ++i)
            to[4 * (kBeyondPole + i / 4) + i % 4] += from[4 * (kBeyondPole - 1 - i / 4) + i % 4];
    }
}

}  // namespace mirrorball::detail
#endif
