// Tone mapping: from radiance without a limit to what a screen can show.
#pragma once

#include <string_view>

#include <mirrorball/environment_map.h>
#include <mirrorball/vector.h>

namespace mirrorball {

/// From x = exposure * radiance, not negative, to linear light y from 0 to 1, which is to be
/// encoded as sRGB to be shown. All but agx work per channel, so that bright colours turn towards
/// white.
enum class ToneMap {
    none,      ///< min(x, 1)
    reinhard,  ///< x / (1 + x). Reinhard et al. 2002, "Photographic Tone Reproduction", Eq. 3; per
               ///< channel where the paper has luminance, which would leave the screen's range
    aces,      ///< u (2.51 u + 0.03) / (u (2.43 u + 0.59) + 0.14), u = 0.6 x. Narkowicz 2015, "ACES
               ///< Filmic Tone Mapping Curve", a fit to the Academy's transform
    agx,       ///< Sobotka 2022, "AgX": colours mixed a little, an S over 16.5 stops, and unmixed:
          ///< a saturated light goes to white by way of paler shades of itself. \see tone_map.cpp
    film,  ///< x^1.25 / (x^1.25 + k): the other tone_mapped() below
};
[[nodiscard]] std::string_view name(ToneMap tone_map);
/// \throws Error(Errc::usage) naming the tone maps there are
[[nodiscard]] ToneMap parse_tone_map(std::string_view name);

/// What is no number is black, what is infinite is as bright as can be. A grey card, 0.18, becomes
/// 0.18, 0.153, 0.140, 0.18 and 0.18, in the order above. shaders/tone_map.glsl has the same for
/// graphics cards.
[[nodiscard]] Vec3f tone_mapped(const Vec3f& radiance, double exposure, ToneMap tone_map);
/// Images of one or two channels are grey; what follows the colour is left as it is.
[[nodiscard]] Image tone_mapped(const Image& image, double exposure, ToneMap tone_map);

/// A film-like curve per channel, an S over the logarithm of the light, with x = exposure *
/// radiance:
///
///     y = x^1.25 / (x^1.25 + k),   k such that x = 0.18, a photographer's grey card, stays 0.18
///
/// y is linear light from 0 to 1 (encode it as sRGB to show it). Bright colours turn towards white
/// as all channels near 1. Negative radiance is black.
[[nodiscard]] float tone_mapped(float radiance, double exposure);
[[nodiscard]] Image tone_mapped(const Image& image, double exposure);
/// Every level, with its projection and frame.
[[nodiscard]] EnvironmentMap tone_mapped(const EnvironmentMap& map, double exposure);

/// The exposure at which what is typical of the environment, between its logarithmic mean (what one
/// sees of it) and its mean (what falls on a surface in it), is a little brighter than a grey card;
/// or its 99th percentile by solid angle near white if that is brighter: a plain chart is not dusk.
[[nodiscard]] double usual_exposure(const EnvironmentMap& map, int level = 0);

}  // namespace mirrorball
