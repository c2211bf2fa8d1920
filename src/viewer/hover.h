// Hover: what one pixel sees, by a ray through the scene's triangles.
#pragma once

#include <mirrorball/scene_assets.h>
#include <mirrorball/viewer.h>

namespace mirrorball {

/// `x` and `y` from 0 to 1, (0, 0) at the top left. Some 10 ns per triangle.
[[nodiscard]] Hover hover_at(const Scene& scene, const SceneAssets& assets, double x, double y,
                             double aspect);

}  // namespace mirrorball
