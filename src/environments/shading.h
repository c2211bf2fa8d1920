// Small functions that all built-in environments shape their light with.
#pragma once

#include <algorithm>
#include <cmath>

#include <mirrorball/vector.h>

namespace mirrorball::detail {

[[nodiscard]] inline double radians(double degrees) {
    return degrees * (kPi / 180);
}

/// 0 below `low`, 1 above `high`, smooth between.
[[nodiscard]] inline double smoothstep(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

template <class T>
[[nodiscard]] T mix(const T& a, const T& b, double t) {
    return a * (1 - t) + b * t;
}

[[nodiscard]] inline Vec3d exp(const Vec3d& v) {
    return {std::exp(v.x), std::exp(v.y), std::exp(v.z)};
}

/// The direction at an elevation above the horizon and an azimuth to the right of -Z, in radians.
[[nodiscard]] inline Vec3d direction_at(double elevation, double azimuth) {
    return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
            -std::cos(elevation) * std::cos(azimuth)};
}

}  // namespace mirrorball::detail
