// View: a camera as matrices.
#pragma once

#include <ImathMatrix.h>

#include <mirrorball/axes.h>
#include <mirrorball/scene.h>

namespace mirrorball::gl {

/// Imath's matrices, for row vectors: their numbers are OpenGL's in its order.
struct View {
    Vec3d eye{0};
    Axes frame;           ///< x right, y up, z back
    Imath::M44d to_clip;  ///< from the world; nothing is too far away
    Imath::M33d ray;      ///< (x, y, 1) * ray: through a place of the picture, -1 to 1, y up
};

/// `shift` moves the picture, in its own units of -1 to 1: for samples between pixel centres.
[[nodiscard]] View view_of(const Camera& camera, double aspect, const Imath::V2d& shift = {0, 0});

/// What a face of a cube map sees from `eye`, such that the picture's first row, the lowest that
/// OpenGL draws, is the face's first, the upper. `axes` are the map's.
[[nodiscard]] View face_view(const Vec3d& eye, const Axes& axes, int face, double nearest);

}  // namespace mirrorball::gl
