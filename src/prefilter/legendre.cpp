// P_l at many nodes t = 1 - x, all bands in turn. The recurrence goes by differences,
//
//     D_l = P_l+1 - P_l = (l D_l-1 - (2l+1) x P_l) / (l+1),
//
// which is the usual three-term one, rearranged so that x appears and not t: close to the axis,
// where narrow lobes are, P_l changes by l^2 x, and 1 - x would keep too few of x's digits. Nodes
// lie in the vector's lanes, four vectors at a time, so that one's latency hides behind the
// others'.
#include "prefilter/legendre.h"

#include <algorithm>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prefilter/legendre.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mirrorball::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::ScalableTag<double>;
using Vector = hn::Vec<Tag>;

// The nodes of four vectors on their way up the bands.
struct Nodes {
    Vector x0, x1, x2, x3;
    Vector p0, p1, p2, p3;
    Vector d0, d1, d2, d3;

    explicit Nodes(const double* x) {
        const Tag tag;
        const std::size_t lanes = hn::Lanes(tag);
        x0 = hn::LoadU(tag, x);
        x1 = hn::LoadU(tag, x + lanes);
        x2 = hn::LoadU(tag, x + 2 * lanes);
        x3 = hn::LoadU(tag, x + 3 * lanes);
        p0 = p1 = p2 = p3 = hn::Set(tag, 1);
        d0 = d1 = d2 = d3 = hn::Zero(tag);
    }

    // From band l to l + 1: a = l / (l+1), b = (2l+1) / (l+1).
    HWY_INLINE void advance(double a_value, double b_value) {
        const Tag tag;
        const Vector a = hn::Set(tag, a_value), b = hn::Set(tag, b_value);
        d0 = hn::NegMulAdd(hn::Mul(b, x0), p0, hn::Mul(a, d0));
        d1 = hn::NegMulAdd(hn::Mul(b, x1), p1, hn::Mul(a, d1));
        d2 = hn::NegMulAdd(hn::Mul(b, x2), p2, hn::Mul(a, d2));
        d3 = hn::NegMulAdd(hn::Mul(b, x3), p3, hn::Mul(a, d3));
        p0 = hn::Add(p0, d0);
        p1 = hn::Add(p1, d1);
        p2 = hn::Add(p2, d2);
        p3 = hn::Add(p3, d3);
    }
};

std::size_t NodesAtOnce() {
    return 4 * hn::Lanes(Tag());
}

// sums: a vector per band, its lanes not yet added up.
void AddSums(const double* x, const double* weights, const double* a, const double* b,
             std::size_t band_count, double* sums) {
    const Tag tag;
    const std::size_t lanes = hn::Lanes(tag);
    Nodes nodes(x);
    const Vector w0 = hn::LoadU(tag, weights), w1 = hn::LoadU(tag, weights + lanes),
                 w2 = hn::LoadU(tag, weights + 2 * lanes), w3 = hn::LoadU(tag, weights + 3 * lanes);
    for (std::size_t l = 0; l < band_count; ++l) {
        const Vector left = hn::MulAdd(w0, nodes.p0, hn::Mul(w1, nodes.p1)),
                     right = hn::MulAdd(w2, nodes.p2, hn::Mul(w3, nodes.p3));
        double* sum = sums + l * lanes;
        hn::StoreU(hn::Add(hn::LoadU(tag, sum), hn::Add(left, right)), tag, sum);
        nodes.advance(a[l], b[l]);
    }
}

void AddLanes(const double* vectors, std::size_t count, double* sums) {
    const Tag tag;
    const std::size_t lanes = hn::Lanes(tag);
    for (std::size_t i = 0; i < count; ++i)
        sums[i] = hn::GetLane(hn::SumOfLanes(tag, hn::LoadU(tag, vectors + i * lanes)));
}

// P_l(-t) = (-1)^l P_l(t): even and odd bands are added up apart. Coefficients of an even number.
void Series(const double* x, const double* a, const double* b, const double* coefficients,
            std::size_t band_count, double* even, double* odd) {
    const Tag tag;
    const std::size_t lanes = hn::Lanes(tag);
    Nodes nodes(x);
    Vector e0 = hn::Zero(tag), e1 = e0, e2 = e0, e3 = e0, o0 = e0, o1 = e0, o2 = e0, o3 = e0;
    for (std::size_t l = 0; l < band_count; l += 2) {
        const Vector ce = hn::Set(tag, coefficients[l]), co = hn::Set(tag, coefficients[l + 1]);
        e0 = hn::MulAdd(ce, nodes.p0, e0);
        e1 = hn::MulAdd(ce, nodes.p1, e1);
        e2 = hn::MulAdd(ce, nodes.p2, e2);
        e3 = hn::MulAdd(ce, nodes.p3, e3);
        nodes.advance(a[l], b[l]);
        o0 = hn::MulAdd(co, nodes.p0, o0);
        o1 = hn::MulAdd(co, nodes.p1, o1);
        o2 = hn::MulAdd(co, nodes.p2, o2);
        o3 = hn::MulAdd(co, nodes.p3, o3);
        nodes.advance(a[l + 1], b[l + 1]);
    }
    const Vector evens[] = {e0, e1, e2, e3}, odds[] = {o0, o1, o2, o3};
    for (std::size_t i = 0; i < 4; ++i) {
        hn::StoreU(evens[i], tag, even + i * lanes);
        hn::StoreU(odds[i], tag, odd + i * lanes);
    }
}

}  // namespace mirrorball::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mirrorball::detail {
namespace {

HWY_EXPORT(NodesAtOnce);
HWY_EXPORT(AddSums);
HWY_EXPORT(AddLanes);
HWY_EXPORT(Series);

// The recurrence's factors for a number of bands.
struct Factors {
    std::vector<double> a, b;

    explicit Factors(std::size_t band_count) : a(band_count), b(band_count) {
        for (std::size_t l = 0; l < band_count; ++l) {
            const double n = static_cast<double>(l);
            a[l] = n / (n + 1);
            b[l] = (2 * n + 1) / (n + 1);
        }
    }
};

std::size_t round_up(std::size_t count, std::size_t step) {
    return (count + step - 1) / step * step;
}

std::vector<double> padded(std::span<const double> values, std::size_t step) {
    std::vector<double> copy(values.begin(), values.end());
    copy.resize(round_up(copy.size(), step), 0.0);
    return copy;
}

}  // namespace

void legendre_sums(std::span<const double> x, std::span<const double> weights,
                   std::span<double> sums) {
    const std::size_t step = HWY_DYNAMIC_DISPATCH(NodesAtOnce)();
    const std::vector<double> all_x = padded(x, step), all_weights = padded(weights, step);
    const Factors factors(sums.size());
    std::vector<double> vectors(sums.size() * step / 4, 0.0);
    for (std::size_t i = 0; i < all_x.size(); i += step) HWY_DYNAMIC_DISPATCH(AddSums)
    (&all_x[i], &all_weights[i], factors.a.data(), factors.b.data(), sums.size(), vectors.data());
    HWY_DYNAMIC_DISPATCH(AddLanes)(vectors.data(), sums.size(), sums.data());
}

void legendre_series(std::span<const double> coefficients, std::span<const double> x,
                     std::span<double> values, std::span<double> opposite) {
    const std::size_t step = HWY_DYNAMIC_DISPATCH(NodesAtOnce)();
    const std::vector<double> all_x = padded(x, step), series = padded(coefficients, 2);
    const Factors factors(series.size());
    std::vector<double> even(step), odd(step);
    for (std::size_t start = 0; start < x.size(); start += step) {
        HWY_DYNAMIC_DISPATCH(Series)
        (&all_x[start], factors.a.data(), factors.b.data(), series.data(), series.size(),
         even.data(), odd.data());
        const std::size_t end = std::min(x.size(), start + step);
        for (std::size_t i = start; i < end; ++i) {
            values[i] = even[i - start] + odd[i - start];
            if (!opposite.empty()) opposite[i] = even[i - start] - odd[i - start];
        }
    }
}

}  // namespace mirrorball::detail
#endif
