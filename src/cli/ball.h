// A small ball under an environment's light: the picture by which people judge a prefiltered map.
#pragma once

#include <functional>

#include <mirrorball/environment_map.h>

namespace mirrorball::cli {

/// What the ball shows where its surface faces `normal`, as displayed: linear, 0 to 1.
using Shade = std::function<Vec3f(const Vec3d& normal)>;

/// Seen from +Z without perspective, looking ahead (-Z), as in the sphere map. Black outside.
[[nodiscard]] Image draw_ball(int size, const Shade& shade);

/// The mirror direction of the view at a normal.
[[nodiscard]] inline Vec3d reflected_view(const Vec3d& n) {
    return n * (2 * n.z) - Vec3d(0, 0, 1);
}

}  // namespace mirrorball::cli
