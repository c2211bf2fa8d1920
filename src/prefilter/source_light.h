// What prefiltering needs to know of a source's texels besides their harmonics.
#pragma once

#include <vector>

#include <mirrorball/environment_map.h>

#include "prefilter/near_field.h"

namespace mirrorball::detail {

struct SourceRange {
    Vec3f lowest, highest;    ///< per channel
    std::vector<float> rows;  ///< greatest value of each row, face after face
};

/// Over the used texels of level 0.
/// \throws Error(Errc::usage) if a value is not finite: one would be in every result
[[nodiscard]] SourceRange range_of(const EnvironmentMap& map,
                                   const std::vector<double>& solid_angles);

/// What of each texel is above `threshold`, in any channel: with it taken off, what is left has no
/// lights, and no new edges either.
[[nodiscard]] std::vector<Light> lights_above(const EnvironmentMap& map,
                                              const std::vector<double>& solid_angles,
                                              const SourceRange& range, float threshold);

/// Every used texel.
[[nodiscard]] std::vector<Light> all_lights(const EnvironmentMap& map,
                                            const std::vector<double>& solid_angles);

/// The standard deviation over the sphere and the channels of what lights_above() leaves.
[[nodiscard]] double deviation_below(const EnvironmentMap& map,
                                     const std::vector<double>& solid_angles, float threshold);

}  // namespace mirrorball::detail
