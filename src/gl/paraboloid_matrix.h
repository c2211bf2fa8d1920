// The survey's equations 4 to 7 as one matrix.
#pragma once

#include <ImathMatrix.h>

#include <mirrorball/axes.h>

namespace mirrorball::gl {

/// From a reflection vector (r, 1) of the world to (s q, t q, -, q) of a paraboloid map, to be
/// divided by q: T P S M^-1, with T of Eq. 7, P of Eq. 6, S of Eq. 5 and M the map's frame. Linear,
/// so it may be interpolated over a polygon and divided at each pixel.
///
/// Eq. 5's d_o is (0, 0, -1) for the front map and (0, 0, 1) for the back one. What comes out for
/// the back is turned by 180 degrees; T turns it again, as our maps are stored, and t grows down.
/// For row vectors: (r, 1) * m.
[[nodiscard]] Imath::M44d paraboloid_matrix(const Axes& map, bool front);

}  // namespace mirrorball::gl
