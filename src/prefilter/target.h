// What every way of prefiltering does with its target map.
#pragma once

#include <functional>

#include <mirrorball/prefilter.h>

namespace mirrorball::detail {

[[nodiscard]] MapShape shape_of(const PrefilterTarget& target);
/// All zero.
[[nodiscard]] EnvironmentMap make_target(const PrefilterTarget& target);

/// A delta lobe changes nothing: the target is the source, resampled.
[[nodiscard]] EnvironmentMap mirror_target(const EnvironmentMap& source,
                                           const PrefilterTarget& target, const Progress& progress);

/// A map whose every used texel is f(direction of its centre in the world). Texels that a rim cuts
/// through, with their centres outside it, take the direction that lies there across the rim.
[[nodiscard]] EnvironmentMap fill_target(const PrefilterTarget& target,
                                         const std::function<Vec3d(const Vec3d&)>& f,
                                         const Progress& progress);

}  // namespace mirrorball::detail
