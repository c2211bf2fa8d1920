// Points of even spread in the unit cube, for integrals over a sampler's numbers.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include <mirrorball/vector.h>

namespace mirrorball::detail {

inline double wrapped(double x) {
    return x - std::floor(x);
}

/// Point i of `count`: i/count along x, and multiples of two irrational numbers, modulo 1, along
/// the others: 1/p and 1/p^2 with p^3 = p + 1, which are hard to approximate together by fractions
/// (Niederreiter 1978; the choice is Roberts' of 2018). x goes there and back (the tent of
/// Hickernell 2002): integrands that differ at its ends are integrated as well as periodic ones.
/// \param shift  moves all points, modulo 1: equally even sets to tell the error by
inline Vec3d lattice_point(int i, int count, const Vec3d& shift = Vec3d(0)) {
    constexpr double kRoot = 1.32471795724474602596;
    const double x = wrapped((i + 0.5) / count + shift.x);
    return {1 - std::abs(2 * x - 1), wrapped(i / kRoot + shift.y),
            wrapped(i / (kRoot * kRoot) + shift.z)};
}

/// The same in six dimensions, by p^6 = p + 1.
using SixNumbers = std::array<double, 6>;
inline SixNumbers lattice_point6(int i, int count, const SixNumbers& shift = {}) {
    constexpr double kRoot = 1.13472413840151949261;
    const double x = wrapped((i + 0.5) / count + shift[0]);
    SixNumbers point{1 - std::abs(2 * x - 1)};
    double step = 1;
    for (int d = 1; d < 6; ++d) {
        step /= kRoot;
        point[d] = wrapped(i * step + shift[d]);
    }
    return point;
}

/// A fixed number in [0,1) per set and dimension, as if drawn by lot: the bits of splitmix64.
inline double lattice_shift(int set, int dimension) {
    std::uint64_t bits =
        (std::uint64_t(set) * 8 + std::uint64_t(dimension) + 1) * 0x9e3779b97f4a7c15u;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((bits ^ (bits >> 31)) >> 11) * 0x1p-53;
}

}  // namespace mirrorball::detail
