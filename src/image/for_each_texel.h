// The used texels of a map, one after the other: faces in order, rows from the top.
#pragma once

#include <vector>

#include <mirrorball/environment_map.h>

namespace mirrorball::detail {

/// Calls f(face, x, y, solid angle in steradians).
template <class F>
void for_each_texel(const EnvironmentMap& map, int level, F&& f) {
    const int width = map.width(level), height = map.height(level);
    const std::vector<double> solid_angles = solid_angle_table(map.projection, width, height);
    for (int face = 0; face < face_count(map.projection); ++face) {
        std::size_t i = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x, ++i)
                if (solid_angles[i] > 0) f(face, x, y, solid_angles[i]);
    }
}

/// Calls f(direction of the texel's centre in the world, radiance, solid angle).
template <class F>
void for_each_direction(const EnvironmentMap& map, int level, F&& f) {
    const int width = map.width(level), height = map.height(level);
    visit(map.projection, [&](auto p) {
        for_each_texel(map, level, [&](int face, int x, int y, double solid_angle) {
            const FacePoint<double> centre{face, (x + 0.5) / width, (y + 0.5) / height};
            f(map.axes.to_world(decltype(p)::direction(centre)),
              map.levels[level].faces[face].rgb(x, y), solid_angle);
        });
    });
}

}  // namespace mirrorball::detail
