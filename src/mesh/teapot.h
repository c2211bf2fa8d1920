// Newell's teapot.
#pragma once

#include <mirrorball/mesh.h>

namespace mirrorball::detail {

/// \pre detail >= 1
[[nodiscard]] Mesh make_teapot(int detail);

}  // namespace mirrorball::detail
