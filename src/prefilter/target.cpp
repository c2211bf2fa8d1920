#include "prefilter/target.h"

#include <mirrorball/resample.h>

#include "core/parallel.h"

namespace mirrorball::detail {

MapShape shape_of(const PrefilterTarget& target) {
    return {target.projection, target.size, target.axes};
}

EnvironmentMap make_target(const PrefilterTarget& target) {
    EnvironmentMap map = make_environment_map(shape_of(target));
    map.levels[0].lobe = target.lobe;
    return map;
}

EnvironmentMap mirror_target(const EnvironmentMap& source, const PrefilterTarget& target,
                             const Progress& progress) {
    EnvironmentMap map =
        resample(source, target.projection, target.size, target.axes, {.progress = progress});
    map.levels[0].lobe = target.lobe;
    return map;
}

EnvironmentMap fill_target(const PrefilterTarget& target,
                           const std::function<Vec3d(const Vec3d&)>& f, const Progress& progress) {
    EnvironmentMap map = make_target(target);
    const int width = map.width(), height = map.height();
    const std::vector<double> solid_angles = solid_angle_table(map.projection, width, height);
    visit(target.projection, [&](auto p) {
        using P = decltype(p);
        parallel_for(
            std::int64_t{P::face_count} * height,
            [&](std::int64_t row) {
                const int face = static_cast<int>(row / height), y = static_cast<int>(row % height);
                for (int x = 0; x < width; ++x) {
                    if (solid_angles[static_cast<std::size_t>(y) * width + x] == 0) continue;
                    const FacePoint<double> centre{face, (x + 0.5) / width, (y + 0.5) / height};
                    const Vec3d axis = target.axes.to_world(P::direction(centre));
                    map.levels[0].faces[face].set_rgb(x, y, Vec3f(f(axis)));
                }
            },
            progress);
    });
    return map;
}

}  // namespace mirrorball::detail
