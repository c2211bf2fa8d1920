// Environments for tests, made by formula.
#pragma once

#include <functional>

#include <mirrorball/environment_map.h>

namespace mirrorball {

/// Point samples of f(world direction) at the centres of all used texels.
inline EnvironmentMap sampled(Projection projection, int size, const Axes& axes,
                              const std::function<Vec3d(const Vec3d&)>& f) {
    EnvironmentMap map = make_environment_map(projection, size);
    map.axes = axes;
    const int width = map.width(), height = map.height();
    const std::vector<double> solid_angles = solid_angle_table(projection, width, height);
    visit(projection, [&](auto p) {
        using P = decltype(p);
        for (int face = 0; face < P::face_count; ++face)
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    if (solid_angles[static_cast<std::size_t>(y) * width + x] == 0) continue;
                    const FacePoint<double> centre{face, (x + 0.5) / width, (y + 0.5) / height};
                    const Vec3d d = axes.to_world(P::direction(centre));
                    map.levels[0].faces[face].set_rgb(x, y, Vec3f(f(d)));
                }
    });
    return map;
}

inline EnvironmentMap sampled(Projection projection, int size,
                              const std::function<Vec3d(const Vec3d&)>& f) {
    return sampled(projection, size, default_axes(projection), f);
}

/// Means of f over the used part of each texel, by 8 x 8 samples (24 x 24 where the rim cuts it).
inline EnvironmentMap averaged(Projection projection, int size,
                               const std::function<Vec3d(const Vec3d&)>& f) {
    EnvironmentMap map = make_environment_map(projection, size);
    const int width = map.width(), height = map.height();
    const std::vector<double> solid_angles = solid_angle_table(projection, width, height);
    visit(projection, [&](auto p) {
        using P = decltype(p);
        for (int face = 0; face < P::face_count; ++face)
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    if (solid_angles[static_cast<std::size_t>(y) * width + x] == 0) continue;
                    const auto at = [&](double fx, double fy) {
                        return FacePoint<double>{face, (x + fx) / width, (y + fy) / height};
                    };
                    const bool cut = !P::covers(at(0, 0)) || !P::covers(at(1, 0)) ||
                                     !P::covers(at(0, 1)) || !P::covers(at(1, 1));
                    const int steps = cut ? 24 : 8;
                    Vec3d sum(0.0);
                    double weight = 0;
                    for (int j = 0; j < steps; ++j)
                        for (int i = 0; i < steps; ++i) {
                            const FacePoint<double> q = at((i + 0.5) / steps, (j + 0.5) / steps);
                            if (!P::covers(q)) continue;
                            sum += f(map.axes.to_world(P::direction(q))) * P::density(q);
                            weight += P::density(q);
                        }
                    if (weight == 0) {
                        sum = f(map.axes.to_world(P::direction(P::wrap(at(0.5, 0.5)))));
                        weight = 1;
                    }
                    map.levels[0].faces[face].set_rgb(x, y, Vec3f(sum / weight));
                }
    });
    return map;
}

/// Smooth, of no symmetry, positive, different in each channel.
inline Vec3d smooth_light(const Vec3d& d) {
    return {1 + 0.5 * d.x + 0.3 * d.y * d.z, 1.2 + 0.4 * d.y - 0.3 * d.x * d.z,
            0.9 + 0.4 * d.z + 0.2 * d.x * d.y};
}

/// Edge of a face, or width of an equirect, with about `texels_around` texels along a great circle.
inline int size_for(Projection projection, int texels_around) {
    switch (projection) {
        case Projection::equirect:
            return texels_around;
        case Projection::cube:
            return texels_around / 4;
        case Projection::dual_paraboloid:
            return texels_around / 2;
        default:
            return texels_around / 2;
    }
}

}  // namespace mirrorball
