// Where things are, and where they are seen from.
#include <algorithm>
#include <cmath>

#include <mirrorball/mesh.h>
#include <mirrorball/scene.h>

namespace mirrorball {
namespace {

Axes turn_of(const Transform& transform) {
    return rotated({}, transform.yaw, transform.pitch, transform.roll);
}

}  // namespace

Vec3d Transform::point(const Vec3d& p) const {
    return position + turn_of(*this).to_world(scale * p);
}

// Normals are what stays perpendicular to a surface's tangents, so they take the inverse of the
// scale.
Vec3d Transform::normal(const Vec3d& n) const {
    return turn_of(*this).to_world(n / scale).normalized();
}

Imath::M44d matrix(const Transform& transform) {
    const Axes turn = turn_of(transform);
    const Vec3d x = turn.x * transform.scale.x, y = turn.y * transform.scale.y,
                z = turn.z * transform.scale.z, &p = transform.position;
    return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, p.x, p.y, p.z, 1};
}

Axes axes(const Camera& camera) {
    const Vec3d back = (camera.eye - camera.target).normalized();
    Vec3d right = camera.up.normalized().cross(back);
    // Looking straight along `up` leaves the turn open: what is ahead of one who looks at the
    // horizon, -z, is then at the top or, for one who looks up, at the bottom.
    if (right.length() < 1e-9) right = Vec3d(1, 0, 0) - back * back.x;
    if (right.length() < 1e-9) right = {0, 0, -1};
    right.normalize();
    return {right, back.cross(right), back};
}

Vec3d view_ray(const Camera& camera, double x, double y, double aspect) {
    const Axes frame = axes(camera);
    const double half_height = std::tan(camera.field_of_view / 2);
    return (frame.x * ((2 * x - 1) * half_height * aspect) + frame.y * ((1 - 2 * y) * half_height) -
            frame.z)
        .normalized();
}

Camera framing(const Bounds& bounds, double aspect, double yaw, double pitch,
               double field_of_view) {
    Camera camera;
    camera.field_of_view = field_of_view;
    camera.target = bounds.centre();
    // The ball touches the frame's narrower sides, less a margin.
    const double half_height = std::tan(camera.field_of_view / 2);
    const double half_angle = std::atan(half_height * std::min(1.0, aspect));
    const double radius = bounds.radius > 0 ? bounds.radius : 1;
    const double distance = 1.05 * radius / std::sin(half_angle);
    camera.eye = camera.target + Vec3d(std::sin(yaw) * std::cos(pitch), std::sin(pitch),
                                       std::cos(yaw) * std::cos(pitch)) *
                                     distance;
    return camera;
}

double exposure_of(const Scene& scene, double usual_exposure) {
    if (scene.exposure > 0) return scene.exposure;
    const double intensity = scene.environment.intensity;
    return intensity > 0 ? usual_exposure / intensity : usual_exposure;
}

}  // namespace mirrorball
