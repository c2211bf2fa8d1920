#include "view.h"

#include <cmath>

#include <mirrorball/projections/cube.h>

namespace mirrorball::gl {
namespace {

// Nothing nearer than this share of the distance to the target is seen.
constexpr double kNearest = 0.01;

// half_width and half_height at distance 1; the far end is infinitely far away.
View make_view(const Vec3d& eye, const Axes& frame, double half_width, double half_height,
               double nearest, const Imath::V2d& shift) {
    const auto& [x, y, z] = frame;
    const Imath::M44d to_camera(x.x, y.x, z.x, 0, x.y, y.y, z.y, 0, x.z, y.z, z.z, 0,  //
                                -x.dot(eye), -y.dot(eye), -z.dot(eye), 1);
    const Imath::M44d projection(1 / half_width, 0, 0, 0, 0, 1 / half_height, 0, 0,  //
                                 -shift.x, -shift.y, -1, -1, 0, 0, -2 * nearest, 0);
    const Vec3d right = x * half_width, up = y * half_height;
    const Vec3d ahead = -z - right * shift.x - up * shift.y;
    return {eye, frame, to_camera * projection,
            Imath::M33d(right.x, right.y, right.z, up.x, up.y, up.z, ahead.x, ahead.y, ahead.z)};
}

}  // namespace

View view_of(const Camera& camera, double aspect, const Imath::V2d& shift) {
    const double half_height = std::tan(camera.field_of_view / 2);
    return make_view(camera.eye, axes(camera), half_height * aspect, half_height,
                     kNearest * (camera.eye - camera.target).length(), shift);
}

View face_view(const Vec3d& eye, const Axes& axes, int face, double nearest) {
    const auto at = [&](double s, double t) {
        return axes.to_world(Cube::direction(FacePoint<double>{face, s, t}));
    };
    const Vec3d ahead = at(0.5, 0.5);
    const auto across = [&](const Vec3d& d) { return (d - ahead * ahead.dot(d)).normalized(); };
    const Axes frame{across(at(1, 0.5)), across(at(0.5, 1)), -ahead};
    return make_view(eye, frame, 1, 1, nearest, {0, 0});
}

}  // namespace mirrorball::gl
