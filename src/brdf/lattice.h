// Points of even spread in the unit cube, for integrals over a sampler's numbers.
#pragma once

#include <cmath>

#include <mirrorball/vector.h>

namespace mirrorball::detail {

/// Point i of `count`: i/count along one side, and multiples of two irrational numbers, modulo 1,
/// along the others: 1/p and 1/p^2 with p^3 = p + 1, which are hard to approximate together by
/// fractions (Niederreiter 1978; the choice is Roberts' of 2018).
/// \param shift  moves all points, modulo 1: equally even sets to tell the error by
inline Vec3d lattice_point(int i, int count, const Vec3d& shift = Vec3d(0)) {
    constexpr double kPlastic = 1.32471795724474602596;
    const auto wrapped = [](double x) { return x - std::floor(x); };
    return {wrapped((i + 0.5) / count + shift.x), wrapped((i + 0.5) / kPlastic + shift.y),
            wrapped((i + 0.5) / (kPlastic * kPlastic) + shift.z)};
}

}  // namespace mirrorball::detail
