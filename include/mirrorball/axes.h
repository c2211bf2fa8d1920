// How a map's own coordinate frame lies in the world.
//
// Our world is right-handed: +X right, +Y up, -Z forward. Programs differ in up axis, handedness
// and where a panorama's centre looks; each of these is one orthonormal frame, so one type says
// them all. Drawings: docs/conventions.md.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <mirrorball/vector.h>

namespace mirrorball {

enum class Projection;

/// The map's own x, y and z axes as world directions: orthonormal, of either handedness.
/// Every projection is defined in the map's frame (projection.h); the identity puts it in the
/// world.
struct Axes {
    Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    [[nodiscard]] Vec3d to_map(const Vec3d& world) const {
        return {x.dot(world), y.dot(world), z.dot(world)};
    }
    [[nodiscard]] Vec3d to_world(const Vec3d& map) const {
        return x * map.x + y * map.y + z * map.z;
    }
    [[nodiscard]] bool mirrored() const { return x.cross(y).dot(z) < 0; }

    bool operator==(const Axes&) const = default;
};

/// The frame that a map of this projection has unless its file or user says otherwise: the
/// identity, except for cubes, whose own space is left-handed (docs/conventions.md): +x +y -z.
[[nodiscard]] Axes default_axes(Projection projection);

/// A map seen by another program: "three.js", "blender", "unity", "openexr", ... together with what
/// the projection is, since programs place panoramas and cubes by different rules.
/// \throws Error(Errc::usage) naming the presets there are
[[nodiscard]] Axes axes_preset(std::string_view program, Projection projection);

/// Names and one-line descriptions of the presets, in the order that help text lists them.
struct AxesPreset {
    std::string name, description;
};
[[nodiscard]] std::vector<AxesPreset> axes_presets();

/// Text form, stored in files: "+x+y-z" when the axes lie along the world's, else nine numbers.
[[nodiscard]] std::string to_string(const Axes& axes);
/// Either text form, or the name of a preset. \throws Error(Errc::usage)
[[nodiscard]] Axes parse_axes(std::string_view text, Projection projection);

/// Turns the environment: yaw about +Y (positive turns what is ahead to the left), then pitch about
/// +X (positive raises it), then roll about -Z (positive turns it clockwise), in radians.
/// Returns the frame of the turned map: the content moves, the texels stay.
[[nodiscard]] Axes rotated(const Axes& axes, double yaw, double pitch, double roll);

/// Left and right exchanged, as in a mirror (world x negated).
[[nodiscard]] Axes mirrored(const Axes& axes);

}  // namespace mirrorball
