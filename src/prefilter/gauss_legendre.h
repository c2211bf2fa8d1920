// Gauss-Legendre quadrature: exact for polynomials to degree 2 n - 1.
#pragma once

#include <span>

namespace mirrorball::detail {

struct QuadraturePoint {
    double x, weight;  // x in (-1, 1); the weights add up to 2
};

/// The rule of 8, 16 or 32 points.
[[nodiscard]] std::span<const QuadraturePoint> gauss_legendre(int count);

/// The integral of f from a to b by 16 points.
template <class F>
double integrate(double a, double b, F&& f) {
    const double centre = (a + b) / 2, half = (b - a) / 2;
    double sum = 0;
    for (const auto& [x, weight] : gauss_legendre(16)) sum += weight * f(centre + half * x);
    return sum * half;
}

}  // namespace mirrorball::detail
