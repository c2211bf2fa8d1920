// The maps that a renderer should have made of an environment, made on the processor.
#pragma once

#include <mirrorball/environment_map.h>
#include <mirrorball/reflection_maps.h>
#include <mirrorball/scene.h>

#include "warped_map.h"

namespace mirrorball::gl {

/// As fine as a cube of the scene's map_size.
inline ReflectionMaps maps_for(const Scene& scene, const EnvironmentMap& environment) {
    const Projection projection = projection_of(scene.method);
    const bool has_rim =
        projection == Projection::sphere || projection == Projection::dual_paraboloid;
    const Projection source = has_rim ? Projection::cube : projection;
    const int size = scene.map_size * (source == Projection::cube       ? 1
                                       : source == Projection::equirect ? 4
                                                                        : 2);
    ReflectionMaps maps =
        make_reflection_maps(environment, lobes_of(scene), source, size, default_axes(source));
    if (has_rim) {
        const Axes frame =
            projection == Projection::sphere ? axes(scene.camera) : default_axes(projection);
        maps.mirror = warped(maps.mirror, projection, frame);
        maps.diffuse = warped(maps.diffuse, projection, frame);
        for (EnvironmentMap& map : maps.glossy) map = warped(map, projection, frame);
    }
    return maps;
}

}  // namespace mirrorball::gl
