// Directions in the plane of a vertex.
#pragma once

#include <mirrorball/mesh.h>

namespace mirrorball::detail {

/// A normal that was rounded to float is not quite unit, which would show where `v` is close to it.
[[nodiscard]] inline Vec3d in_plane(const Vec3d& v, const Vec3d& normal) {
    return v - normal * (v.dot(normal) / normal.length2());
}

/// 0 where `v` is 0, or so close to the normal that what is left is the rounding of both.
[[nodiscard]] inline Vec3d unit_in_plane(const Vec3d& v, const Vec3d& normal) {
    constexpr double kLeastSine = 1e-6;
    const Vec3d left = in_plane(v.normalized(), normal);
    return left.length() > kLeastSine ? left.normalized() : Vec3d(0);
}

[[nodiscard]] inline Vec4f tangent_of(const Vec3d& direction, float handedness) {
    const Vec3f rounded(direction);
    return {rounded.x, rounded.y, rounded.z, handedness};
}

}  // namespace mirrorball::detail
