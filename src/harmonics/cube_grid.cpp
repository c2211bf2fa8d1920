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

/// Eight weights spread over the channels of eight texels in a row, as many of which are in one
/// vector as fit.
class RowWeights {
    using Wide = hn::CappedTag<float, 16>;
    using WideVec = hn::Vec<Wide>;

  public:
    static constexpr int kVectorCount = 32 / hn::MaxLanes(Wide());

    /// If `reversed`, the last texel has the first weight.
    HWY_INLINE RowWeights(const float* weights, bool reversed) {
        for (int i = 0; i < kVectorCount; ++i) weights_[i] = spread(weights, i, reversed);
    }

    /// Sum over eight rows, by `across`, of the sums along them.
    HWY_INLINE TexelVec sum(const float* HWY_RESTRICT values, std::ptrdiff_t row,
                            const float* HWY_RESTRICT across) const {
        const Wide d;
        const std::size_t n = hn::Lanes(d);
        WideVec sums[kVectorCount];
        for (WideVec& s : sums) s = hn::Zero(d);
        HWY_UNROLL(8)
        for (int k = 0; k < kTapCount; ++k) {
            const WideVec w = hn::Set(d, across[k]);
            for (int i = 0; i < kVectorCount; ++i)
                sums[i] = hn::MulAdd(hn::LoadU(d, values + k * row + i * n), w, sums[i]);
        }
        WideVec all = hn::Mul(sums[0], weights_[0]);
        for (int i = 1; i < kVectorCount; ++i) all = hn::MulAdd(sums[i], weights_[i], all);
        return folded_texels(all);
    }

  private:
    // The i-th vector of weights, each in the lanes of one texel.
    static HWY_INLINE WideVec spread(const float* weights, int i, bool reversed) {
        const Wide d;
        if constexpr (kVectorCount == kTapCount) {
            return hn::Set(d, weights[reversed ? kTapCount - 1 - i : i]);
        } else {
            alignas(64) static constexpr std::int32_t kLanes[2][32] = {
                {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3,
                 4, 4, 4, 4, 5, 5, 5, 5, 6, 6, 6, 6, 7, 7, 7, 7},
                {7, 7, 7, 7, 6, 6, 6, 6, 5, 5, 5, 5, 4, 4, 4, 4,
                 3, 3, 3, 3, 2, 2, 2, 2, 1, 1, 1, 1, 0, 0, 0, 0}};
            const auto lanes =
                hn::SetTableIndices(d, kLanes[reversed ? 1 : 0] + i * hn::MaxLanes(d));
            return hn::TableLookupLanes(hn::LoadU(d, weights), lanes);
        }
    }

    // The sum of the texels in a vector.
    template <class V>
    static HWY_INLINE TexelVec folded_texels(V v) {
        const hn::DFromV<V> d;
        if constexpr (hn::MaxLanes(hn::DFromV<V>()) > 4) {
            const hn::Half<decltype(d)> half;
            return folded_texels(hn::Add(hn::LowerHalf(half, v), hn::UpperHalf(half, v)));
        } else {
            return v;
        }
    }

    WideVec weights_[kVectorCount];
};

// Sum of eight texels, `step` values apart.
HWY_INLINE TexelVec weighted(const float* HWY_RESTRICT values, std::ptrdiff_t step,
                             const float* HWY_RESTRICT weights) {
    const Texel d;
    TexelVec a = hn::Mul(hn::Load(d, values), hn::Set(d, weights[0]));
    TexelVec b = hn::Mul(hn::Load(d, values + step), hn::Set(d, weights[1]));
    HWY_UNROLL(6)
    for (int i = 2; i < kTapCount; i += 2) {
        a = hn::MulAdd(hn::Load(d, values + i * step), hn::Set(d, weights[i]), a);
        b = hn::MulAdd(hn::Load(d, values + (i + 1) * step), hn::Set(d, weights[i + 1]), b);
    }
    return hn::Add(a, b);
}

HWY_INLINE void add_weighted(TexelVec value, float* HWY_RESTRICT values, std::ptrdiff_t step,
                             const float* HWY_RESTRICT weights) {
    const Texel d;
    HWY_UNROLL(8)
    for (int i = 0; i < kTapCount; ++i) {
        float* const to = values + i * step;
        hn::Store(hn::MulAdd(value, hn::Set(d, weights[i]), hn::Load(d, to)), d, to);
    }
}

// Rings in lanes, as planes, to a texel on each of as many rows, and back.
HWY_INLINE void store_lanes(const float* r, const float* g, const float* b, float* to,
                            std::ptrdiff_t row) {
    const Texel d;
    const hn::FixedTag<double, 2> pairs;
    for (std::size_t i = 0; i < hn::Lanes(Lanes()); i += 4) {
        const auto r4 = hn::Load(d, r + i), g4 = hn::Load(d, g + i), b4 = hn::Load(d, b + i);
        const auto rg0 = hn::BitCast(pairs, hn::InterleaveLower(d, r4, g4));
        const auto rg2 = hn::BitCast(pairs, hn::InterleaveUpper(d, r4, g4));
        const auto bx0 = hn::BitCast(pairs, hn::InterleaveLower(d, b4, hn::Zero(d)));
        const auto bx2 = hn::BitCast(pairs, hn::InterleaveUpper(d, b4, hn::Zero(d)));
        float* const at = to + static_cast<std::ptrdiff_t>(i) * row;
        hn::Store(hn::BitCast(d, hn::InterleaveLower(pairs, rg0, bx0)), d, at);
        hn::Store(hn::BitCast(d, hn::InterleaveUpper(pairs, rg0, bx0)), d, at + row);
        hn::Store(hn::BitCast(d, hn::InterleaveLower(pairs, rg2, bx2)), d, at + 2 * row);
        hn::Store(hn::BitCast(d, hn::InterleaveUpper(pairs, rg2, bx2)), d, at + 3 * row);
    }
}

HWY_INLINE void load_lanes(const float* from, std::ptrdiff_t row, float* r, float* g, float* b) {
    const Texel d;
    const hn::FixedTag<double, 2> pairs;
    for (std::size_t i = 0; i < hn::Lanes(Lanes()); i += 4) {
        const float* const at = from + static_cast<std::ptrdiff_t>(i) * row;
        const auto t0 = hn::Load(d, at), t1 = hn::Load(d, at + row);
        const auto t2 = hn::Load(d, at + 2 * row), t3 = hn::Load(d, at + 3 * row);
        const auto rg01 = hn::BitCast(pairs, hn::InterleaveLower(d, t0, t1));
        const auto rg23 = hn::BitCast(pairs, hn::InterleaveLower(d, t2, t3));
        const auto bx01 = hn::BitCast(pairs, hn::InterleaveUpper(d, t0, t1));
        const auto bx23 = hn::BitCast(pairs, hn::InterleaveUpper(d, t2, t3));
        hn::Store(hn::BitCast(d, hn::InterleaveLower(pairs, rg01, rg23)), d, r + i);
        hn::Store(hn::BitCast(d, hn::InterleaveUpper(pairs, rg01, rg23)), d, g + i);
        hn::Store(hn::BitCast(d, hn::InterleaveLower(pairs, bx01, bx23)), d, b + i);
    }
}

HWY_INLINE void store_rgb(TexelVec value, float* to) {
    const hn::Half<Texel> pair;
    hn::StoreU(hn::LowerHalf(pair, value), pair, to);
    to[2] = hn::ExtractLane(value, 2);
}

HWY_INLINE TexelVec clamped(TexelVec value, const Range& range) {
    const Texel d;
    return hn::Min(hn::Max(value, hn::Load(d, range.lowest)), hn::Load(d, range.highest));
}

// Sides --------------------------------------------------------------------------------------

void make_side(const Block& block, int size, const TapList& rings, const float* columns,
               const Range& range, float* to, std::ptrdiff_t along_u, std::ptrdiff_t along_v) {
    for (int v = block.v0; v < block.v1; ++v) {
        for (int u = block.u0; u < block.u1; ++u) {
            const std::size_t at = side_tap(std::min(u, size - 1 - u), v, size);
            const float* const from = columns + rings.first[at] * kSideStride + 4 * (u - block.u0);
            const TexelVec value =
                weighted(from, kSideStride, rings.weights.data() + at * kTapCount);
            store_rgb(clamped(value, range), to + u * along_u + v * along_v);
        }
    }
}

void spread_side(const Block& block, int size, const TapList& rings, const float* solid_angles,
                 const float* from, std::ptrdiff_t along_u, std::ptrdiff_t along_v,
                 float* columns) {
    const Texel d;
    const int half = (size + 1) / 2;
    for (int v = block.v0; v < block.v1; ++v) {
        const std::size_t from_middle = std::max(v, size - 1 - v) - size / 2;
        const float* const row = solid_angles + from_middle * half;
        for (int u = block.u0; u < block.u1; ++u) {
            const std::size_t at = side_tap(std::min(u, size - 1 - u), v, size);
            const float solid_angle = row[std::max(u, size - 1 - u) - size / 2];
            const TexelVec value =
                hn::Mul(hn::LoadU(d, from + u * along_u + v * along_v), hn::Set(d, solid_angle));
            add_weighted(value, columns + rings.first[at] * kSideStride + 4 * (u - block.u0),
                         kSideStride, rings.weights.data() + at * kTapCount);
        }
    }
}

// Interpolates rings in the lanes of a group along psi, to a column of texels on each side.
// `offsets` are those of the columns of texels, from the group's first ring and from its mate.
void scatter_sides(const float* const* planes, int column_count, int size, const TapList& taps,
                   const std::size_t* offsets, float* north, float* south) {
    const Lanes d;
    HWY_ALIGN float lanes[6][16];
    for (int side = 0; side < 4; ++side) {
        for (int u = 0; u < size; ++u) {
            const float* const w = taps.weights.data() + static_cast<std::size_t>(u) * kTapCount;
            const int first = taps.first[u] + side * (column_count / 4) + column_count;
            for (int c = 0; c < 3; ++c) {
                Complexes sum{hn::Zero(d), hn::Zero(d)};
                for (int i = 0; i < kTapCount; ++i)
                    sum = plus_scaled(sum, w[i], load(planes[c], (first + i) % column_count));
                hn::Store(sum.re, d, lanes[c]);
                hn::Store(sum.im, d, lanes[3 + c]);
            }
            const std::size_t at = offsets[side * size + u];
            store_lanes(lanes[0], lanes[1], lanes[2], north + at, kSideStride);
            store_lanes(lanes[3], lanes[4], lanes[5], south + at, -kSideStride);
        }
    }
}

// Adds to planes.
void gather_sides(float* const* planes, int column_count, int size, const TapList& taps,
                  const std::size_t* offsets, const float* north, const float* south) {
    const Lanes d;
    HWY_ALIGN float lanes[6][16];
    for (int u = 0; u < size; ++u) {
        const float* const w = taps.weights.data() + static_cast<std::size_t>(u) * kTapCount;
        for (int side = 0; side < 4; ++side) {
            const std::size_t at = offsets[side * size + u];
            const int first = taps.first[u] + side * (column_count / 4) + column_count;
            load_lanes(north + at, kSideStride, lanes[0], lanes[1], lanes[2]);
            load_lanes(south + at, -kSideStride, lanes[3], lanes[4], lanes[5]);
            for (int c = 0; c < 3; ++c) {
                const Complexes value{hn::Load(d, lanes[c]), hn::Load(d, lanes[3 + c])};
                for (int i = 0; i < kTapCount; ++i) {
                    const int k = (first + i) % column_count;
                    store(plus_scaled(load(planes[c], k), w[i], value), planes[c], k);
                }
            }
        }
    }
}

// Caps ---------------------------------------------------------------------------------------

// `north` and `south` are the group's first ring on either cap.
void scatter_caps(const float* const* planes, int column_count, float* north, float* south,
                  std::ptrdiff_t stride) {
    const std::size_t n = hn::Lanes(Lanes());
    for (int k = 0; k < column_count + kTapCount; ++k) {
        const std::size_t at = 2 * n * (k < column_count ? k : k - column_count);
        store_lanes(planes[0] + at, planes[1] + at, planes[2] + at, north + 4 * k, stride);
        store_lanes(planes[0] + at + n, planes[1] + at + n, planes[2] + at + n, south + 4 * k,
                    stride);
    }
}

// Sets the planes.
void gather_caps(float* const* planes, int column_count, const float* north, const float* south,
                 std::ptrdiff_t stride) {
    const std::size_t n = hn::Lanes(Lanes());
    for (int k = 0; k < column_count; ++k) {
        const std::size_t at = 2 * n * k;
        load_lanes(north + 4 * k, stride, planes[0] + at, planes[1] + at, planes[2] + at);
        load_lanes(south + 4 * k, stride, planes[0] + at + n, planes[1] + at + n,
                   planes[2] + at + n);
    }
}

// Calls f(a, b, negative) for the texels at distance a along a quadrant's axis, b < 0 before b > 0.
// Each diagonal is one quadrant's, and so is the middle of a face with an odd number of texels.
template <class F>
HWY_INLINE void for_each_texel_of_line(const Quadrant& q, int a, const F& f) {
    const bool odd = q.size % 2 == 1;
    if (a == 0 && odd) {
        if (q.axis_column == 0) f(0, 0, false);
        return;
    }
    for (int b = a - 1; b >= (odd ? 1 : 0); --b) f(a, b, true);
    for (int b = 0; b <= a; ++b) f(a, b, false);
}

// Where the taps of texel (a, b) begin on the first ring of a cap.
HWY_INLINE std::ptrdiff_t first_tap(const Quadrant& q, std::size_t at, bool negative) {
    const int first = q.columns->first[at];
    const int column = q.axis_column + (negative ? -first - (kTapCount - 1) : first);
    return q.rings->first[at] * static_cast<std::ptrdiff_t>(q.stride) +
           4 * (column < 0 ? column + q.column_count : column);
}

// `middle` is the texel at a = 0 and b = 0; texel (a, b) is a * along + b * across values from it,
// and (a, -b) is a * along + to_negative - b * across.
void make_cap(const Quadrant& q, int a0, int a1, const float* cap, const Range& range,
              float* middle, std::ptrdiff_t along, std::ptrdiff_t across,
              std::ptrdiff_t to_negative) {
    const auto make_texel = [&](int a, int b, bool negative) HWY_ATTR {
        const std::size_t at = static_cast<std::size_t>(a) * q.half + b;
        const RowWeights weights(q.columns->weights.data() + at * kTapCount, negative);
        const TexelVec value =
            weights.sum(cap + first_tap(q, at, negative), static_cast<std::ptrdiff_t>(q.stride),
                        q.rings->weights.data() + at * kTapCount);
        float* const to = middle + a * along + (negative ? to_negative - b * across : b * across);
        store_rgb(clamped(value, range), to);
    };
    for (int a = a0; a < a1; ++a) for_each_texel_of_line(q, a, make_texel);
}

// `line` has room for a value on every column that a line crosses.
void spread_cap(const Quadrant& q, const float* solid_angles, const float* middle,
                std::ptrdiff_t along, std::ptrdiff_t across, std::ptrdiff_t to_negative,
                float* line, float* cap) {
    const Texel d;
    const std::size_t width = 2 * static_cast<std::size_t>(q.reach) + 1;
    float* const centre = line + 4 * q.reach;
    const auto add_texel = [&](int a, int b, bool negative) HWY_ATTR {
        const std::size_t at = static_cast<std::size_t>(a) * q.half + b;
        const float* const from =
            middle + a * along + (negative ? to_negative - b * across : b * across);
        const TexelVec value = hn::Mul(hn::LoadU(d, from), hn::Set(d, solid_angles[at]));
        const std::ptrdiff_t first = 4 * std::ptrdiff_t{q.columns->first[at]};
        add_weighted(value, centre + (negative ? -first : first), negative ? -4 : 4,
                     q.columns->weights.data() + at * kTapCount);
    };
    for (int a = 0; a < q.half; ++a) {
        std::memset(line, 0, width * 4 * sizeof(float));
        for_each_texel_of_line(q, a, add_texel);
        for (int c = -q.reach; c <= q.reach; ++c) {
            const std::size_t at = static_cast<std::size_t>(a) * (q.reach + 1) + std::abs(c);
            const int column = q.axis_column + (c < -q.axis_column ? c + q.column_count : c);
            add_weighted(hn::Load(d, centre + 4 * c),
                         cap + q.line_rings->first[at] * q.stride + 4 * column,
                         static_cast<std::ptrdiff_t>(q.stride),
                         q.line_rings->weights.data() + at * kTapCount);
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
constexpr int kLines = 8;       // across a quadrant, to a task

Range range_of(const Vec3f& lowest, const Vec3f& highest) {
    Range range{};
    for (int c = 0; c < 3; ++c) range.lowest[c] = lowest[c], range.highest[c] = highest[c];
    return range;
}

// Values from a ring of `count` texels to the next: not a multiple of a page, or all eight taps
// would fall on the same lines of a cache.
std::size_t padded(int count) {
    return 16 * ((static_cast<std::size_t>(count) + 3) / 4 | 1);
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
      group_count_(rings.group_count()) {
    const TapDesign across_rings(power, kPi / ring_count_);
    const TapDesign along_rings(power, 2 * kPi / column_count_);
    const double rings_per_radian = ring_count_ / kPi;
    const double columns_per_radian = column_count_ / (2 * kPi);

    const int least_side_ring = std::max(0, ring_count_ / 4 - 5);
    first_side_ring_ = least_side_ring / lane_count_ * lane_count_;
    side_ring_count_ = ring_count_ - 2 * first_side_ring_;
    side_offsets_.resize(4 * static_cast<std::size_t>(size));
    for (int i = 0; i < 4 * size; ++i) side_offsets_[i] = side_offset(i / size, i % size);
    side_columns_ = TapList(size);
    for (int u = 0; u < size; ++u)
        side_columns_.set(u, std::atan(coordinate(u)) * columns_per_radian, along_rings);
    side_rings_ = TapList(side_tap(half_ - 1, size - 1, size) + 1);
    parallel_for(size, [&](std::int64_t v) {
        for (int u = 0; u < half_; ++u) {
            const double a = coordinate(u), y = -coordinate(static_cast<int>(v));
            const double theta = std::atan2(std::sqrt(1 + a * a), y);
            side_rings_.set(side_tap(u, static_cast<int>(v), size),
                            theta * rings_per_radian - 0.5 - first_side_ring_, across_rings);
        }
    });

    cap_rings_ = TapList(static_cast<std::size_t>(half_) * half_);
    cap_columns_ = TapList(static_cast<std::size_t>(half_) * half_);
    parallel_for(half_, [&](std::int64_t i) {
        const double a = coordinate(size_ / 2 + static_cast<int>(i));
        for (int j = 0; j <= i; ++j) {
            const double b = coordinate(size_ / 2 + j);
            const std::size_t at = static_cast<std::size_t>(i) * half_ + j;
            const double theta = std::atan(std::hypot(a, b));
            const double psi = a > 0 ? std::atan(b / a) : 0;
            cap_rings_.set(at, theta * rings_per_radian - 0.5 + kBeyondPole, across_rings);
            cap_columns_.set(at, psi * columns_per_radian, along_rings);
        }
    });
    reach_ = column_count_ / 8 + kTapCount;
    const std::size_t reach = static_cast<std::size_t>(reach_) + 1;
    line_rings_ = TapList(half_ * reach);
    parallel_for(half_, [&](std::int64_t i) {
        const double a = coordinate(size_ / 2 + static_cast<int>(i));
        for (std::size_t c = 0; c < reach; ++c) {
            const double psi = static_cast<double>(c) / columns_per_radian;
            line_rings_.set(i * reach + c,
                            std::atan(a / std::cos(psi)) * rings_per_radian - 0.5 + kBeyondPole,
                            across_rings);
        }
    });
    const int last = *std::max_element(line_rings_.first.begin(), line_rings_.first.end()) +
                     kTapCount - kBeyondPole;
    cap_group_count_ = std::min(group_count_, (last + lane_count_ - 1) / lane_count_);
    cap_ring_count_ = kBeyondPole + cap_group_count_ * lane_count_;
    cap_stride_ = padded(column_count_ + kTapCount);

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
    return {ScratchArray(scratch_, 4 * static_cast<std::size_t>(blocks(size_)) * kSideStride *
                                       side_ring_count_),
            ScratchArray(scratch_, 2 * cap_stride_ * cap_ring_count_)};
}

std::size_t CubeGrid::side_offset(int side, int u) const {
    const std::size_t block = static_cast<std::size_t>(side) * blocks(size_) + u / kBlock;
    return block * side_ring_count_ * kSideStride + 4 * static_cast<std::size_t>(u % kBlock);
}

void CubeGrid::scatter_group(int group, const std::array<GroupValues, 3>& planes,
                             Buffers& buffers) const {
    const float* const from[3] = {planes[0].data(), planes[1].data(), planes[2].data()};
    const int ring = group * lane_count_;
    if (group < cap_group_count_) {
        float* const north = buffers.caps.data() + (kBeyondPole + ring) * cap_stride_;
        HWY_DYNAMIC_DISPATCH(scatter_caps)
        (from, column_count_, north, north + cap_ring_count_ * cap_stride_,
         static_cast<std::ptrdiff_t>(cap_stride_));
    }
    if (group >= first_group()) {
        float* const rings = buffers.sides.data();
        const int north = ring - first_side_ring_;
        HWY_DYNAMIC_DISPATCH(scatter_sides)
        (from, column_count_, size_, side_columns_, side_offsets_.data(),
         rings + north * kSideStride, rings + (side_ring_count_ - 1 - north) * kSideStride);
    }
}

void CubeGrid::gather_group(int group, const Buffers& buffers,
                            std::array<GroupValues, 3>& planes) const {
    float* const to[3] = {planes[0].data(), planes[1].data(), planes[2].data()};
    const int ring = group * lane_count_;
    if (group < cap_group_count_) {
        const float* const north = buffers.caps.data() + (kBeyondPole + ring) * cap_stride_;
        HWY_DYNAMIC_DISPATCH(gather_caps)
        (to, column_count_, north, north + cap_ring_count_ * cap_stride_,
         static_cast<std::ptrdiff_t>(cap_stride_));
    } else {
        for (GroupValues& plane : planes) std::fill(plane.begin(), plane.end(), 0.0f);
    }
    if (group >= first_group()) {
        const float* const rings = buffers.sides.data();
        const int north = ring - first_side_ring_;
        HWY_DYNAMIC_DISPATCH(gather_sides)
        (to, column_count_, size_, side_columns_, side_offsets_.data(), rings + north * kSideStride,
         rings + (side_ring_count_ - 1 - north) * kSideStride);
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
    return {face.face, face.origin + first(along_up) * along + first(across_up) * across,
            along_up ? along : -along, across_up ? across : -across};
}

void CubeGrid::make_texels(Buffers& buffers, const CubePlacement& placement, const Vec3f& lowest,
                           const Vec3f& highest, std::vector<Image>& faces) const {
    // rings beyond a pole are those before it, half way round
    const int half_way = column_count_ / 2;
    for (int i = 0; i < 2 * kBeyondPole; ++i) {
        float* const cap = buffers.caps.data() + i % 2 * cap_ring_count_ * cap_stride_;
        const float* const from = cap + (kBeyondPole + i / 2) * cap_stride_;
        float* const to = cap + (kBeyondPole - 1 - i / 2) * cap_stride_;
        std::copy_n(from, 4 * half_way, to + 4 * half_way);
        std::copy_n(from + 4 * half_way, 4 * half_way, to);
        std::copy_n(to, 4 * kTapCount, to + 4 * column_count_);
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
            (texels, size_, side_rings_, buffers.sides.data() + side_offset(side, u), range,
             faces[face.face].values().data() + face.origin, face.along_u, face.along_v);
            return;
        }
        const int which = static_cast<int>(task) - 4 * per_side;
        const int cap = which % 2, quadrant = which / 2 % 4, a = which / 8 * kLines;
        const QuadrantPlacement place = place_quadrant(cap, quadrant, placement);
        const Quadrant q{size_,       half_,         column_count_, quadrant * column_count_ / 4,
                         &cap_rings_, &cap_columns_, &line_rings_,  reach_,
                         cap_stride_};
        HWY_DYNAMIC_DISPATCH(make_cap)
        (q, a, std::min(a + kLines, half_),
         buffers.caps.data() + cap * cap_ring_count_ * cap_stride_, range,
         faces[place.face].values().data() + place.middle, place.along, place.across,
         size_ % 2 == 0 ? -place.across : 0);
    });
}

void CubeGrid::spread_texels(const std::vector<Image>& faces, const CubePlacement& placement,
                             Buffers& buffers) const {
    std::fill(buffers.sides.begin(), buffers.sides.end(), 0.0f);
    std::fill(buffers.caps.begin(), buffers.caps.end(), 0.0f);
    const int side_blocks = blocks(size_);
    const auto spread_quadrant = [&](int cap, int quadrant) {
        const QuadrantPlacement place = place_quadrant(cap, quadrant, placement);
        const Quadrant q{size_,       half_,         column_count_, quadrant * column_count_ / 4,
                         &cap_rings_, &cap_columns_, &line_rings_,  reach_,
                         cap_stride_};
        ScratchArray line(scratch_, 4 * (2 * static_cast<std::size_t>(reach_) + 1));
        HWY_DYNAMIC_DISPATCH(spread_cap)
        (q, solid_angles_.data(), faces[place.face].values().data() + place.middle, place.along,
         place.across, size_ % 2 == 0 ? -place.across : 0, line.data(),
         buffers.caps.data() + cap * cap_ring_count_ * cap_stride_);
    };
    // Neighbouring quadrants share columns of the grid, so they take turns.
    parallel_for(4 + 4 * side_blocks, [&](std::int64_t task) {
        const FlushDenormals flush;
        if (task < 4)
            return spread_quadrant(static_cast<int>(task) % 2, static_cast<int>(task) / 2 * 2);
        const int side = static_cast<int>(task - 4) / side_blocks;
        const int u = static_cast<int>(task - 4) % side_blocks * kBlock;
        const FacePlacement& face = placement[side];
        HWY_DYNAMIC_DISPATCH(spread_side)
        ({u, std::min(u + kBlock, size_), 0, size_}, size_, side_rings_, solid_angles_.data(),
         faces[face.face].values().data() + face.origin, face.along_u, face.along_v,
         buffers.sides.data() + side_offset(side, u));
    });
    parallel_for(4, [&](std::int64_t task) {
        const FlushDenormals flush;
        spread_quadrant(static_cast<int>(task) % 2, static_cast<int>(task) / 2 * 2 + 1);
    });
    // what went beyond the last column or beyond the pole belongs elsewhere
    for (int ring = 0; ring < 2 * cap_ring_count_; ++ring) {
        float* const first = buffers.caps.data() + ring * cap_stride_;
        for (int k = 0; k < 4 * kTapCount; ++k) first[k] += first[4 * column_count_ + k];
    }
    const int half_way = column_count_ / 2;
    for (int i = 0; i < 2 * kBeyondPole; ++i) {
        float* const cap = buffers.caps.data() + i % 2 * cap_ring_count_ * cap_stride_;
        const float* const from = cap + (kBeyondPole - 1 - i / 2) * cap_stride_;
        float* const to = cap + (kBeyondPole + i / 2) * cap_stride_;
        for (int k = 0; k < 4 * half_way; ++k) {
            to[4 * half_way + k] += from[k];
            to[k] += from[4 * half_way + k];
        }
    }
}

}  // namespace mirrorball::detail
#endif
