// How far apart two environment maps are, by solid angle.
#pragma once

#include <mirrorball/environment_map.h>

namespace mirrorball {

/// Over the used texels i of one level, with a the map tested, b the reference, dw_i solid angles:
struct Difference {
    double relative_rmse;     ///< sqrt(sum |a-b|^2 dw / sum |b|^2 dw), all channels together
    double maximum;           ///< largest |a-b| of a channel
    double maximum_relative;  ///< largest |a-b| / max(b, 1e-2 rms(b)): what an eye can see
    Vec3d flux_ratio;         ///< flux(a) / flux(b), per channel
    int face, x, y;           ///< where maximum_relative is
};

/// Maps of one projection, size and frame are compared texel by texel; else a is resampled to b's.
[[nodiscard]] Difference compare(const EnvironmentMap& a, const EnvironmentMap& b, int level = 0);

}  // namespace mirrorball
