// The Legendre stage of one order, for one processor. Included once for each by foreach_target.h.
//
// Its cost is the transform's: twelve multiply-adds in float for each ring pair and two degrees,
// and the recurrence, two multiply-adds in double. The recurrence must be in double: its rounding
// errors add up over hundreds of steps, those of the sums do not.
#if defined(MIRRORBALL_LEGENDRE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef MIRRORBALL_LEGENDRE_INL_H
#undef MIRRORBALL_LEGENDRE_INL_H
#else
#define MIRRORBALL_LEGENDRE_INL_H
#endif

#include <cmath>

#include "harmonics/fourier-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mirrorball::detail {
namespace HWY_NAMESPACE {

/// Half of the rings of a vector of floats.
using HalfLanes = hn::Half<Lanes>;
using DoubleLanes = hn::Rebind<double, HalfLanes>;
using DoubleVec = hn::Vec<DoubleLanes>;

/// What a group of ring pairs carries from step to step of the recurrence.
struct Recurrence {
    DoubleVec x2[2], now[2], before[2];

    /// `seeds` is p_n and p_{n-1}, [2][lane].
    HWY_INLINE Recurrence(const double* x, const double* seeds) {
        const DoubleLanes d;
        const std::size_t half = hn::Lanes(d), n = 2 * half;
        for (std::size_t i = 0; i < 2; ++i) {
            const DoubleVec v = hn::Load(d, x + half * i);
            x2[i] = hn::Mul(v, v);
            now[i] = hn::Load(d, seeds + half * i);
            before[i] = hn::Load(d, seeds + n + half * i);
        }
    }
    HWY_INLINE void save(double* seeds) const {
        const DoubleLanes d;
        const std::size_t half = hn::Lanes(d), n = 2 * half;
        for (std::size_t i = 0; i < 2; ++i) {
            hn::Store(now[i], d, seeds + half * i);
            hn::Store(before[i], d, seeds + n + half * i);
        }
    }
    HWY_INLINE Vec value() const {
        const HalfLanes half;
        return hn::Combine(Lanes(), hn::DemoteTo(half, now[1]), hn::DemoteTo(half, now[0]));
    }
    HWY_INLINE void advance(const LegendreTable::Step& step) {
        const DoubleLanes d;
        const DoubleVec alpha = hn::Set(d, step.alpha), beta = hn::Set(d, step.beta);
        for (int i = 0; i < 2; ++i) {
            const DoubleVec factor = hn::MulAdd(alpha, x2[i], beta);
            const DoubleVec next = hn::MulSub(factor, now[i], before[i]);
            before[i] = now[i], now[i] = next;
        }
    }
};

/// The sums over lanes of kCount vectors, in the lanes of one (the first kCount of it): halves are
/// folded onto each other in pairs, in an order that is always the same.
template <int kCount>
HWY_INLINE Vec folded(const Vec* v) {
    const Lanes d;
    if constexpr (kCount == 1) {
        return v[0];
    } else {
        const Vec a = folded<kCount / 2>(v), b = folded<kCount / 2>(v + kCount / 2);
        return hn::Add(hn::ConcatEven(d, b, a), hn::ConcatOdd(d, b, a));
    }
}

/// The sums over lanes of four vectors go to sums[0..3]; what follows them, up to a whole vector,
/// is overwritten, too.
HWY_INLINE void store_sums_of_4(const Vec* v, float* sums) {
    const Lanes d;
    Vec sum = folded<4>(v);
    for (std::size_t left = hn::Lanes(d) / 4; left > 1; left /= 2)
        sum = hn::Add(hn::ConcatEven(d, sum, sum), hn::ConcatOdd(d, sum, sum));
    hn::StoreU(sum, d, sums);
}

}  // namespace HWY_NAMESPACE
}  // namespace mirrorball::detail
HWY_AFTER_NAMESPACE();

#endif
