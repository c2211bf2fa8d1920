// The angle of a point in the plane, several times faster than std::atan2 and as exact to a
// rounding: what equirectangular, angular and equal-area maps spend their time on.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <mirrorball/vector.h>

namespace mirrorball::detail {

inline constexpr int kArctanSteps = 64;

inline const std::array<double, kArctanSteps + 1> kArctanTable = [] {
    std::array<double, kArctanSteps + 1> table{};
    for (int i = 0; i <= kArctanSteps; ++i)
        table[i] = std::atan(static_cast<double>(i) / kArctanSteps);
    return table;
}();

/// atan2(y, x) for finite arguments, within 9e-16; arctan2(0, 0) is 0. Without branches, so that a
/// loop of it becomes vector code.
///
/// With c a nearby step of the table and n / d <= 1 the tangent, atan(n / d) = atan(c) + atan(r),
/// r = (n - c d) / (d + c n) <= 1/128, where four terms of the series are exact to rounding.
[[gnu::always_inline]] inline double arctan2(double y, double x) {
    const double ax = std::abs(x), ay = std::abs(y);
    const bool steep = ay > ax;
    const double n = steep ? ax : ay, longer = steep ? ay : ax;
    const double d = longer > 1e-300 ? longer : 1e-300;  // 0 / 0 is 0 here
    const int i = static_cast<int>(n / d * kArctanSteps + 0.5);
    const double c = i * (1.0 / kArctanSteps);
    const double r = (n - c * d) / (d + c * n), r2 = r * r;
    const double series = r * (1 - r2 * (1.0 / 3 - r2 * (1.0 / 5 - r2 * (1.0 / 7))));
    const double below = kArctanTable[static_cast<std::size_t>(i)] + series;
    const double folded = steep ? kPi / 2 - below : below;
    const double angle = x < 0 ? kPi - folded : folded;
    return std::copysign(angle, y);
}

}  // namespace mirrorball::detail
