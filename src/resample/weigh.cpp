// One source for all vector widths. A row of a stencil, four texels of three floats, is one
// register of 512 bits where there are such, so that work along columns of texels is done for four
// columns and three channels at once; elsewhere it is four registers of a texel each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "resample/weigh.cpp"
#include "hwy/foreach_target.h"
// must come after foreach_target.h
#include "hwy/highway.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

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
HWY_ATTR void weigh_wide(float x, float half, int count, float* weights) {
    const auto integral = [](Rgbx at) HWY_ATTR {
        constexpr Rgbx one = {1, 1, 1, 1};
        at = smaller(larger(at, -one), one);
        return at - at * magnitude(at) * 0.5f;
    };
    const float scale = 0.5f / half;
    Rgbx at = {x, x + 1, x + 2, x + 3};
    for (int i = 0; i < count; i += 4, at += 4.0f)
        store_rgbx((integral(at + half) - integral(at - half)) * scale, weights + i);
}

// The same where the difference of integrals would cancel: the tent's value, corrected where a kink
// of the tent lies in the box. The mean of |y| over a box about x is |x| + D(x).
HWY_ATTR void weigh_narrow(float x, float half, float* weights) {
    const float scale = 0.5f / half;
    const auto kink = [&](Rgbx at) HWY_ATTR {
        const Rgbx inside = larger(half - magnitude(at), Rgbx{});
        return inside * inside * scale;
    };
    const Rgbx at = {x, x + 1, x + 2, x + 3};
    const Rgbx tent = larger(1.0f - magnitude(at), Rgbx{});
    store_rgbx(tent + 0.5f * (kink(at + 1.0f) + kink(at - 1.0f)) - kink(at), weights);
}

struct Axis {
    int first, count;
};

// Of a face that is `size` texels long.
HWY_ATTR Axis mean_along(std::uint32_t centre, std::uint16_t width, int size, float* weights) {
    const double u = centre * (0x1p-32 * size) - 0.5, half = width * (kBoxUnit / 2);
    const int first = static_cast<int>(std::floor(u - half)),
              count = static_cast<int>(std::floor(u + half)) + 2 - first;
    const float x = static_cast<float>(first - u);
    if (half > 0.5)
        weigh_wide(x, static_cast<float>(half), count, weights);
    else
        weigh_narrow(x, static_cast<float>(half), weights);
    return {first, count};
}

HWY_ATTR Axis smooth_along(std::uint32_t centre, int size, float* weights) {
    const double u = centre * (0x1p-32 * size) - 0.5, before = std::floor(u);
    const float x = static_cast<float>(u - before), rest = 1 - x;
    weights[1] = x * x * (3 - 2 * x);
    weights[0] = 1 - weights[1];
    weights[2] = 0.5f * x * rest * rest;
    weights[3] = -0.5f * x * x * rest;
    return {static_cast<int>(before) - 1, 4};
}

HWY_ATTR void MakeStencils(const Box* boxes, int count, int width, int height, Stencil* out) {
    for (int i = 0; i < count; ++i) {
        const Box& box = boxes[i];
        Stencil& stencil = out[i];
        stencil.kind = box.kind;
        if (box.kind == BoxKind::none) continue;
        Axis columns, rows;
        if (box.kind == BoxKind::smooth) {
            columns = smooth_along(box.s, width, stencil.columns);
            rows = smooth_along(box.t, height, stencil.rows);
        } else {
            columns = mean_along(box.s, box.width, width, stencil.columns);
            rows = mean_along(box.t, box.height, height, stencil.rows);
        }
        const bool large = box.kind == BoxKind::large;
        const int column_count = large ? (columns.count + 3) / 4 * 4 : 4,
                  row_count = large ? rows.count : 4;
        stencil.column_count = static_cast<std::int16_t>(column_count);
        stencil.row_count = static_cast<std::int16_t>(row_count);
        stencil.face = box.face;
        for (const bool mirror : {false, true}) {
            stencil.column[mirror] = mirrored(mirror, columns.first, column_count, width);
            stencil.row[mirror] = mirrored(mirror, rows.first, 1, height);
        }
        stencil.across_edges = box.at_rim || columns.first < 0 || rows.first < 0 ||
                               columns.first + column_count > width ||
                               rows.first + row_count > height;
    }
}

// Stencils to colours
// ---------------------------------------------------------------------------------

#if HWY_CAP_GE512

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::FixedTag<float, 16>;
using Indices = hn::FixedTag<std::int32_t, 16>;

// Lanes to take: weights for texels side by side, by whether the columns are flipped.
struct Orders {
    alignas(64) std::int32_t each[2][16], values[2][16], slopes[2][16];
    alignas(64) float sign[2][16];
    alignas(64) std::int32_t next[16], second_next[16];

    constexpr Orders() : each(), values(), slopes(), sign(), next(), second_next() {
        for (int i = 0; i < 16; ++i) {
            const int texel = std::min(i / 3, 3), pair = std::min(i / 3, 1);
            for (int flip = 0; flip < 2; ++flip) {
                each[flip][i] = flip ? 3 - texel : texel;
                values[flip][i] = flip ? 1 - pair : pair;
                slopes[flip][i] = 2 + values[flip][i];
                sign[flip][i] = flip ? -1.0f : 1.0f;
            }
            next[i] = (i + 3) % 16;
            second_next[i] = (i + 6) % 16;
        }
    }
};
constexpr Orders kOrders;

// Four texels side by side in the lower twelve lanes.
class FourTexels {
  public:
    using Row = hn::Vec<Floats>;

    static HWY_ATTR HWY_INLINE Row zero() { return hn::Zero(Floats()); }
    static HWY_ATTR HWY_INLINE Row load(const float* texels) {
        return hn::MaskedLoad(hn::FirstN(Floats(), 12), Floats(), texels);
    }
    static HWY_ATTR HWY_INLINE Row add(Row sum, Row row, float weight) {
        return hn::MulAdd(row, hn::Set(Floats(), weight), sum);
    }
    static HWY_ATTR HWY_INLINE Row cubic(Row a, Row b, Row c, Row d, const float* weights) {
        const Row step = hn::Sub(c, b);
        const Row at_b = slope(hn::Sub(b, a), step), at_c = slope(step, hn::Sub(d, c));
        Row sum = hn::Mul(b, hn::Set(Floats(), weights[0]));
        sum = add(sum, c, weights[1]);
        sum = add(sum, at_b, weights[2]);
        return add(sum, at_c, weights[3]);
    }
    // Each texel times its weight, the last one first if flipped.
    static HWY_ATTR HWY_INLINE Row weighed(Row row, const float* weights, bool flip) {
        return hn::Mul(row, weights_by(weights, kOrders.each[flip]));
    }
    static HWY_ATTR HWY_INLINE void store_sum(Row row, float* out) {
        const Row pairs = hn::Add(row, permuted(row, kOrders.second_next));
        store_first(hn::Add(pairs, permuted(pairs, kOrders.next)), out);
    }
    static HWY_ATTR HWY_INLINE void store_cubic(Row row, const float* weights, bool flip,
                                                float* out) {
        const Row middle = permuted(row, kOrders.next), steps = hn::Sub(middle, row);
        const Row slopes = slope(steps, permuted(steps, kOrders.next));
        const Row slope_weights = hn::Mul(weights_by(weights, kOrders.slopes[flip]),
                                          hn::Load(Floats(), kOrders.sign[flip]));
        const Row pair = hn::MulAdd(middle, weights_by(weights, kOrders.values[flip]),
                                    hn::Mul(slopes, slope_weights));
        store_first(hn::Add(pair, permuted(pair, kOrders.next)), out);
    }

  private:
    static HWY_ATTR HWY_INLINE Row permuted(Row row, const std::int32_t* order) {
        return hn::TableLookupLanes(row, hn::IndicesFromVec(Floats(), hn::Load(Indices(), order)));
    }
    static HWY_ATTR HWY_INLINE Row weights_by(const float* weights, const std::int32_t* order) {
        return permuted(hn::LoadDup128(Floats(), weights), order);
    }
    static HWY_ATTR HWY_INLINE void store_first(Row row, float* out) {
        store_rgbx((Rgbx)hn::LowerHalf(hn::LowerHalf(row)).raw, out);
    }
    // doubled_slope() of rgbx.h
    static HWY_ATTR HWY_INLINE Row slope(Row left, Row right) {
        const Row six = hn::Set(Floats(), 6.0f);
        const Row most = hn::Max(zero(), hn::Mul(six, hn::Min(left, right)));
        const Row least = hn::Min(zero(), hn::Mul(six, hn::Max(left, right)));
        return hn::Max(hn::Min(hn::Add(left, right), most), least);
    }
};

#else

class FourTexels {
  public:
    struct Row {
        Rgbx texels[4];
    };

    static HWY_ATTR HWY_INLINE Row zero() { return {}; }
    static HWY_ATTR HWY_INLINE Row load(const float* texels) {
        return {{load_rgbx(texels), load_rgbx(texels + 3), load_rgbx(texels + 6),
                 load_rgbx(texels + 9)}};
    }
    static HWY_ATTR HWY_INLINE Row add(Row sum, const Row& row, float weight) {
        for (int i = 0; i < 4; ++i) sum.texels[i] += row.texels[i] * weight;
        return sum;
    }
    static HWY_ATTR HWY_INLINE Row cubic(const Row& a, const Row& b, const Row& c, const Row& d,
                                         const float* weights) {
        Row result;
        for (int i = 0; i < 4; ++i)
            result.texels[i] =
                monotone_cubic(a.texels[i], b.texels[i], c.texels[i], d.texels[i], weights);
        return result;
    }
    static HWY_ATTR HWY_INLINE Row weighed(Row row, const float* weights, bool flip) {
        for (int i = 0; i < 4; ++i) row.texels[i] *= weights[flip ? 3 - i : i];
        return row;
    }
    static HWY_ATTR HWY_INLINE void store_sum(const Row& row, float* out) {
        store_rgbx((row.texels[0] + row.texels[2]) + (row.texels[1] + row.texels[3]), out);
    }
    static HWY_ATTR HWY_INLINE void store_cubic(const Row& row, const float* weights, bool flip,
                                                float* out) {
        const Rgbx* t = row.texels;
        store_rgbx(flip ? monotone_cubic(t[3], t[2], t[1], t[0], weights)
                        : monotone_cubic(t[0], t[1], t[2], t[3], weights),
                   out);
    }
};

#endif

// A face of the source, where a move carries it.
struct MovedFace {
    const float* texels;
    std::ptrdiff_t row_size, row_step;
    int width, shift;
    bool flip_s, flip_t;
};

HWY_ATTR MovedFace moved_face(const MovedLevel& level, const Move& move) {
    const std::ptrdiff_t row_size = 3 * static_cast<std::ptrdiff_t>(level.width);
    return {level.faces[move.face],
            row_size,
            move.flip_t ? -row_size : row_size,
            level.width,
            move.quarters * (level.width / 4),
            move.flip_s,
            move.flip_t};
}

// Where a stencil's first row lies, and how far it is to the next; the columns run backwards if
// flipped. Nowhere, if it reaches over the face's edges.
struct Place {
    const float* texels;
    std::ptrdiff_t row_step;
    bool flip;
};

HWY_ATTR HWY_INLINE Place find(const Stencil& stencil, const MovedFace* faces) {
    if (stencil.across_edges) return {};
    const MovedFace& face = faces[stencil.face];
    int column = stencil.column[face.flip_s] + face.shift;
    if (column >= face.width) column -= face.width;
    if (column + stencil.column_count > face.width) return {};
    return {face.texels + stencil.row[face.flip_t] * face.row_size + 3 * column, face.row_step,
            face.flip_s};
}

HWY_ATTR HWY_INLINE void weigh_small(const Stencil& stencil, const Place& place, float* out) {
    const float* texels = place.texels;
    auto sum = FourTexels::zero();
    for (int j = 0; j < 4; ++j, texels += place.row_step)
        sum = FourTexels::add(sum, FourTexels::load(texels), stencil.rows[j]);
    FourTexels::store_sum(FourTexels::weighed(sum, stencil.columns, place.flip), out);
}

HWY_ATTR HWY_INLINE void weigh_large(const Stencil& stencil, const Place& place, float* out) {
    auto total = FourTexels::zero();
    for (int i = 0; i < stencil.column_count; i += 4) {
        const int from = place.flip ? stencil.column_count - 4 - i : i;
        const float* texels = place.texels + 3 * from;
        auto sum = FourTexels::zero();
        for (int j = 0; j < stencil.row_count; ++j, texels += place.row_step)
            sum = FourTexels::add(sum, FourTexels::load(texels), stencil.rows[j]);
        total =
            FourTexels::add(total, FourTexels::weighed(sum, stencil.columns + i, place.flip), 1.0f);
    }
    FourTexels::store_sum(total, out);
}

HWY_ATTR HWY_INLINE void interpolate(const Stencil& stencil, const Place& place, float* out) {
    const float* texels = place.texels;
    const std::ptrdiff_t step = place.row_step;
    const auto row = FourTexels::cubic(FourTexels::load(texels), FourTexels::load(texels + step),
                                       FourTexels::load(texels + 2 * step),
                                       FourTexels::load(texels + 3 * step), stencil.rows);
    FourTexels::store_cubic(row, stencil.columns, place.flip, out);
}

HWY_ATTR int Weigh(const Stencil* stencils, int count, bool reversed, const MovedLevel& level,
                   float* out, int* across) {
    MovedFace faces[kMostFaces];
    for (int face = 0; face < kMostFaces; ++face)
        faces[face] = moved_face(level, level.moves[face]);
    int across_count = 0;
    for (int k = 0; k < count; ++k, out += 3) {
        const int i = reversed ? count - 1 - k : k;
        const Stencil& stencil = stencils[i];
        if (stencil.kind == BoxKind::none) {
            store_rgbx(Rgbx{}, out);
            continue;
        }
        const Place place = find(stencil, faces);
        if (place.texels == nullptr)
            across[across_count++] = i;
        else if (stencil.kind == BoxKind::smooth)
            interpolate(stencil, place, out);
        else if (stencil.kind == BoxKind::small)
            weigh_small(stencil, place, out);
        else
            weigh_large(stencil, place, out);
    }
    return across_count;
}

}  // namespace HWY_NAMESPACE
}  // namespace mirrorball::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mirrorball::detail {

HWY_EXPORT(MakeStencils);
HWY_EXPORT(Weigh);

void make_stencils(const Box* boxes, int count, int width, int height, Stencil* out) {
    HWY_DYNAMIC_DISPATCH(MakeStencils)(boxes, count, width, height, out);
}

int weigh(const Stencil* stencils, int count, bool reversed, const MovedLevel& level, float* out,
          int* across) {
    return HWY_DYNAMIC_DISPATCH(Weigh)(stencils, count, reversed, level, out, across);
}

}  // namespace mirrorball::detail
#endif  // HWY_ONCE
