#include "scene/scene_bounds.h"

namespace mirrorball::detail {

Bounds bounds_of(const Scene& scene, const SceneAssets& assets) {
    Mesh corners;
    for (const SceneObject& object : scene.objects) {
        for (const Vec3f& position : assets.meshes.at(object.mesh).positions)
            corners.positions.push_back(Vec3f(object.transform.point(Vec3d(position))));
    }
    return bounds(corners);
}

}  // namespace mirrorball::detail
