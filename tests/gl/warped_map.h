// What warp.frag does, on the processor: maps with rims out of a cube map.
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

/// A sphere map or a pair of paraboloids, twice as wide as the cube's faces, each texel looked up
/// in the level that suits. Beyond the rim a sphere map goes on with what is there.
inline EnvironmentMap warped(const EnvironmentMap& cube, Projection projection, const Axes& axes) {
    const int size = 2 * cube.width();
    EnvironmentMap map = make_environment_map({projection, size, axes});
    visit(projection, [&](auto p) {
        using P = decltype(p);
        for (int face = 0; face < P::face_count; ++face) {
            for (int y = 0; y < size; ++y) {
                for (int x = 0; x < size; ++x) {
                    const FacePoint<double> place{face, (x + 0.5) / size, (y + 0.5) / size};
                    const bool is_used = P::covers(place);
                    const Vec3d d = axes.to_world(is_used ? P::direction(place) : Vec3d(0, 0, -1));
                    const double density = is_used ? P::density(place) : 16;
                    const double texel = density / (static_cast<double>(size) * size);
                    const double lod = 0.5 * std::log2(texel / texel_solid_angle(cube, d));
                    map.levels[0].faces[face].set_rgb(x, y,
                                                      look_up_at_lod(cube, d, std::max(0.0, lod)));
                }
            }
        }
    });
    return map;
}

}  // namespace mirrorball::gl
