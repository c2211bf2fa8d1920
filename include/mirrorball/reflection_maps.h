// ReflectionMaps: what the materials of a scene look up, made of its environment beforehand.
#pragma once

#include <span>
#include <vector>

#include <mirrorball/environment_map.h>
#include <mirrorball/lobe.h>
#include <mirrorball/prefilter.h>
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
    /// Radiance prefiltered by GGX of any roughness: of alpha 1 at the last level, and of half as
    /// much at each level before, whose texels are half as wide. No level unless asked for.
    EnvironmentMap rough;

    /// Where `lobe` stands in `lobes`. \pre it does
    [[nodiscard]] std::size_t index_of(const Lobe& lobe) const;
};

struct ReflectionMapOptions {
    bool rough = false;  ///< are there to be maps of every roughness?
    Progress progress = {};
};

/// Of level 0 of `environment`. `size` is that of the mirror's map, as in make_environment_map();
/// the others are as fine as their lobes need and the environment is, see glossy_map_size().
/// The same bits at any number of threads. \throws Error(Errc::usage) for a size out of range
[[nodiscard]] ReflectionMaps make_reflection_maps(const EnvironmentMap& environment,
                                                  std::span<const Lobe> lobes,
                                                  Projection projection, int size, const Axes& axes,
                                                  const ReflectionMapOptions& options = {});

/// The same maps one by one, for those who make them when a scene first asks for one: as resample()
/// and PrefilterPlan or LobeFilter make them. Of `rough` one for each level.
[[nodiscard]] EnvironmentMap make_mirror_map(const EnvironmentMap& environment,
                                             Projection projection, int size, const Axes& axes,
                                             const Progress& progress = {});
[[nodiscard]] PrefilterTarget glossy_target(const EnvironmentMap& environment, const Lobe& lobe,
                                            Projection projection, const Axes& axes);
/// For a picture that the next one replaces: half as fine if faces would have more than 128 texels,
/// which takes a quarter of the time. GGX of 0.12 and more in the studio and the sunset is off by
/// 2.6 codes of 8 bits at most in cubes and octahedral maps, by 0.04 in the mean.
[[nodiscard]] PrefilterTarget quicker(const PrefilterTarget& glossy);
[[nodiscard]] PrefilterTarget diffuse_target(Projection projection, const Axes& axes);
[[nodiscard]] std::vector<PrefilterTarget> rough_targets(const EnvironmentMap& environment,
                                                         Projection projection, const Axes& axes);
/// Puts those together. \pre one for each of rough_targets()
[[nodiscard]] EnvironmentMap levels_of(std::span<EnvironmentMap> maps);

/// The size of a map so fine that bilinear lookup hardly differs from the lobe's own blur: about 16
/// texels of a cube's face centre to a radian over the lobe's width, which is from the angle that
/// holds a quarter of it to the one that holds three. For a single point of light, the worst there
/// is, a lookup in a cube is off by 1.5 % of the highlight's peak at most; in the built-in sunset,
/// its sun included, by 0.5 % of the brightest and 0.16 % in the root mean square, in an octahedral
/// map by 1.2 % and 0.23 %.
[[nodiscard]] int glossy_map_size(const Lobe& lobe, Projection projection);

/// The size of a map of `projection` that is as fine as `environment`: a power of two.
[[nodiscard]] int mirror_map_size(const EnvironmentMap& environment, Projection projection);

/// Where GGX of one alpha is found: mixed of `share` of the rough maps at `lod`, which lies between
/// levels if it is no whole number, and the mirror's map.
struct RoughPlace {
    double share = 1, lod = 0;
};
/// Next to a light, what is blurred falls with the lobe's own peak; so shares are linear in
/// 1/alpha, of two levels as of the finest and the mirror, which is half as far off as shares by
/// log(alpha). Continuous; above 1 as at 1. `mirror_alpha` is what mirror_alpha() gives.
/// shaders/light_per_pixel.glsl has the same.
[[nodiscard]] RoughPlace rough_place(double alpha, int level_count, double mirror_alpha);
/// The alpha that the width of texels amounts to, in a mirror's map that is as fine as a cube whose
/// faces have `face_size`.
[[nodiscard]] double mirror_alpha(double face_size);

/// The environment in a direction as GGX of `alpha` blurs it, for alphas that need not be known
/// beforehand. At most off, in root mean square over that of the result: at the levels of `rough`
/// by 0.6 % (at alpha 1 by 1.4 %); between them, of the built-in sunset with its sun, by 7.3 %, of
/// the studio by 4.5 %; between the finest, alpha 1/64 for a panorama of 1024 texels, and the
/// mirror, of the sunset by 41 %, where the sun's disc begins to blur, of the studio by 5 %. \pre
/// the maps have `rough`, and 0 <= alpha
[[nodiscard]] Vec3f look_up_rough(const ReflectionMaps& maps, const Vec3d& direction, double alpha);

/// Of the scene's materials that have a glossy term, each once.
[[nodiscard]] std::vector<Lobe> lobes_of(const Scene& scene);

}  // namespace mirrorball
