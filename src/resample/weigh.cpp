// One source for all vector widths. Four texels of three floats side by side are one register of
// 512 bits where there are such; elsewhere they are four registers of a texel each.
//
// Stencils are weighed by fours. In each, rows are weighed first, for its four columns and three
// channels at once. That leaves four columns of each of four stencils, which change places to
// become four stencils' texels of each of four columns: now columns are weighed as rows were, for
// four stencils at once, and come out as four texels of the result side by side.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "resample/weigh.cpp"
#include "hwy/foreach_target.h"
// must come after foreach_target.h
#include "hwy/highway.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

#include "resample/rgbx.h"
#include "resample/weigh.h"

HWY_BEFORE_NAMESPACE();
namespace mirrorball::detail {
namespace HWY_NAMESPACE {

// Boxes to stencils
// -----------------------------------------------------------------------------------

// Weights of the texels along one axis that a box of width h about x = 0 sees, the first of them at
// x: the mean of a texel's tent over the box, (G(x + h/2) - G(x - h/2)) / h with the tent's
// integral G.
HWY_ATTR Rgbx weigh_wide(Rgbx at, float half) {
    const auto integral = [](Rgbx x) HWY_ATTR {
        constexpr Rgbx one = {1, 1, 1, 1};
        x = smaller(larger(x, -one), one);
        return x - x * magnitude(x) * 0.5f;
    };
    return (integral(at + half) - integral(at - half)) * (0.5f / half);
}

// The same where the difference of integrals would cancel: the tent's value, corrected where a kink
// of the tent lies in the box. The mean of |y| over a box about x is |x| + D(x).
HWY_ATTR Rgbx weigh_narrow(Rgbx at, float half) {
    const float scale = 0.5f / half;
    const auto kink = [&](Rgbx x) HWY_ATTR {
        const Rgbx inside = larger(half - magnitude(x), Rgbx{});
        return inside * inside * scale;
    };
    const Rgbx tent = larger(1.0f - magnitude(at), Rgbx{});
    return tent + 0.5f * (kink(at + 1.0f) + kink(at - 1.0f)) - kink(at);
}

// What a box takes along one axis: texels from `first` on, by fours.
struct Axis {
    int first, fours;
    Rgbx weights[3];
};

// Places along a face in 2^-32 texels, texel centres at whole ones. Exact.
constexpr int kWhole = 32;
HWY_ATTR std::int64_t in_texels(std::uint32_t place, int size) {
    return static_cast<std::int64_t>(place) * size - (std::int64_t{1} << (kWhole - 1));
}
HWY_ATTR float to_float(std::int64_t place) {
    return static_cast<float>(place) * 0x1p-32f;
}

// Of a face that is `size` texels long.
HWY_ATTR HWY_INLINE Axis mean_along(std::uint32_t centre, std::uint16_t width, int size) {
    const std::int64_t u = in_texels(centre, size), half = std::int64_t{width} << 18;
    static_assert(kBoxUnit / 2 == 0x1p18 / 0x1p32);
    const int begin = static_cast<int>((u - half) >> kWhole),
              end = static_cast<int>((u + half) >> kWhole) + 2;
    Axis axis;
    axis.fours = (end - begin + 3) / 4;
    // what the fours have too many is better not beyond the face's edge
    axis.first = end <= size ? std::min(begin, size - 4 * axis.fours) : begin;
    const float x = to_float((std::int64_t{axis.first} << kWhole) - u), h = to_float(half);
    Rgbx at = {x, x + 1, x + 2, x + 3};
    for (int i = 0; i < axis.fours; ++i, at += 4.0f)
        axis.weights[i] = h > 0.5f ? weigh_wide(at, h) : weigh_narrow(at, h);
    return axis;
}

HWY_ATTR HWY_INLINE Axis smooth_along(std::uint32_t centre, int size) {
    const std::int64_t u = in_texels(centre, size);
    const float x = to_float(static_cast<std::uint32_t>(u)), rest = 1 - x;
    const float at_c = x * x * (3 - 2 * x);
    Axis axis;
    axis.first = static_cast<int>(u >> kWhole) - 1, axis.fours = 1;
    axis.weights[0] = Rgbx{1 - at_c, at_c, 0.5f * x * rest * rest, -0.5f * x * x * rest};
    return axis;
}

// The stencils of a box that is `columns` by `rows`.
HWY_ATTR HWY_INLINE void append(const Axis& columns, const Axis& rows, bool at_rim, int width,
                                int height, Stencils& out) {
    for (int j = 0; j < rows.fours; ++j)
        for (int i = 0; i < columns.fours; ++i) {
            const int k = out.count++, column = columns.first + 4 * i, row = rows.first + 4 * j;
            out.across_edges[k] =
                at_rim | (column < 0) | (row < 0) | (column + 4 > width) | (row + 4 > height);
            out.column[k] = column, out.row[k] = row;
            store_rgbx(columns.weights[i], out.columns[k]);
            store_rgbx(rows.weights[j], out.rows[k]);
        }
}

HWY_ATTR int AppendStencils(const Box* boxes, int count, int width, int height, Stencils& out,
                            int* owners) {
    constexpr Axis nothing{0, 1, {}};
    int i = 0;
    for (; i < count && out.count < kBlock; ++i) {
        const Box& box = boxes[i];
        const int before = out.count;
        if (box.kind != BoxKind::none) {
            if (out.face >= 0 && box.face != out.face) break;
            out.face = box.face;
        }
        if (box.kind == BoxKind::none)
            append(nothing, nothing, false, width, height, out);
        else if (box.kind == BoxKind::smooth)
            append(smooth_along(box.s, width), smooth_along(box.t, height), box.at_rim, width,
                   height, out);
        else
            append(mean_along(box.s, box.width, width), mean_along(box.t, box.height, height),
                   box.at_rim, width, height, out);
        for (int k = before; k < out.count; ++k) out.kind[k] = box.kind, owners[k] = i;
    }
    return i;
}

// Stencils to colours
// ---------------------------------------------------------------------------------

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_CAP_GE512

using Floats = hn::FixedTag<float, 16>;
using Indices = hn::FixedTag<std::int32_t, 16>;

// Which lanes to take, for four texels side by side in twelve.
struct Orders {
    alignas(64) std::int32_t weight[2][4][16], outer[2][16], inner[2][16];

    constexpr Orders() : weight(), outer(), inner() {
        for (int i = 0; i < 12; ++i) {
            const int texel = i / 3, channel = i % 3;
            for (int half = 0; half < 2; ++half) {
                // texels 0 and 1 (2 and 3) of two registers in turn
                outer[half][i] = 16 * (texel % 2) + 3 * (2 * half + texel / 2) + channel;
                // the first (second) pair of either register
                inner[half][i] = 16 * (texel / 2) + 3 * (2 * half + texel % 2) + channel;
            }
            for (int k = 0; k < 4; ++k) {
                weight[false][k][i] = 4 * texel + k;
                weight[true][k][i] = 4 * (3 - texel) + k;
            }
        }
    }
};
constexpr Orders kOrders;

// Four texels side by side in the lower twelve lanes.
using Row = hn::Vec<Floats>;

HWY_ATTR HWY_INLINE Row load(const float* texels) {
    return hn::MaskedLoad(hn::FirstN(Floats(), 12), Floats(), texels);
}
// Texels from `first` on, where they belong if the first of all goes to `out`.
HWY_ATTR HWY_INLINE void store(Row row, int first, int count, float* out) {
    const auto lanes = [](int texels) HWY_ATTR {
        return hn::FirstN(Floats(), 3 * static_cast<std::size_t>(texels));
    };
    hn::BlendedStore(row, hn::AndNot(lanes(first), lanes(first + count)), Floats(), out);
}
HWY_ATTR HWY_INLINE Row add(Row a, Row b) {
    return hn::Add(a, b);
}
HWY_ATTR HWY_INLINE Row subtract(Row a, Row b) {
    return hn::Sub(a, b);
}
HWY_ATTR HWY_INLINE Row multiply(Row a, Row b) {
    return hn::Mul(a, b);
}
HWY_ATTR HWY_INLINE Row multiply_add(Row a, Row b, Row sum) {
    return hn::MulAdd(a, b, sum);
}
// doubled_slope() of rgbx.h
HWY_ATTR HWY_INLINE Row slope(Row left, Row right) {
    const Row six = hn::Set(Floats(), 6.0f), zero = hn::Zero(Floats());
    const Row most = hn::Max(zero, hn::Mul(six, hn::Min(left, right)));
    const Row least = hn::Min(zero, hn::Mul(six, hn::Max(left, right)));
    return hn::Max(hn::Min(hn::Add(left, right), most), least);
}

// weights[k] to all lanes of result k
HWY_ATTR HWY_INLINE void same_for_all(const float* weights, Row* out) {
    for (int k = 0; k < 4; ++k) out[k] = hn::Set(Floats(), weights[k]);
}
// weights[i][k] to texel i of result k, or to texel 3 - i if reversed
HWY_ATTR HWY_INLINE void one_for_each(const float (*weights)[4], bool reversed, Row* out) {
    const Row all = hn::LoadU(Floats(), weights[0]);
    for (int k = 0; k < 4; ++k)
        out[k] = hn::TableLookupLanes(
            all, hn::IndicesFromVec(Floats(), hn::Load(Indices(), kOrders.weight[reversed][k])));
}
// Lanes of two registers by one instruction, which Highway 1.0 does not have.
HWY_ATTR HWY_INLINE Row lanes_of(Row a, Row b, const std::int32_t* order) {
    return Row{_mm512_permutex2var_ps(a.raw, hn::Load(Indices(), order).raw, b.raw)};
}
// Texel i of row k becomes texel k of row i.
HWY_ATTR HWY_INLINE void transpose(Row* rows) {
    const Row a = lanes_of(rows[0], rows[1], kOrders.outer[0]),
              b = lanes_of(rows[0], rows[1], kOrders.outer[1]),
              c = lanes_of(rows[2], rows[3], kOrders.outer[0]),
              d = lanes_of(rows[2], rows[3], kOrders.outer[1]);
    rows[0] = lanes_of(a, c, kOrders.inner[0]);
    rows[1] = lanes_of(a, c, kOrders.inner[1]);
    rows[2] = lanes_of(b, d, kOrders.inner[0]);
    rows[3] = lanes_of(b, d, kOrders.inner[1]);
}

#else

struct Row {
    Rgbx texels[4];
};

template <class F>
HWY_ATTR HWY_INLINE Row each(const F& f) {
    return {{f(0), f(1), f(2), f(3)}};
}
HWY_ATTR HWY_INLINE Row load(const float* texels) {
    return each([&](int i) HWY_ATTR { return load_rgbx(texels + 3 * i); });
}
HWY_ATTR HWY_INLINE void store(const Row& row, int first, int count, float* out) {
    for (int i = first; i < first + count; ++i)
        std::memcpy(out + 3 * i, &row.texels[i], 3 * sizeof(float));
}
HWY_ATTR HWY_INLINE Row add(const Row& a, const Row& b) {
    return each([&](int i) HWY_ATTR { return a.texels[i] + b.texels[i]; });
}
HWY_ATTR HWY_INLINE Row subtract(const Row& a, const Row& b) {
    return each([&](int i) HWY_ATTR { return a.texels[i] - b.texels[i]; });
}
HWY_ATTR HWY_INLINE Row multiply(const Row& a, const Row& b) {
    return each([&](int i) HWY_ATTR { return a.texels[i] * b.texels[i]; });
}
HWY_ATTR HWY_INLINE Row multiply_add(const Row& a, const Row& b, const Row& sum) {
    return each([&](int i) HWY_ATTR { return a.texels[i] * b.texels[i] + sum.texels[i]; });
}
HWY_ATTR HWY_INLINE Row slope(const Row& left, const Row& right) {
    return each([&](int i) HWY_ATTR { return doubled_slope(left.texels[i], right.texels[i]); });
}
HWY_ATTR HWY_INLINE Rgbx all_lanes(float value) {
    return Rgbx{value, value, value, value};
}
HWY_ATTR HWY_INLINE void same_for_all(const float* weights, Row* out) {
    for (int k = 0; k < 4; ++k) out[k] = each([&](int) HWY_ATTR { return all_lanes(weights[k]); });
}
HWY_ATTR HWY_INLINE void one_for_each(const float (*weights)[4], bool reversed, Row* out) {
    for (int k = 0; k < 4; ++k)
        out[k] = each([&](int i) HWY_ATTR { return all_lanes(weights[reversed ? 3 - i : i][k]); });
}
HWY_ATTR HWY_INLINE void transpose(Row* rows) {
    for (int k = 0; k < 4; ++k)
        for (int i = 0; i < k; ++i) std::swap(rows[k].texels[i], rows[i].texels[k]);
}

#endif

// Four rows (or columns) of texels to one.
HWY_ATTR HWY_INLINE Row mean(const Row* r, const Row* weights) {
    return add(multiply_add(r[3], weights[3], multiply(r[0], weights[0])),
               multiply_add(r[2], weights[2], multiply(r[1], weights[1])));
}
// monotone_cubic() of rgbx.h
HWY_ATTR HWY_INLINE Row cubic(const Row* r, const Row* weights) {
    const Row step = subtract(r[2], r[1]);
    const Row at_b = slope(subtract(r[1], r[0]), step), at_c = slope(step, subtract(r[3], r[2]));
    return add(multiply_add(r[2], weights[1], multiply(r[1], weights[0])),
               multiply_add(at_c, weights[3], multiply(at_b, weights[2])));
}
// The same from rows b and c alone, their slopes being known: those of rows in the other order if
// flipped.
HWY_ATTR HWY_INLINE Row cubic(const Row& b, const Row& c, const Row& at_b, const Row& at_c,
                              bool flip, const Row* weights) {
    const Row values = multiply_add(c, weights[1], multiply(b, weights[0])),
              slopes = multiply_add(at_c, weights[3], multiply(at_b, weights[2]));
    return flip ? subtract(values, slopes) : add(values, slopes);
}

// Where stencils' texels lie on the face to which a move carries theirs.
struct Places {
    const float *texels, *slopes;  // of the face as moved; no slopes if they are not known
    std::ptrdiff_t row_step;
    bool flip_s, flip_t;                                             // as the move does
    std::int32_t column[Stencils::kPadded], row[Stencils::kPadded];  // columns in floats

    // From the face's first texel to that of stencil k.
    HWY_ATTR HWY_INLINE std::ptrdiff_t operator[](int k) const {
        return row[k] * row_step + column[k];
    }
};

// How many lie nowhere, since they reach over their face's edges; their numbers go to `across`.
HWY_ATTR int find(const Stencils& stencils, const MovedLevel& level, Places& places, int* across) {
    const hn::ScalableTag<std::int32_t> d;
    using V = hn::Vec<decltype(d)>;
    const Move& move = level.moves[std::max(stencils.face, 0)];
    const int width = level.width;
    const std::ptrdiff_t row_size = 3 * static_cast<std::ptrdiff_t>(width);
    places.row_step = move.flip_t ? -row_size : row_size;
    const std::ptrdiff_t first_row = move.flip_t ? (level.height - 1) * row_size : 0;
    places.texels = level.faces[move.face] + first_row;
    places.slopes = level.slopes[move.face] ? level.slopes[move.face] + first_row : nullptr;
    places.flip_s = move.flip_s, places.flip_t = move.flip_t;
    // four columns begin at the last of them if flipped
    const V shift = hn::Set(d, move.quarters * (width / 4) + (move.flip_s ? width - 4 : 0));
    const V columns = hn::Set(d, width), last = hn::Set(d, width - 1),
            last_whole = hn::Set(d, width - 4), zero = hn::Zero(d);
    int across_count = 0;
    // three more than there are, so that any can be the first of four
    for (int k = 0; k < stencils.count + 3; k += static_cast<int>(hn::Lanes(d))) {
        const V on_face = hn::LoadU(d, stencils.column + k);
        V column = move.flip_s ? hn::Sub(shift, on_face) : hn::Add(shift, on_face);
        column = hn::Sub(column, hn::IfThenElseZero(hn::Gt(column, last), columns));
        const auto reaches_over = hn::Gt(hn::LoadU(d, stencils.across_edges + k), zero);
        const auto nowhere = hn::Or(reaches_over, hn::Gt(column, last_whole));
        // what lies nowhere is given the first texels: some have to be read
        hn::StoreU(hn::IfThenZeroElse(nowhere, hn::Add(column, hn::Add(column, column))), d,
                   places.column + k);
        hn::StoreU(hn::IfThenZeroElse(nowhere, hn::LoadU(d, stencils.row + k)), d, places.row + k);
        if (hn::AllFalse(d, nowhere)) continue;
        const V number = hn::Iota(d, k);
        const auto in_use = hn::Gt(hn::Set(d, stencils.count), number);
        across_count += static_cast<int>(
            hn::CompressBlendedStore(number, hn::And(nowhere, in_use), d, across + across_count));
    }
    return across_count;
}

enum class Way { mean, smooth, smooth_by_slopes };

// The rows of stencil k to one.
template <Way way>
HWY_ATTR HWY_INLINE Row weigh_rows(const Stencils& stencils, const Places& places, int k) {
    const float* const texels = places.texels + places[k];
    const std::ptrdiff_t step = places.row_step;
    Row weights[4];
    same_for_all(stencils.rows[k], weights);
    if constexpr (way == Way::smooth_by_slopes) {
        const float* const slopes = places.slopes + places[k];
        return cubic(load(texels + step), load(texels + 2 * step), load(slopes + step),
                     load(slopes + 2 * step), places.flip_t, weights);
    } else {
        const Row rows[4] = {load(texels), load(texels + step), load(texels + 2 * step),
                             load(texels + 3 * step)};
        return way == Way::mean ? mean(rows, weights) : cubic(rows, weights);
    }
}

// Four stencils from number `first` on, all taken for one kind: rows first, four columns of one
// stencil at a time; then columns, those of all four.
template <Way way>
HWY_ATTR HWY_INLINE Row weigh_four(const Stencils& stencils, const Places& places, int first,
                                   bool reversed) {
    Row columns[4], weights[4];
    for (int i = 0; i < 4; ++i)
        columns[i] = weigh_rows<way>(stencils, places, first + (reversed ? 3 - i : i));
    transpose(columns);
    if (places.flip_s) std::swap(columns[0], columns[3]), std::swap(columns[1], columns[2]);
    one_for_each(&stencils.columns[first], reversed, weights);
    return way == Way::mean ? mean(columns, weights) : cubic(columns, weights);
}

HWY_ATTR int Weigh(const Stencils& stencils, bool reversed, const MovedLevel& level, float* out,
                   int* across) {
    Places places;
    const int across_count = find(stencils, level, places, across);
    const bool all_across = level.width < 4 || level.height < 4;
    for (int k = 0; k < stencils.count;) {
        const BoxKind kind = stencils.kind[k];
        int count = 1;
        while (count < 4 && k + count < stencils.count && stencils.kind[k + count] == kind) ++count;
        const Row colours =
            kind == BoxKind::none || all_across ? Row{}
            : kind == BoxKind::mean ? weigh_four<Way::mean>(stencils, places, k, reversed)
            : places.slopes ? weigh_four<Way::smooth_by_slopes>(stencils, places, k, reversed)
                            : weigh_four<Way::smooth>(stencils, places, k, reversed);
        if (reversed)
            store(colours, 4 - count, count, out + 3 * (stencils.count - k - 4));
        else
            store(colours, 0, count, out + 3 * k);
        k += count;
    }
    return across_count;
}

HWY_ATTR void FindSlopes(const float* row, int width, float* slopes) {
    const std::ptrdiff_t row_size = 3 * static_cast<std::ptrdiff_t>(width);
    for (std::ptrdiff_t i = 0; i < row_size; ++i)
        slopes[i] = doubled_slope(row[i] - row[i - row_size], row[i + row_size] - row[i]);
}

}  // namespace HWY_NAMESPACE
}  // namespace mirrorball::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mirrorball::detail {

HWY_EXPORT(AppendStencils);
HWY_EXPORT(Weigh);
HWY_EXPORT(FindSlopes);

int append_stencils(const Box* boxes, int count, int width, int height, Stencils& out,
                    int* owners) {
    return HWY_DYNAMIC_DISPATCH(AppendStencils)(boxes, count, width, height, out, owners);
}

int weigh(const Stencils& stencils, bool reversed, const MovedLevel& level, float* out,
          int* across) {
    return HWY_DYNAMIC_DISPATCH(Weigh)(stencils, reversed, level, out, across);
}

void find_slopes(const float* row, int width, float* slopes) {
    HWY_DYNAMIC_DISPATCH(FindSlopes)(row, width, slopes);
}

}  // namespace mirrorball::detail
#endif  // HWY_ONCE
