// Prefiltering: integrate an environment against a lobe, once per texel of the result.
#pragma once

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

/// The same, fast: a chain or set of results from one source.
///
/// Today it sorts the source's texels into a quadtree on the faces of a cube and takes whole cells
/// of it where they are small against the lobe's width or, for GGX's long tail, against their
/// distance from the lobe's axis. Error and cost: tests/prefilter/prefilter_test.cpp, docs/theory.
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
