// LobeTaps: a lobe as a few soft spots, each of which is one lookup in a cube map's mip levels.
//
// A lookup at a level sees a spot about as wide as that level's texels: a Gaussian, near enough, if
// the levels were made with shaders/halve.frag. Spots stand around the lobe's axis, one on it and
// eight on each of some rings, which grow outwards as the spots do. How much each ring counts is
// found by least squares, such that the spots add up to the lobe (docs/rendering-dynamic.md).
#pragma once

#include <vector>

#include <ImathVec.h>

#include <mirrorball/lobe.h>

namespace mirrorball::gl {

/// As shaders/blur.frag has them: x and y of the direction in a frame whose z is the axis (z >= 0
/// follows), log2 of the texel's edge, in radians, at which to look up, weight. The weights add up
/// to the lobe's integral: uniform light stays uniform. Nothing is looked up finer than
/// `source_texel`, the edge of level 0's texels in radians.
[[nodiscard]] std::vector<Imath::V4f> lobe_taps(const Lobe& lobe, double source_texel);

}  // namespace mirrorball::gl
