// What of a scene depends on its time, at that time.
#include <cmath>

#include <mirrorball/scene.h>

namespace mirrorball {
namespace {

// About +y: what is ahead, at -z, goes to the left, as Transform::yaw turns.
Vec3d turned(const Vec3d& p, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * p.x + s * p.z, p.y, c * p.z - s * p.x};
}

}  // namespace

std::vector<SceneLight> lights_now(const Scene& scene) {
    std::vector<SceneLight> lights = scene.lights;
    for (SceneLight& light : lights) {
        if (auto* point = std::get_if<ScenePointLight>(&light)) {
            point->position = turned(point->position, point->turn * scene.time);
        } else {
            auto& sun = std::get<SceneDirectionalLight>(light);
            sun.direction = turned(sun.direction, sun.turn * scene.time);
        }
    }
    return lights;
}

Imath::V2d offset_at(const BumpMap& bump, double time) {
    const Imath::V2d moved = bump.offset + bump.drift * time;
    // Tiles repeat: what is left keeps its digits however long it moves. Pictures may not.
    if (bump.wrap != Wrap::repeat) return moved;
    return {moved.x - std::floor(moved.x), moved.y - std::floor(moved.y)};
}

Imath::M22d matrix_at(const BumpMap& bump, double time) {
    const double angle = bump.matrix_turn * time;
    const double c = std::cos(angle), s = std::sin(angle);
    const Imath::M22d& m = bump.matrix;
    return {c * m[0][0] - s * m[1][0], c * m[0][1] - s * m[1][1], s * m[0][0] + c * m[1][0],
            s * m[0][1] + c * m[1][1]};
}

}  // namespace mirrorball
