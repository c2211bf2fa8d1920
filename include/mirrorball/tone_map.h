// Tone mapping: from radiance without a limit to what a screen can show.
#pragma once

#include <mirrorball/environment_map.h>

namespace mirrorball {

/// The curves there are; formulas at tone_mapped().
enum class ToneMap { none, reinhard, aces, agx, film };

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
