// What the projections share: points, rectangles and tangents on a face.
#pragma once

#include <mirrorball/vector.h>

namespace mirrorball {

/// A point on a projection's picture: which face, and where on it. s runs to the right and t down,
/// both 0..1; (0, 0) is the outer corner of the top left texel, whose centre is at half a texel.
template <class T>
struct FacePoint {
    int face;
    T s, t;
};

/// s0 <= s1, t0 <= t1, in the coordinates of FacePoint.
struct FaceRect {
    double s0, t0, s1, t1;
};

/// How the direction moves with the point: d direction / ds and d direction / dt. Their cross
/// product has the length of the density, dw / (ds dt).
template <class T>
struct Tangents {
    Vec3<T> ds, dt;
};

}  // namespace mirrorball
