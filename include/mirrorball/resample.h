// Resampling: from any projection, size and frame to any other.
#pragma once

#include <cstddef>
#include <memory>

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

/// resample() for many maps of one shape: what does not depend on pixels is worked out once. Gives
/// the same bits. Copies share it; may be used from many threads at once.
///
/// Holds 16 bytes per texel of the result and 24 per cell of a texel that is cut into cells, less
/// what symmetries save: parts of the result that take alike from alike parts of the source share
/// theirs. A cube map of a panorama in like axes holds a twelfth. bytes() says how much it is.
/// Where the result is much the finer, a run needs as much memory again as the source while it
/// lasts.
class Resampler {
  public:
    /// \throws Error(Errc::usage) as make_environment_map() does
    Resampler(const MapShape& source, const MapShape& target,
              Interpolation interpolation = Interpolation::bicubic);

    /// \throws Error(Errc::usage) if the source is not of the plan's shape
    [[nodiscard]] EnvironmentMap operator()(const EnvironmentMap& source,
                                            const Progress& progress = {}) const;
    /// Writes level 0 of a map that is there already: all of it, unused texels as zero. No fresh
    /// memory is touched, which costs more than the work at times.
    /// \throws Error(Errc::usage) if either is not of the plan's shape
    void operator()(const EnvironmentMap& source, EnvironmentMap& result,
                    const Progress& progress = {}) const;

    [[nodiscard]] std::size_t bytes() const;

  private:
    class Plan;
    friend EnvironmentMap resample(const EnvironmentMap&, Projection, int, const Axes&,
                                   const ResampleOptions&);
    std::shared_ptr<const Plan> plan_;
};

/// Appends levels of half the size, rounded down, to 1 x 1 (equirect: 2 x 1), or `level_count` in
/// all. A texel is the mean of those under it, by exact solid angle: every level has level 0's
/// flux, to rounding. \pre map has one level
void append_mip_levels(EnvironmentMap& map, int level_count = 0);

/// The number of levels down to the smallest.
[[nodiscard]] int full_level_count(Projection projection, int size);

}  // namespace mirrorball
