// Moving a camera by hand: about what it looks at, nearer and farther, and sideways.
#pragma once

#include <mirrorball/scene.h>

namespace mirrorball {

/// Goes around the target: `yaw` to the right, as if the target turned to the left, about the axis
/// `up`, and `pitch` upwards, to 89 degrees at most either way. The distance stays.
[[nodiscard]] Camera orbited(const Camera& camera, double yaw, double pitch);

/// `factor` times as far from the target. The distance stays from 1e-4 to 1e6 metres.
[[nodiscard]] Camera zoomed(const Camera& camera, double factor);

/// Eye and target move in the picture's plane such that what is at the target's distance moves by
/// (right, up) heights of the picture.
[[nodiscard]] Camera panned(const Camera& camera, double right, double up);

}  // namespace mirrorball
