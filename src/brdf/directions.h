// Directions about a normal or another axis, and the densities by which they are drawn.
#pragma once

#include <algorithm>
#include <cmath>

#include <mirrorball/vector.h>

namespace mirrorball::detail {

inline Vec3d mirrored(const Vec3d& w) {
    return {-w.x, -w.y, w.z};
}

/// The direction at a given cosine to z and azimuth.
inline Vec3d spherical(double cosine, double azimuth) {
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

/// `local` turned so that z becomes `axis`.
/// Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
inline Vec3d about(const Vec3d& axis, const Vec3d& local) {
    const double sign = std::copysign(1.0, axis.z);
    const double a = -1 / (sign + axis.z), b = axis.x * axis.y * a;
    const Vec3d x(1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x);
    const Vec3d y(b, sign + axis.y * axis.y * a, -axis.y);
    return x * local.x + y * local.y + axis * local.z;
}

/// Of density z / pi over the hemisphere: points of the unit disc, lifted.
inline Vec3d cosine_direction(double u, double v) {
    return spherical(std::sqrt(1 - u), 2 * kPi * v);
}
inline double cosine_density(const Vec3d& w) {
    return std::max(0.0, w.z) / kPi;
}

/// Of density (N+1)/(2 pi) max(z, 0)^N.
inline Vec3d power_direction(double exponent, double u, double v) {
    return spherical(std::pow(1 - u, 1 / (exponent + 1)), 2 * kPi * v);
}
inline double power_density(double exponent, double cosine) {
    return cosine > 0 ? (exponent + 1) / (2 * kPi) * std::pow(cosine, exponent) : 0;
}

/// The half vector, into the upper hemisphere: the normal of the mirror that sends wo to wi.
/// 0 if they are opposite.
inline Vec3d half_vector(const Vec3d& wi, const Vec3d& wo) {
    const Vec3d sum = wi + wo;
    const double length = sum.length();
    if (!(length > 0)) return Vec3d(0);
    return sum * ((sum.z < 0 ? -1 : 1) / length);
}

inline Vec3d reflected(const Vec3d& wo, const Vec3d& h) {
    return h * (2 * wo.dot(h)) - wo;
}

/// A density of half vectors as one of reflected directions: dh = dwi / (4 |wo.h|). Mirrors that
/// face away from wo reflect just as those that face it, so this holds on the whole sphere.
inline double reflected_density(double half_density, const Vec3d& wo, const Vec3d& h) {
    const double cosine = std::abs(wo.dot(h));
    return half_density > 0 && cosine > 0 ? half_density / (4 * cosine) : 0;
}

}  // namespace mirrorball::detail
