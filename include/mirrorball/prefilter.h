// Prefiltering: integrate an environment against a lobe, once per texel of the result.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <mirrorball/environment_map.h>
#include <mirrorball/progress.h>

namespace mirrorball {

/// What to make: one lobe, on a map of this projection and size (make_environment_map()).
struct PrefilterTarget {
    Lobe lobe;
    Projection projection = Projection::cube;
    int size = 64;
    Axes axes = default_axes(Projection::cube);
};

/// The truth: a sum in double precision over every used texel of level 0, with its exact solid
/// angle,
///
///     L'(r) = integral(lobe) * sum_i k(r.w_i) L_i dw_i / sum_i k(r.w_i) dw_i
///
/// (w_i the direction of the texel's centre, k the lobe). Dividing by the weights' own sum makes
/// each result a convex combination of the source: nothing rings, a uniform environment stays
/// uniform, and a lobe narrower than a texel reads the nearest one. `mirror` is a resampling
/// (resample.h). Costs source texels x result texels: about 1 ns each and thread. Same bits for any
/// thread count.
[[nodiscard]] EnvironmentMap prefilter_reference(const EnvironmentMap& source,
                                                 const PrefilterTarget& target,
                                                 const Progress& progress = {});

struct PrefilterOptions {
    /// What a result may be off by, next to the sum above: its error's root mean square over the
    /// result's own. Next to a light that outshines the mean 10^5 times the error is below 10 times
    /// that of what is there, or of a hundredth of the rms where that is more. In (0, 0.1].
    double tolerance = 1e-4;
};

/// What prefiltering gives, and how good it is.
struct Prefiltered {
    std::vector<EnvironmentMap> maps;  ///< one per target, in their order
    /// Estimates of each map's relative error (rms over rms), from the source's own spectrum: see
    /// docs/theory/spectral-prefiltering.md. Not below the real ones, and seldom ten times above;
    /// 0 for resampled (`mirror`) targets.
    std::vector<double> errors;
};

/// Prefiltering made ready for any number of sources of one shape: all that does not depend on
/// pixels. Copies share it; may be used from many threads at once.
///
/// The source is taken apart into spherical harmonics once, each target puts together those that
/// its lobe keeps, and what they cannot carry (the sharpest features around bright lights, and all
/// of lobes next to a delta) is added in space. Results are clamped to the source's range. The
/// standard chain takes about 20 ms to plan and 10 ms to run; docs/performance.md has figures.
class PrefilterPlan {
  public:
    /// \throws Error(Errc::usage) for a size or tolerance out of range
    PrefilterPlan(const MapShape& source, std::span<const PrefilterTarget> targets,
                  const PrefilterOptions& options = {});

    /// Same bits for any thread count. \throws Error(Errc::usage) if the source has another shape,
    /// or holds a value that is not finite
    [[nodiscard]] Prefiltered operator()(const EnvironmentMap& source,
                                         const Progress& progress = {}) const;
    /// Writes over what an earlier run of this plan gave: no fresh memory is touched.
    void operator()(const EnvironmentMap& source, Prefiltered& result,
                    const Progress& progress = {}) const;

    [[nodiscard]] const MapShape& source() const;
    [[nodiscard]] std::span<const PrefilterTarget> targets() const;

  private:
    class Plan;
    std::shared_ptr<const Plan> plan_;
};

/// One source made ready for any lobe, one at a time: what a slider asks for. What does not depend
/// on the lobe (harmonics, bright texels, what sums over lobes are divided by) is found when a lobe
/// first needs it, and kept: about 30 MB for a panorama of 1024 texels' width, and 30 bytes a texel
/// for lobes next to a delta. docs/performance.md has times.
class LobeFilter {
  public:
    /// Of level 0 of the source. \throws Error(Errc::usage) for a size or tolerance out of range,
    /// or if it holds a value that is not finite
    explicit LobeFilter(std::shared_ptr<const EnvironmentMap> source,
                        const PrefilterOptions& options = {});
    ~LobeFilter();

    /// Like PrefilterPlan, to its tolerance, not bit by bit. The bits depend on the source, the
    /// options and the target: not on threads, nor on what was asked for before.
    [[nodiscard]] EnvironmentMap operator()(const PrefilterTarget& target,
                                            const Progress& progress = {});

    /// Does it take at most 512 bands and no sum over the whole source? Of a panorama of 1024
    /// texels' width GGX from a roughness of 0.11 up does, to maps as fine as it asks for: some ten
    /// milliseconds at most, where sharper lobes take up to a second.
    [[nodiscard]] bool is_quick(const PrefilterTarget& target) const;

    [[nodiscard]] const EnvironmentMap& source() const;

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

/// Plan and run for one source.
[[nodiscard]] std::vector<EnvironmentMap> prefilter(const EnvironmentMap& source,
                                                    std::span<const PrefilterTarget> targets,
                                                    const Progress& progress = {});

/// Which roughness or exponent each mip level of a chain stands for, by the program that will read
/// it (docs/conventions.md): "gltf", "filament", "unreal", "unity", "playcanvas", "cmft",
/// "cmft-phongbrdf". Level 0 of most is the mirror. A program that knows fewer levels than asked
/// for has its widest lobe in those beyond. \throws Error(Errc::usage) naming the mappings there
/// are
[[nodiscard]] std::vector<Lobe> level_lobes(std::string_view mapping, int level_count);
[[nodiscard]] std::vector<std::string> level_mappings();

}  // namespace mirrorball
