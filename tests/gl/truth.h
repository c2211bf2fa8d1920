// The equations at Material in scene.h, pixel by pixel, in double precision: as plain as they can be
// written, apart from the library's own evaluation and from the shaders.
#pragma once

#include <algorithm>
#include <cmath>

#include <mirrorball/dfg.h>
#include <mirrorball/lookup.h>
#include <mirrorball/reflection_maps.h>
#include <mirrorball/scene.h>

namespace mirrorball::gl {

/// A place on a surface, as an eye sees it.
struct Seen {
    Vec3d position, n, v;  ///< n to the eye's side
    double n_dot_v;
    bool inside;  ///< the mesh's normal points away from the eye

    [[nodiscard]] Vec3d r() const { return n * (2 * n_dot_v) - v; }
    /// Refracted, of length 0 where all is reflected.
    [[nodiscard]] Vec3d t(double index) const {
        const double eta = inside ? index : 1 / index;
        const double k = 1 - eta * eta * (1 - n_dot_v * n_dot_v);
        return k < 0 ? Vec3d(0) : -v * eta + n * (eta * n_dot_v - std::sqrt(k));
    }
};

inline Seen seen_at(const Vec3d& position, const Vec3d& normal, const Vec3d& eye) {
    Seen seen{position, normal.normalized(), (eye - position).normalized(), 0, false};
    seen.inside = seen.n.dot(seen.v) < 0;
    if (seen.inside) seen.n = -seen.n;
    seen.n_dot_v = std::min(1.0, seen.n.dot(seen.v));
    return seen;
}

/// Where a ray that starts inside a proxy leaves it, as seen from where the map was taken.
inline Vec3d from_capture(const SceneEnvironment& environment, const Vec3d& position,
                          const Vec3d& d) {
    double t = 1e300;
    if (const auto* box = std::get_if<BoxProxy>(&environment.proxy)) {
        for (int i = 0; i < 3; ++i) {
            const double wall = d[i] > 0 ? box->most[i] : box->least[i];
            if (d[i] != 0) t = std::min(t, (wall - position[i]) / d[i]);
        }
    } else if (const auto* sphere = std::get_if<SphereProxy>(&environment.proxy)) {
        const Vec3d p = position - sphere->centre;
        const double b = p.dot(d) / d.length2();
        t = -b + std::sqrt(b * b - (p.length2() - sphere->radius * sphere->radius) / d.length2());
    } else {
        return d;
    }
    return position + d * t - environment.captured_at;
}

/// Mirrored or refracted light is looked up in level 0.
inline Vec3d radiance_of(const Scene& scene, const Material& material, const Vec3d& base_color,
                         const ReflectionMaps& maps, const Seen& seen) {
    const auto light = [&](const EnvironmentMap& map, const Vec3d& d) {
        return Vec3d(look_up(map, from_capture(scene.environment, seen.position, d)));
    };
    const Vec3d f = material.fresnel(seen.n_dot_v);
    Vec3d of_layer = f, of_base = Vec3d(1);
    if (material.coupling == Coupling::layered) of_base = Vec3d(1) - f;
    if (material.coupling == Coupling::split_sum) {
        const Dfg dfg = ggx_dfg(seen.n_dot_v, material.lobe.parameter);
        const Vec3d f0 = material.fresnel(1), f90 = material.fresnel(0);
        of_layer = (f0 * dfg.scale + f90 * dfg.bias) * energy_compensation(f0, dfg.albedo());
        for (int c = 0; c < 3; ++c) of_base[c] = std::max(0.0, 1 - of_layer[c]);
    }
    const double intensity = scene.environment.intensity;
    Vec3d layer(0), sum(0);
    if (material.mirror > 0) layer += light(maps.mirror, seen.r()) * material.mirror;
    if (material.glossy > 0)
        layer += light(maps.glossy[maps.index_of(material.lobe)], seen.r()) * material.glossy;
    sum += of_layer * layer * intensity;
    const Vec3d diffuse = of_base * base_color * (material.diffuse / kPi);
    if (material.diffuse > 0) sum += diffuse * Vec3d(look_up(maps.diffuse, seen.n)) * intensity;
    const Vec3d t = seen.t(material.index);
    if (material.transmission > 0 && t.length() > 0) {
        sum += base_color * (Vec3d(1) - f) * light(maps.mirror, t) *
               (material.transmission * intensity);
    }
    for (const SceneLight& any : scene.lights) {
        const auto* point = std::get_if<ScenePointLight>(&any);
        const auto* sun = std::get_if<SceneDirectionalLight>(&any);
        const Vec3d to_light = point ? point->position - seen.position : sun->direction;
        const Vec3d arriving =
            point ? point->intensity / to_light.length2() : sun->normal_irradiance;
        const double n_dot_l = seen.n.dot(to_light.normalized());
        if (n_dot_l > 0) sum += diffuse * arriving * n_dot_l;
    }
    return sum;
}

}  // namespace mirrorball::gl
