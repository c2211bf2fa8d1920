// How methods find places on their maps.
#pragma once

#include <mirrorball/scene.h>

namespace mirrorball::detail {

/// At each pixel, or at the vertices, and interpolated in between?
[[nodiscard]] bool looks_up_per_pixel(Method method);

}  // namespace mirrorball::detail
