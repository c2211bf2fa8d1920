#include <mirrorball/light.h>

#include <algorithm>

namespace mirrorball {
namespace {

// I/d^2 cos(theta) with cos(theta) = z/d
Vec3d falling_on(const PointLight& light, double distance) {
    const double z = std::max(0.0, light.position.z);
    return light.intensity * (z / (distance * distance * distance));
}

}  // namespace

Vec3d irradiance(const PointLight& light) {
    return falling_on(light, light.position.length());
}

Vec3d irradiance(const DirectionalLight& light) {
    return light.normal_irradiance * std::max(0.0, light.direction.z);
}

Vec3d reflected_radiance(const Brdf& brdf, const Vec3d& wo, const PointLight& light) {
    const double distance = light.position.length();
    return brdf.evaluate(light.position / distance, wo) * falling_on(light, distance);
}

Vec3d reflected_radiance(const Brdf& brdf, const Vec3d& wo, const DirectionalLight& light) {
    return brdf.evaluate(light.direction, wo) * irradiance(light);
}

}  // namespace mirrorball
