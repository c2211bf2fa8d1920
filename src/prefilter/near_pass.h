// The near part of a target: lights added to texels that harmonics made.
#pragma once

#include <mirrorball/environment_map.h>
#include <mirrorball/progress.h>

#include "prefilter/near_field.h"

namespace mirrorball::detail {

/// Adds the near part of `field` to every texel of the map's level 0 and clamps it to [lowest,
/// highest] per channel.
void add_near(const NearField& field, const NearKernel& near, const Vec3f& lowest,
              const Vec3f& highest, EnvironmentMap& map, const Progress& progress = {});

/// The same where `field` is the whole source: texels are then divided by the lobe's own sum over
/// it, whose far part is in `far_weights` (a map of the same shape, first channel), and multiplied
/// by `integral`.
void add_near_normalised(const NearField& field, const NearKernel& near,
                         const EnvironmentMap& far_weights, double integral, const Vec3f& lowest,
                         const Vec3f& highest, EnvironmentMap& map, const Progress& progress = {});

}  // namespace mirrorball::detail
