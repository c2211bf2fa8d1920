// What warp.frag does, on the processor: a sphere map for a camera out of a cube map.
#pragma once

#include <algorithm>
#include <cmath>

#include <mirrorball/lookup.h>
#include <mirrorball/projection.h>
#include <mirrorball/projections/sphere.h>

namespace mirrorball::gl {

inline double texel_solid_angle(const EnvironmentMap& map, const Vec3d& world) {
    const Vec3d d = map.axes.to_map(world).normalized();
    double density = 0;
    visit(map.projection, [&](auto p) {
        using P = decltype(p);
        density = P::density(P::project(d));
    });
    return density / (static_cast<double>(map.width()) * map.height());
}

/// Twice as wide as the cube's faces, each texel looked up in the level that suits. Beyond the rim
/// it goes on with what is there.
inline EnvironmentMap warped_to_sphere(const EnvironmentMap& cube, const Axes& camera) {
    const int size = 2 * cube.width();
    EnvironmentMap map = make_environment_map({Projection::sphere, size, camera});
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const FacePoint<double> place{0, (x + 0.5) / size, (y + 0.5) / size};
            const Vec3d d = camera.to_world(SphereMap::covers(place) ? SphereMap::direction(place)
                                                                     : Vec3d(0, 0, -1));
            const double lod = 0.5 * std::log2(16.0 / (size * size) / texel_solid_angle(cube, d));
            map.levels[0].faces[0].set_rgb(x, y, look_up_at_lod(cube, d, std::max(0.0, lod)));
        }
    }
    return map;
}

}  // namespace mirrorball::gl
