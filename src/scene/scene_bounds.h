// Bounds of all that a scene's objects are, where they stand.
#pragma once

#include <mirrorball/mesh.h>
#include <mirrorball/scene.h>
#include <mirrorball/scene_assets.h>

namespace mirrorball::detail {

/// Of the world. \pre the scene has an object, and the assets its meshes
[[nodiscard]] Bounds bounds_of(const Scene& scene, const SceneAssets& assets);

}  // namespace mirrorball::detail
