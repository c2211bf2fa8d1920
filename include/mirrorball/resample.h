// Resampling: from any projection, size and frame to any other.
#pragma once

#include <mirrorball/environment_map.h>
#include <mirrorball/progress.h>

namespace mirrorball {

/// How values between texel centres are found where the result is finer than the source.
enum class Interpolation {
    bilinear,
    bicubic,  ///< smooth; keeps between its neighbours' values, so a sun leaves no dark ring
};

struct ResampleOptions {
    Interpolation interpolation = Interpolation::bicubic;
    Progress progress = {};
};

/// Each texel of the result is the mean of the source over the texel's solid angle:
///
///     L'(texel) = integral over the texel of L dw / solid angle of the texel
///
/// with L interpolated between source texels across face edges and poles. The integral is in closed
/// form over the box of source texels that lies under the texel, or over the cells of one that is
/// large or lies askew, so nothing of the source is passed over however much smaller the result is.
/// A conversion that changes nothing (same projection, size and frame) returns the same bits. Level
/// 0 of the source is read. Costs about 100 ns per texel of the result and thread, more where the
/// result is much smaller. How exact it is: docs/theory/resampling.md.
///
/// `size` as in make_environment_map(); the result is in `axes`. Same bits for any thread count.
[[nodiscard]] EnvironmentMap resample(const EnvironmentMap& source, Projection projection, int size,
                                      const Axes& axes, const ResampleOptions& options = {});

/// Appends levels of half the size, rounded down, to 1 x 1 (equirect: 2 x 1), or `level_count` in
/// all. A texel is the mean of those under it, by exact solid angle: every level has level 0's
/// flux, to rounding. \pre map has one level
void append_mip_levels(EnvironmentMap& map, int level_count = 0);

/// The number of levels down to the smallest.
[[nodiscard]] int full_level_count(Projection projection, int size);

}  // namespace mirrorball
