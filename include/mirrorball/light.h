// Lights without extent and what a surface reflects of them: the survey's Eq. 15.
//
// Positions and directions are in the surface's own frame (brdf.h), around the point that is lit.
#pragma once

#include <mirrorball/brdf.h>
#include <mirrorball/vector.h>

namespace mirrorball {

/// A light small enough to be a point.
struct PointLight {
    Vec3d position{0, 0, 1};  ///< from the surface point, metres
    Vec3d intensity{1};       ///< radiant intensity, the same in all directions, W/sr
};

/// A light so far away that its rays are parallel: the sun.
struct DirectionalLight {
    Vec3d direction{0, 0, 1};    ///< unit, towards the light
    Vec3d normal_irradiance{1};  ///< on a surface that faces it, W/m^2
};

/// The irradiance on the surface, W/m^2: G cos(theta), with G = I/d^2 of a point light of intensity
/// I at distance d. 0 below the surface. \pre position != 0
[[nodiscard]] Vec3d irradiance(const PointLight& light);
[[nodiscard]] Vec3d irradiance(const DirectionalLight& light);

/// The radiance reflected towards wo, W m^-2 sr^-1: f(wi, wo) times that irradiance, a term of Eq.
/// 15's sum over lights. A Lambert surface of reflectance 1 under 1 W/m^2 gives 1/pi. A mirror
/// shows nothing of a light that has no extent.
[[nodiscard]] Vec3d reflected_radiance(const Brdf& brdf, const Vec3d& wo, const PointLight& light);
[[nodiscard]] Vec3d reflected_radiance(const Brdf& brdf, const Vec3d& wo,
                                       const DirectionalLight& light);

}  // namespace mirrorball
