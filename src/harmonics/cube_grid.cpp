#include "harmonics/cube_grid.h"

#include <algorithm>
#include <cmath>

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

using Texel = hn::FixedTag<float, 4>;

/// A texel of each quadrant, in as many vectors as sixteen values take.
class Quad {
    using Wide = hn::CappedTag<float, 16>;
    static constexpr std::size_t kLanes = hn::MaxLanes(Wide());
    static constexpr std::size_t kCount = 16 / kLanes;

  public:
    static HWY_INLINE Quad load(const float* values) {
        Quad q;
        for (std::size_t i = 0; i < kCount; ++i) q.v_[i] = hn::Load(Wide(), values + i * kLanes);
        return q;
    }
    HWY_INLINE void store(float* values) const {
        for (std::size_t i = 0; i < kCount; ++i) hn::Store(v_[i], Wide(), values + i * kLanes);
    }
    template <class T>  // four floats; as a template, only the branch that there is gets compiled
    static HWY_INLINE Quad of(T t0, T t1, T t2, T t3) {
        Quad q;
        if constexpr (kCount == 4) {
            q.v_[0] = t0, q.v_[1] = t1, q.v_[2] = t2, q.v_[3] = t3;
        } else {
            const hn::CappedTag<float, 8> pair;
            const auto low = hn::Combine(pair, t1, t0), high = hn::Combine(pair, t3, t2);
            if constexpr (kCount == 2)
                q.v_[0] = low, q.v_[1] = high;
            else
                q.v_[0] = hn::Combine(Wide(), high, low);
        }
        return q;
    }

    HWY_INLINE Quad times(float weight) const {
        Quad q;
        for (std::size_t i = 0; i < kCount; ++i) q.v_[i] = hn::Mul(v_[i], hn::Set(Wide(), weight));
        return q;
    }
    HWY_INLINE Quad plus(const Quad& other) const {
        Quad q;
        for (std::size_t i = 0; i < kCount; ++i) q.v_[i] = hn::Add(v_[i], other.v_[i]);
        return q;
    }
    HWY_INLINE Quad plus_scaled(float weight, const Quad& other) const {
        Quad q;
        for (std::size_t i = 0; i < kCount; ++i)
            q.v_[i] = hn::MulAdd(other.v_[i], hn::Set(Wide(), weight), v_[i]);
        return q;
    }
    HWY_INLINE Quad clamped(const Quad& lowest, const Quad& highest) const {
        Quad q;
        for (std::size_t i = 0; i < kCount; ++i)
            q.v_[i] = hn::Min(hn::Max(v_[i], lowest.v_[i]), highest.v_[i]);
        return q;
    }

  private:
    hn::Vec<Wide> v_[kCount];
};

HWY_INLINE Quad spread(const Vec3f& value) {
    HWY_ALIGN float values[16] = {};
    for (int q = 0; q < 4; ++q)
        for (int c = 0; c < 3; ++c) values[4 * q + c] = value[c];
    return Quad::load(values);
}

// Sum of eight, `step` values apart.
HWY_INLINE Quad weighted(const float* HWY_RESTRICT values, std::ptrdiff_t step,
                         const float* HWY_RESTRICT weights) {
    Quad even = Quad::load(values).times(weights[0]);
    Quad odd = Quad::load(values + step).times(weights[1]);
    HWY_UNROLL(3)
    for (int i = 2; i < kTapCount; i += 2) {
        even = even.plus_scaled(weights[i], Quad::load(values + i * step));
        odd = odd.plus_scaled(weights[i + 1], Quad::load(values + (i + 1) * step));
    }
    return even.plus(odd);
}

HWY_INLINE void add_weighted(const Quad& value, float* HWY_RESTRICT values, std::ptrdiff_t step,
                             const float* HWY_RESTRICT weights) {
    HWY_UNROLL(8)
    for (int i = 0; i < kTapCount; ++i) {
        float* const to = values + i * step;
        Quad::load(to).plus_scaled(weights[i], value).store(to);
    }
}

// Nodes ------------------------------------------------------------------------------------------

// `rings` is the axis's column on the first ring, `nodes` the node on the axis; columns [c0, c1).
void read_nodes(const CubeGrid::Line& line, int c0, int c1, const float* rings,
                std::ptrdiff_t stride, float* nodes) {
    for (int c = c0; c < c1; ++c) {
        const int at = std::abs(c);
        weighted(rings + line.node_first[at] * stride + 16 * c, stride,
                 line.node_weights + at * kTapCount)
            .store(nodes + 16 * c);
    }
}

void add_nodes(const CubeGrid::Line& line, int c0, int c1, const float* nodes,
               std::ptrdiff_t stride, float* rings) {
    for (int c = c0; c < c1; ++c) {
        const int at = std::abs(c);
        add_weighted(Quad::load(nodes + 16 * c), rings + line.node_first[at] * stride + 16 * c,
                     stride, line.node_weights + at * kTapCount);
    }
}

// Texels -----------------------------------------------------------------------------------------

// `nodes` is the first of the line's.
void read_texels(const CubeGrid::Line& line, const float* nodes, const Vec3f& lowest,
                 const Vec3f& highest, float* const* texels) {
    const Quad least = spread(lowest), most = spread(highest);
    for (int i = 0; i < line.count; ++i) {
        HWY_ALIGN float values[16];
        weighted(nodes + 16 * line.first[i], 16, line.weights + i * kTapCount)
            .clamped(least, most)
            .store(values);
        for (int q = 0; q < 4; ++q)
            std::copy_n(values + 4 * q, 3, texels[q] + i * line.places[q].step);
    }
}

void add_texels(const CubeGrid::Line& line, const float* const* texels, float* nodes) {
    const auto texel = [&](int i, int q) HWY_ATTR {
        return hn::LoadU(Texel(), texels[q] + i * line.places[q].step);
    };
    for (int i = 0; i < line.count; ++i) {
        const Quad value = Quad::of(texel(i, 0), texel(i, 1), texel(i, 2), texel(i, 3));
        add_weighted(value.times(line.solid_angles[i]), nodes + 16 * line.first[i], 16,
                     line.weights + i * kTapCount);
    }
}

// Rings ------------------------------------------------------------------------------------------

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

// Adds to the planes.
HWY_INLINE void add_lanes(const float* from, std::ptrdiff_t row, float* r, float* g, float* b) {
    const Texel d;
    const hn::FixedTag<double, 2> pairs;
    const auto add = [&](auto low, auto high, bool upper, float* to) HWY_ATTR {
        const auto sum =
            upper ? hn::InterleaveUpper(pairs, low, high) : hn::InterleaveLower(pairs, low, high);
        hn::Store(hn::Add(hn::Load(d, to), hn::BitCast(d, sum)), d, to);
    };
    for (std::size_t i = 0; i < hn::Lanes(Lanes()); i += 4) {
        const float* const at = from + static_cast<std::ptrdiff_t>(i) * row;
        const auto t0 = hn::Load(d, at), t1 = hn::Load(d, at + row);
        const auto t2 = hn::Load(d, at + 2 * row), t3 = hn::Load(d, at + 3 * row);
        const auto rg01 = hn::BitCast(pairs, hn::InterleaveLower(d, t0, t1));
        const auto rg23 = hn::BitCast(pairs, hn::InterleaveLower(d, t2, t3));
        const auto bx01 = hn::BitCast(pairs, hn::InterleaveUpper(d, t0, t1));
        const auto bx23 = hn::BitCast(pairs, hn::InterleaveUpper(d, t2, t3));
        add(rg01, rg23, false, r + i);
        add(rg01, rg23, true, g + i);
        add(bx01, bx23, false, b + i);
    }
}

// The grid's column that lies `c` columns off a quadrant's axis.
HWY_INLINE std::size_t column_of(int quadrant, int c, int column_count) {
    return (quadrant * (column_count / 4) + c + column_count) % column_count;
}

// `north` and `south` are the first quadrant's axis on the group's first ring and on its mate.
void scatter_rings(const float* const* planes, int column_count, int reach, std::ptrdiff_t stride,
                   float* north, float* south) {
    const std::size_t n = hn::Lanes(Lanes());
    for (int c = -reach; c <= reach; ++c) {
        for (int q = 0; q < 4; ++q) {
            const std::size_t from = 2 * n * column_of(q, c, column_count);
            const float *r = planes[0] + from, *g = planes[1] + from, *b = planes[2] + from;
            store_lanes(r, g, b, north + 16 * c + 4 * q, stride);
            store_lanes(r + n, g + n, b + n, south + 16 * c + 4 * q, -stride);
        }
    }
}

// Columns between two axes are in both quadrants; adds up what they hold.
void gather_rings(const float* north, const float* south, std::ptrdiff_t stride, int reach,
                  int column_count, float* const* planes) {
    const std::size_t n = hn::Lanes(Lanes());
    for (int p = 0; p < 3; ++p) std::fill_n(planes[p], 2 * n * column_count, 0.0f);
    for (int c = -reach; c <= reach; ++c) {
        for (int q = 0; q < 4; ++q) {
            const std::size_t to = 2 * n * column_of(q, c, column_count);
            float *r = planes[0] + to, *g = planes[1] + to, *b = planes[2] + to;
            add_lanes(north + 16 * c + 4 * q, stride, r, g, b);
            add_lanes(south + 16 * c + 4 * q, -stride, r + n, g + n, b + n);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace mirrorball::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mirrorball::detail {
namespace {

HWY_EXPORT(read_nodes);
HWY_EXPORT(add_nodes);
HWY_EXPORT(read_texels);
HWY_EXPORT(add_texels);
HWY_EXPORT(scatter_rings);
HWY_EXPORT(gather_rings);

constexpr int kBeyondPole = 4;  // rings

// What is worked on together stays in a processor's cache: eight rings of some columns, for nodes;
// the nodes of some lines.
constexpr int kColumns = 32;
constexpr int kLinesRead = 16, kLinesAdded = 96;

// Values from a ring of so many quadruples to the next: not a multiple of a page, or the eight
// rings of a node would fall on the same lines of a cache.
std::size_t padded(int count) {
    return 16 * (static_cast<std::size_t>(count) | 1);
}

int blocks(int count, int block) {
    return (count + block - 1) / block;
}

}  // namespace

std::optional<CubePlacement> place_cube(const MapShape& shape) {
    if (shape.projection != Projection::cube) return {};
    for (const Vec3d& axis : {shape.axes.x, shape.axes.y, shape.axes.z}) {
        if (std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)}) < 1 - 1e-12) return {};
    }
    struct FaceOfGrid {
        Vec3d centre, along_u, along_v;
    };
    const Vec3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    const FaceOfGrid grid_faces[6] = {{z, x, -y},  {x, -z, -y}, {-z, -x, -y},
                                      {-x, z, -y}, {y, x, z},   {-y, x, z}};
    const int size = shape.size;
    CubePlacement placement;
    for (int f = 0; f < 6; ++f) {
        const auto index = [&](double u, double v, int& face) {
            const FaceOfGrid& g = grid_faces[f];
            const auto p =
                Cube::project(shape.axes.to_map(g.centre + g.along_u * u + g.along_v * v));
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
    return placement;
}

CubeGrid::CubeGrid(int size, const CubePlacement& placement, const RingTransform& rings,
                   const GridTaps& taps, GridUse use)
    : scratch_(rings.scratch()),
      placement_(placement),
      size_(size),
      half_((size + 1) / 2),
      ring_count_(rings.ring_count()),
      column_count_(rings.column_count()),
      lane_count_(rings.lane_count()),
      reach_(column_count_ / 8 + kTapCount),
      stride_(padded(node_count())) {
    place_sides(taps);
    place_caps(taps);
    if (use == GridUse::analysis) weigh_texels();
}

void CubeGrid::place_sides(const GridTaps& taps) {
    const double rings_per_radian = ring_count_ / kPi;
    const double columns_per_radian = column_count_ / (2 * kPi);
    side_nodes_ = TapList(static_cast<std::size_t>(size_) * (reach_ + 1));
    parallel_for(size_, [&](std::int64_t v) {
        const double y = -coordinate(static_cast<int>(v));
        for (int c = 0; c <= reach_; ++c) {
            const double theta = std::atan2(1 / std::cos(c / columns_per_radian), y);
            side_nodes_.set(v * (reach_ + 1) + c, theta * rings_per_radian - 0.5 + kBeyondPole,
                            taps.along_columns);
        }
    });
    side_texels_ = TapList(size_);
    for (int u = 0; u < size_; ++u) {
        side_texels_.set(u, std::atan(coordinate(u)) * columns_per_radian + reach_,
                         taps.along_rings);
    }
}

// Line i of a quadrant is i texels off the middle and as long as the quadrant is wide there: of its
// two ends, on the face's diagonals, it has the last.
void CubeGrid::place_caps(const GridTaps& taps) {
    const double rings_per_radian = ring_count_ / kPi;
    const double columns_per_radian = column_count_ / (2 * kPi);
    const bool odd = size_ % 2 == 1;
    cap_begins_.resize(half_ + 1);
    for (int i = 0; i < half_; ++i)
        cap_begins_[i + 1] = cap_begins_[i] + (odd ? std::max(1, 2 * i) : 2 * i + 1);
    cap_nodes_ = TapList(static_cast<std::size_t>(half_) * (reach_ + 1));
    cap_texels_ = TapList(cap_begins_[half_]);
    parallel_for(half_, [&](std::int64_t i) {
        const int last = size_ / 2 + static_cast<int>(i);
        const double a = coordinate(last);
        for (int c = 0; c <= reach_; ++c) {
            const double theta = std::atan(a / std::cos(c / columns_per_radian));
            cap_nodes_.set(i * (reach_ + 1) + c, theta * rings_per_radian - 0.5 + kBeyondPole,
                           taps.along_columns);
        }
        for (std::size_t at = cap_begins_[i]; at < cap_begins_[i + 1]; ++at) {
            const double b = coordinate(last - static_cast<int>(cap_begins_[i + 1] - 1 - at));
            const double psi = a > 0 ? std::atan(b / a) : 0;
            cap_texels_.set(at, psi * columns_per_radian + reach_, taps.along_rings);
        }
    });
}

void CubeGrid::weigh_texels() {
    const auto table = solid_angle_table(Projection::cube, size_, size_);
    const std::size_t middle = static_cast<std::size_t>(size_ / 2) * size_;
    solid_angles_.assign(table.begin() + static_cast<std::ptrdiff_t>(middle), table.end());
    // the one texel that lies in all quadrants
    if (size_ % 2 == 1) pole_share_ = solid_angles_[size_ / 2] / 4;
}

// First the rows of the sides, then the lines of the north cap from the pole on, then the south's.
CubeGrid::Line CubeGrid::line(int i) const {
    Line line{};
    const auto set = [&](const TapList& nodes, int row, const TapList& texels, std::size_t begin) {
        const std::size_t node = static_cast<std::size_t>(row) * (reach_ + 1);
        line.node_first = nodes.first.data() + node;
        line.node_weights = nodes.weights.data() + node * kTapCount;
        line.first = texels.first.data() + begin;
        line.weights = texels.weights.data() + begin * kTapCount;
    };
    if (i < size_) {
        set(side_nodes_, i, side_texels_, 0);
        line.count = size_;
        const int from_middle = std::max(i, size_ - 1 - i) - size_ / 2;
        line.solid_angles = solid_angles_.data() + static_cast<std::ptrdiff_t>(from_middle) * size_;
        for (int q = 0; q < 4; ++q) {
            const FacePlacement& face = placement_[q];
            line.places[q] = {face.face, face.origin + i * face.along_v, face.along_u};
        }
        return line;
    }
    const bool south = i >= size_ + half_;
    const int a = i - size_ - (south ? half_ : 0);
    set(cap_nodes_, a, cap_texels_, cap_begins_[a]);
    line.from_south = south;
    line.count = static_cast<int>(cap_begins_[a + 1] - cap_begins_[a]);
    const int end = size_ / 2 + a, begin = end + 1 - line.count;
    const bool at_pole = size_ % 2 == 1 && a == 0;
    line.solid_angles = at_pole
                            ? &pole_share_
                            : solid_angles_.data() + static_cast<std::ptrdiff_t>(a) * size_ + begin;
    // The axes lie along +z, +x, -z, -x, and the lines along +x, -z, -x, +z.
    const FacePlacement& face = placement_[south ? 5 : 4];
    for (int q = 0; q < 4; ++q) {
        const auto index = [&](bool up, int k) { return up ? k : size_ - 1 - k; };
        const std::ptrdiff_t along = q % 2 == 0 ? face.along_v : face.along_u;
        const std::ptrdiff_t across = q % 2 == 0 ? face.along_u : face.along_v;
        const bool across_up = q == 0 || q == 3;
        line.places[q] = {
            face.face, face.origin + index(q < 2, end) * along + index(across_up, begin) * across,
            across_up ? across : -across};
    }
    return line;
}

TexelGrid::Buffer CubeGrid::make_buffer() const {
    return Buffer(scratch_, stride_ * (ring_count_ + 2 * kBeyondPole));
}

// Where the axes are on a ring; -kBeyondPole is the first.
std::size_t CubeGrid::buffer_row(int ring) const {
    return (ring + kBeyondPole) * stride_ + 16 * static_cast<std::size_t>(reach_);
}

// Where they are on the ring from which a line counts, and how far it is to its next.
std::size_t CubeGrid::first_row(const Line& line) const {
    return buffer_row(line.from_south ? ring_count_ - 1 + kBeyondPole : -kBeyondPole);
}

std::ptrdiff_t CubeGrid::row_step(const Line& line) const {
    return static_cast<std::ptrdiff_t>(stride_) * (line.from_south ? -1 : 1);
}

ScratchArray CubeGrid::make_nodes(int count) const {
    return ScratchArray(scratch_, node_row(count));
}

void CubeGrid::scatter_group(int group, const std::array<GroupValues, 3>& planes,
                             Buffer& buffer) const {
    const float* const from[3] = {planes[0].data(), planes[1].data(), planes[2].data()};
    const int ring = group * lane_count_;
    HWY_DYNAMIC_DISPATCH(scatter_rings)
    (from, column_count_, reach_, static_cast<std::ptrdiff_t>(stride_),
     buffer.data() + buffer_row(ring), buffer.data() + buffer_row(ring_count_ - 1 - ring));
}

void CubeGrid::gather_group(int group, const Buffer& buffer,
                            std::array<GroupValues, 3>& planes) const {
    float* const to[3] = {planes[0].data(), planes[1].data(), planes[2].data()};
    const int ring = group * lane_count_;
    HWY_DYNAMIC_DISPATCH(gather_rings)
    (buffer.data() + buffer_row(ring), buffer.data() + buffer_row(ring_count_ - 1 - ring),
     static_cast<std::ptrdiff_t>(stride_), reach_, column_count_, to);
}

// What lies beyond a pole is what lies before it, half a turn on.
template <class F>
void CubeGrid::for_each_pair_beyond_poles(const F& f) const {
    for (int i = 0; i < kBeyondPole; ++i) {
        for (const bool south : {false, true}) {
            const int within = south ? ring_count_ - 1 - i : i;
            const int beyond = south ? ring_count_ + i : -1 - i;
            for (int c = -reach_; c <= reach_; ++c) {
                for (int half = 0; half < 16; half += 8)
                    f(buffer_row(within) + 16 * c + half, buffer_row(beyond) + 16 * c + 8 - half);
            }
        }
    }
}

void CubeGrid::make_texels(Buffer& buffer, const Vec3f& lowest, const Vec3f& highest,
                           std::vector<Image>& faces) const {
    float* const rings = buffer.data();
    for_each_pair_beyond_poles([&](std::size_t within, std::size_t beyond) {
        std::copy_n(rings + within, 8, rings + beyond);
    });
    parallel_for(blocks(line_count(), kLinesRead), [&](std::int64_t block) {
        const FlushDenormals flush;
        const int begin = static_cast<int>(block) * kLinesRead;
        const int end = std::min(begin + kLinesRead, line_count());
        ScratchArray nodes = make_nodes(kLinesRead);
        for (int c = -reach_; c <= reach_; c += kColumns) {
            for (int i = begin; i < end; ++i) {
                const Line texels = line(i);
                HWY_DYNAMIC_DISPATCH(read_nodes)
                (texels, c, std::min(c + kColumns, reach_ + 1), rings + first_row(texels),
                 row_step(texels), nodes.data() + node_row(i - begin) + 16 * reach_);
            }
        }
        for (int i = begin; i < end; ++i) {
            const Line texels = line(i);
            float* to[4];
            for (int q = 0; q < 4; ++q)
                to[q] = faces[texels.places[q].face].values().data() + texels.places[q].begin;
            HWY_DYNAMIC_DISPATCH(read_texels)
            (texels, nodes.data() + node_row(i - begin), lowest, highest, to);
        }
    });
}

// Adding has to keep out of its own way: lines add to nodes of their own, and then columns, each
// for some lines, to their own part of the rings.
void CubeGrid::spread_texels(const std::vector<Image>& faces, Buffer& buffer) const {
    float* const rings = buffer.data();
    parallel_for(ring_count_ + 2 * kBeyondPole, [&](std::int64_t row) {
        std::fill_n(rings + row * static_cast<std::int64_t>(stride_), stride_, 0.0f);
    });
    ScratchArray nodes = make_nodes(kLinesAdded);
    for (int begin = 0; begin < line_count(); begin += kLinesAdded) {
        const int end = std::min(begin + kLinesAdded, line_count());
        parallel_for(end - begin, [&](std::int64_t k) {
            const FlushDenormals flush;
            const Line texels = line(begin + static_cast<int>(k));
            float* const to = nodes.data() + node_row(static_cast<int>(k));
            std::fill_n(to, node_row(1), 0.0f);
            const float* from[4];
            for (int q = 0; q < 4; ++q)
                from[q] = faces[texels.places[q].face].values().data() + texels.places[q].begin;
            HWY_DYNAMIC_DISPATCH(add_texels)(texels, from, to);
        });
        parallel_for(blocks(node_count(), kColumns), [&](std::int64_t block) {
            const FlushDenormals flush;
            const int c = static_cast<int>(block) * kColumns - reach_;
            for (int i = begin; i < end; ++i) {
                const Line texels = line(i);
                HWY_DYNAMIC_DISPATCH(add_nodes)
                (texels, c, std::min(c + kColumns, reach_ + 1),
                 nodes.data() + node_row(i - begin) + 16 * reach_, row_step(texels),
                 rings + first_row(texels));
            }
        });
    }
    for_each_pair_beyond_poles([&](std::size_t within, std::size_t beyond) {
        for (int k = 0; k < 8; ++k) rings[within + k] += rings[beyond + k];
    });
}

}  // namespace mirrorball::detail
#endif
