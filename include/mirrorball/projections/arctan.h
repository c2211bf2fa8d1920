// The angle of a point in the plane, several times faster than std::atan2 and as exact to a rounding:
// what equirectangular, angular and equal-area maps spend their time on.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <mirrorball/vector.h>

namespace mirrorball::detail {

inline constexpr int kArctanSteps = 64;

inline const std::array<double, kArctanSteps + 1> kArctanTable = [] {
    std::array<double, kArctanSteps + 1> table{};
    for (int i = 0; i <= kArctanSteps; ++i) table[i] = std::atan(static_cast<double>(i) / kArctanSteps);
    return table;
}();

/// atan2(y, x) for finite arguments, within 4e-16; arctan2(0, 0) is 0.
///
/// With c a nearby step of the table and n / d <= 1 the tangent, atan(n / d) = atan(c) + atan(r),
/// r = (n - c d) / (d + c n) <= 1/128, where four terms of the series are exact to rounding.
[[gnu::always_inline]] inline double arctan2(double y, double x) {
    const double ax = std::abs(x), ay = std::abs(y);
    const bool steep = ay > ax;
    const double n = steep ? ax : ay, d = steep ? ay : ax;
    // the choice of c need not be exact; tiny numbers would round to 0 / 0
    if (d < 1e-30) return d == 0 ? 0 : std::atan2(y, x);
    const int i = static_cast<int>(static_cast<float>(n) / static_cast<float>(d) * kArctanSteps + 0.5f);
    const double c = i * (1.0 / kArctanSteps);
    const double r = (n - c * d) / (d + c * n), r2 = r * r;
    const double series = r * (1 - r2 * (1.0 / 3 - r2 * (1.0 / 5 - r2 * (1.0 / 7))));
    double angle = kArctanTable[static_cast<std::size_t>(i)] + series;
    if (steep) angle = kPi / 2 - angle;
    if (x < 0) angle = kPi - angle;
    return std::copysign(angle, y);
}

}  // namespace mirrorball::detail
