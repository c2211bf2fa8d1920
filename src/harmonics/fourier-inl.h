// The passes of a FourierPlan, for one processor. Included once for each by foreach_target.h.
#if defined(MIRRORBALL_FOURIER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef MIRRORBALL_FOURIER_INL_H
#undef MIRRORBALL_FOURIER_INL_H
#else
#define MIRRORBALL_FOURIER_INL_H
#endif

#include <hwy/highway.h>

#include "harmonics/fourier.h"

HWY_BEFORE_NAMESPACE();
namespace mirrorball::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A ring in each lane; never more than 16, so that arrays of lanes have a bound.
using Lanes = hn::CappedTag<float, 16>;
using Vec = hn::Vec<Lanes>;

struct Complexes {
    Vec re, im;
};

HWY_INLINE Complexes operator+(Complexes a, Complexes b) {
    return {hn::Add(a.re, b.re), hn::Add(a.im, b.im)};
}
HWY_INLINE Complexes operator-(Complexes a, Complexes b) {
    return {hn::Sub(a.re, b.re), hn::Sub(a.im, b.im)};
}
HWY_INLINE Complexes times(FourierPlan::Complex w, Complexes a) {
    const Lanes d;
    const Vec re = hn::Set(d, w.re), im = hn::Set(d, w.im);
    return {hn::MulSub(a.re, re, hn::Mul(a.im, im)), hn::MulAdd(a.re, im, hn::Mul(a.im, re))};
}
HWY_INLINE Complexes times(float s, Complexes a) {
    const Lanes d;
    return {hn::Mul(hn::Set(d, s), a.re), hn::Mul(hn::Set(d, s), a.im)};
}
HWY_INLINE Complexes plus_scaled(Complexes a, float s, Complexes b) {
    const Lanes d;
    return {hn::MulAdd(hn::Set(d, s), b.re, a.re), hn::MulAdd(hn::Set(d, s), b.im, a.im)};
}
// a - i b and a + i b
HWY_INLINE Complexes minus_i(Complexes a, Complexes b) {
    return {hn::Add(a.re, b.im), hn::Sub(a.im, b.re)};
}
HWY_INLINE Complexes plus_i(Complexes a, Complexes b) {
    return {hn::Sub(a.re, b.im), hn::Add(a.im, b.re)};
}

/// Complex numbers, one in each lane, as a row of real parts and a row of imaginary ones.
HWY_INLINE Complexes load(const float* numbers, std::size_t i) {
    const Lanes d;
    const std::size_t n = hn::Lanes(d);
    return {hn::Load(d, numbers + 2 * n * i), hn::Load(d, numbers + 2 * n * i + n)};
}
HWY_INLINE void store(Complexes value, float* numbers, std::size_t i) {
    const Lanes d;
    const std::size_t n = hn::Lanes(d);
    hn::Store(value.re, d, numbers + 2 * n * i);
    hn::Store(value.im, d, numbers + 2 * n * i + n);
}

// One pass: `butterfly(a, p)` turns the radix inputs a into their transform in place.
template <int kRadix, class Butterfly>
HWY_INLINE void fourier_pass(const FourierPlan& plan, const FourierPlan::Pass& pass,
                             const float* HWY_RESTRICT from, float* HWY_RESTRICT to,
                             const Butterfly& butterfly) {
    const std::size_t m = pass.length / kRadix, s = pass.stride;
    const FourierPlan::Complex* twiddles = plan.twiddles(pass);
    for (std::size_t p = 0; p < m; ++p, twiddles += kRadix - 1) {
        for (std::size_t q = 0; q < s; ++q) {
            Complexes a[kRadix];
            for (int k = 0; k < kRadix; ++k) a[k] = load(from, q + s * (p + m * k));
            butterfly(a);
            store(a[0], to, q + s * kRadix * p);
            for (int k = 1; k < kRadix; ++k)
                store(times(twiddles[k - 1], a[k]), to, q + s * (kRadix * p + k));
        }
    }
}

HWY_INLINE void any_radix_pass(const FourierPlan& plan, const FourierPlan::Pass& pass,
                               const float* HWY_RESTRICT from, float* HWY_RESTRICT to) {
    const std::size_t r = pass.radix, m = pass.length / r, s = pass.stride;
    const FourierPlan::Complex* twiddles = plan.twiddles(pass);
    const FourierPlan::Complex* roots = plan.roots(pass);
    for (std::size_t p = 0; p < m; ++p, twiddles += r - 1) {
        for (std::size_t q = 0; q < s; ++q) {
            for (std::size_t k = 0; k < r; ++k) {
                Complexes sum = load(from, q + s * p);
                for (std::size_t j = 1; j < r; ++j)
                    sum = sum + times(roots[j * k % r], load(from, q + s * (p + m * j)));
                store(k > 0 ? times(twiddles[k - 1], sum) : sum, to, q + s * (r * p + k));
            }
        }
    }
}

/// F_k = sum_j f_j exp(-2 pi i j k / length), in each lane. Returns where the result is: `values`
/// or `other`, both of which are overwritten.
HWY_INLINE float* transform(const FourierPlan& plan, float* values, float* other) {
    for (const FourierPlan::Pass& pass : plan.passes()) {
        switch (pass.radix) {
            case 2:
                fourier_pass<2>(plan, pass, values, other, [](Complexes* a) HWY_ATTR {
                    const Complexes b = a[0];
                    a[0] = b + a[1], a[1] = b - a[1];
                });
                break;
            case 3:
                fourier_pass<3>(plan, pass, values, other, [](Complexes* a) HWY_ATTR {
                    const Complexes sum = a[1] + a[2];
                    const Complexes difference = times(0.86602540f, a[1] - a[2]);
                    const Complexes centre = plus_scaled(a[0], -0.5f, sum);
                    a[0] = a[0] + sum;
                    a[1] = minus_i(centre, difference), a[2] = plus_i(centre, difference);
                });
                break;
            case 4:
                fourier_pass<4>(plan, pass, values, other, [](Complexes* a) HWY_ATTR {
                    const Complexes b = a[0] + a[2], c = a[0] - a[2];
                    const Complexes d = a[1] + a[3], e = a[1] - a[3];
                    a[0] = b + d, a[2] = b - d;
                    a[1] = minus_i(c, e), a[3] = plus_i(c, e);
                });
                break;
            case 5:
                fourier_pass<5>(plan, pass, values, other, [](Complexes* a) HWY_ATTR {
                    const float c1 = 0.309016994f, c2 = -0.809016994f;  // cos 72, 144 degrees
                    const float s1 = 0.951056516f, s2 = 0.587785252f;   // and their sines
                    const Complexes b = a[1] + a[4], c = a[2] + a[3];
                    const Complexes d = a[1] - a[4], e = a[2] - a[3];
                    const Complexes f = plus_scaled(plus_scaled(a[0], c1, b), c2, c);
                    const Complexes g = plus_scaled(plus_scaled(a[0], c2, b), c1, c);
                    const Complexes h = plus_scaled(times(s1, d), s2, e);
                    const Complexes i = plus_scaled(times(s2, d), -s1, e);
                    a[0] = a[0] + (b + c);
                    a[1] = minus_i(f, h), a[4] = plus_i(f, h);
                    a[2] = minus_i(g, i), a[3] = plus_i(g, i);
                });
                break;
            default:
                any_radix_pass(plan, pass, values, other);
        }
        std::swap(values, other);
    }
    return values;
}

}  // namespace HWY_NAMESPACE
}  // namespace mirrorball::detail
HWY_AFTER_NAMESPACE();

#endif
