// Environments into texels: each is the mean of the radiance over its solid angle.
#pragma once

#include <mirrorball/environment_map.h>
#include <mirrorball/progress.h>

#include "environment.h"

namespace mirrorball::detail {

/// \throws as make_environment_map(); Error(Errc::cancelled)
[[nodiscard]] EnvironmentMap rasterise(const Environment& environment, Projection projection,
                                       int size, const Axes& axes, const Progress& progress);

}  // namespace mirrorball::detail
