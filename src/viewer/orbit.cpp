#include <mirrorball/orbit.h>

#include <algorithm>
#include <cmath>

namespace mirrorball {
namespace {

constexpr double kSteepest = 89 * kPi / 180;
constexpr double kNearest = 1e-4, kFarthest = 1e6;

// A direction by its angles in a frame: yaw about y, pitch above the plane of x and z.
struct Angles {
    double yaw, pitch;
};

Angles angles_of(const Axes& frame, const Vec3d& direction) {
    const Vec3d d = frame.to_map(direction);
    return {std::atan2(d.x, d.z), std::asin(std::clamp(d.y, -1.0, 1.0))};
}

Vec3d direction_of(const Axes& frame, const Angles& angles) {
    return frame.to_world({std::sin(angles.yaw) * std::cos(angles.pitch), std::sin(angles.pitch),
                           std::cos(angles.yaw) * std::cos(angles.pitch)});
}

// With `up` as its y axis.
Axes upright(const Vec3d& up) {
    const Vec3d y = up.length() > 0 ? up.normalized() : Vec3d(0, 1, 0);
    Vec3d x = y.cross({0, 0, 1});
    if (x.length() < 1e-9) x = {1, 0, 0};
    x.normalize();
    return {x, y, x.cross(y)};
}

}  // namespace

Camera orbited(const Camera& camera, double yaw, double pitch) {
    const Vec3d back = camera.eye - camera.target;
    const double distance = back.length();
    const Axes frame = upright(camera.up);
    Angles angles = angles_of(frame, back / distance);
    // Whoever stands straight above stays there until moved.
    const double steepest = std::max(kSteepest, std::abs(angles.pitch));
    angles.yaw += yaw;
    angles.pitch = std::clamp(angles.pitch + pitch, -steepest, steepest);
    Camera moved = camera;
    moved.eye = camera.target + direction_of(frame, angles) * distance;
    return moved;
}

Camera zoomed(const Camera& camera, double factor) {
    const Vec3d back = camera.eye - camera.target;
    const double distance = back.length();
    Camera moved = camera;
    moved.eye =
        camera.target + back * (std::clamp(distance * factor, kNearest, kFarthest) / distance);
    return moved;
}

Camera panned(const Camera& camera, double right, double up) {
    const Axes frame = axes(camera);
    const double height =
        2 * std::tan(camera.field_of_view / 2) * (camera.eye - camera.target).length();
    const Vec3d move = (frame.x * right + frame.y * up) * -height;
    Camera moved = camera;
    moved.eye += move, moved.target += move;
    return moved;
}

}  // namespace mirrorball
