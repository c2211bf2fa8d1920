#include "scene/bump_lookup.h"

#include <algorithm>

#include "scene/picture_lookup.h"

namespace mirrorball::detail {

BumpLookup::BumpLookup(const BumpMap& bump, const SceneAssets& assets, double time)
    : bump_(bump),
      texels_(bump_texels(bump, assets, time)),
      offset_(offset_at(bump, time)),
      matrix_(matrix_at(bump, time)) {}

Imath::V2d BumpLookup::place(const Imath::V2d& texture_coordinates) const {
    return texture_coordinates * bump_.repeat + offset_;
}

Imath::V2d BumpLookup::texture_coordinates(const Imath::V2d& place) const {
    return (place - offset_) / bump_.repeat;
}

Imath::V2d BumpLookup::seen_in_relief(const Imath::V2d& place, const Vec3d& v) const {
    if (bump_.relief == 0) return place;
    // As shaders/bump.glsl has it, in finer steps.
    constexpr int kSteps = 512, kHalvings = 20;
    constexpr double kMostGrazing = 0.1;  // beyond it the relief is seen as if from there
    const double depth = bump_.relief / std::max(v.z, kMostGrazing);
    const Imath::V2d way(-v.x * depth, v.y * depth);
    const auto is_inside = [&](double d) { return 1 - height(place + way * d) <= d; };
    if (is_inside(0)) return place;
    double above = 0, inside = 1;
    for (int i = 1; i <= kSteps; ++i) {
        const double d = static_cast<double>(i) / kSteps;
        if (is_inside(d)) {
            inside = d;
            break;
        }
        above = d;
    }
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = (above + inside) / 2;
        (is_inside(middle) ? inside : above) = middle;
    }
    return place + way * inside;
}

Imath::V2d BumpLookup::slopes(const Imath::V2d& place) const {
    const Vec3d found = look_up_picture(texels_->slopes.slopes, place, bump_.wrap);
    return Imath::V2d(found.x, found.y) * bump_.strength;
}

Imath::V2d BumpLookup::shift(const Imath::V2d& slopes) const {
    const double dh_ds = slopes.x, dh_dt = -slopes.y;
    return {matrix_[0][0] * dh_ds + matrix_[0][1] * dh_dt,
            matrix_[1][0] * dh_ds + matrix_[1][1] * dh_dt};
}

double BumpLookup::luminance(const Imath::V2d& place) const {
    return std::clamp(bump_.luminance_scale * height(place) + bump_.luminance_offset, 0.0, 1.0);
}

double BumpLookup::height(const Imath::V2d& place) const {
    return look_up_picture(texels_->heights, place, bump_.wrap).x;
}

FacePoint<double> moved_place(const Axes& axes, const Vec3d& direction, const Imath::V2d& shift) {
    FacePoint<double> place = SphereMap::project(axes.to_map(direction));
    place.s += shift.x, place.t += shift.y;
    const Imath::V2d from_centre(place.s - 0.5, place.t - 0.5);
    const double beyond = 2 * from_centre.length();
    if (beyond > 1) {
        place.s = 0.5 + from_centre.x / beyond;
        place.t = 0.5 + from_centre.y / beyond;
    }
    return place;
}

Vec3d moved_direction(const Axes& axes, const Vec3d& direction, const Imath::V2d& shift) {
    return axes.to_world(SphereMap::direction(moved_place(axes, direction, shift)));
}

double above_horizon(const Vec3d& r, const Vec3d& n) {
    const double share = std::clamp(1 + n.dot(r), 0.0, 1.0);
    return share * share;
}

}  // namespace mirrorball::detail
