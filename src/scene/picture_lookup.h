// Pictures looked up as a graphics card does at their finest level.
#pragma once

#include <mirrorball/bump.h>
#include <mirrorball/image.h>
#include <mirrorball/vector.h>

namespace mirrorball::detail {

/// Bilinear; (0, 0) is the top left, (1, 1) the bottom right. Up to three channels, others are 0.
/// Places that are no numbers have the first texel.
[[nodiscard]] Vec3d look_up_picture(const Image& picture, const Imath::V2d& place, Wrap wrap);

}  // namespace mirrorball::detail
