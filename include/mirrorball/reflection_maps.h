// ReflectionMaps: what the materials of a scene look up, made of its environment beforehand.
#pragma once

#include <span>
#include <vector>

#include <mirrorball/environment_map.h>
#include <mirrorball/lobe.h>
#include <mirrorball/progress.h>
#include <mirrorball/projection.h>
#include <mirrorball/scene.h>

namespace mirrorball {

/// All of one projection and in one frame.
struct ReflectionMaps {
    EnvironmentMap mirror;               ///< radiance, with box-filtered mip levels
    std::vector<Lobe> lobes;             ///< each once
    std::vector<EnvironmentMap> glossy;  ///< radiance prefiltered by lobes[i], one level
    EnvironmentMap diffuse;              ///< irradiance, one level

    /// Where `lobe` stands in `lobes`. \pre it does
    [[nodiscard]] std::size_t index_of(const Lobe& lobe) const;
};

/// Of level 0 of `environment`. `size` is that of the mirror's map, as in make_environment_map();
/// the others are as fine as their lobes need and the environment is, see glossy_map_size().
/// The same bits at any number of threads. \throws Error(Errc::usage) for a size out of range
[[nodiscard]] ReflectionMaps make_reflection_maps(const EnvironmentMap& environment,
                                                  std::span<const Lobe> lobes,
                                                  Projection projection, int size, const Axes& axes,
                                                  const Progress& progress = {});

/// The size of a map so fine that bilinear lookup hardly differs from the lobe's own blur: about 16
/// texels of a cube's face centre to a radian over the lobe's width, which is from the angle that
/// holds a quarter of it to the one that holds three. For a single point of light, the worst there
/// is, a lookup in a cube is off by 1.5 % of the highlight's peak at most; in the built-in sunset,
/// its sun included, by 0.5 % of the brightest and 0.16 % in the root mean square, in an octahedral
/// map by 1.2 % and 0.23 %.
[[nodiscard]] int glossy_map_size(const Lobe& lobe, Projection projection);

/// The size of a map of `projection` that is as fine as `environment`: a power of two.
[[nodiscard]] int mirror_map_size(const EnvironmentMap& environment, Projection projection);

/// Of the scene's materials that have a glossy term, each once.
[[nodiscard]] std::vector<Lobe> lobes_of(const Scene& scene);

}  // namespace mirrorball
