// The sizes that maps may have.
#pragma once

#include <mirrorball/projection.h>

namespace mirrorball::detail {

/// \throws Error(Errc::usage) as make_environment_map() does
void check_map_size(Projection projection, int size);

}  // namespace mirrorball::detail
