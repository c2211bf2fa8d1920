// BumpLookup: a bump map at a moment, as a point of a surface finds it.
#pragma once

#include <memory>

#include <mirrorball/projection.h>
#include <mirrorball/scene.h>
#include <mirrorball/scene_assets.h>

namespace mirrorball::detail {

class BumpLookup {
  public:
    /// \pre the map is not smooth
    BumpLookup(const BumpMap& bump, const SceneAssets& assets, double time);

    /// Places are in tiles, from the top left.
    [[nodiscard]] Imath::V2d place(const Imath::V2d& texture_coordinates) const;
    [[nodiscard]] Imath::V2d texture_coordinates(const Imath::V2d& place) const;

    /// Where the eye, looking along -v, meets the relief whose top it meets at `place`. v is in the
    /// tangent frame.
    [[nodiscard]] Imath::V2d seen_in_relief(const Imath::V2d& place, const Vec3d& v) const;

    /// du and dv, times the map's strength.
    [[nodiscard]] Imath::V2d slopes(const Imath::V2d& place) const;
    /// Of the classic form: how a place on a sphere map moves.
    [[nodiscard]] Imath::V2d shift(const Imath::V2d& slopes) const;
    /// Of the classic form: what light is multiplied by.
    [[nodiscard]] double luminance(const Imath::V2d& place) const;

  private:
    [[nodiscard]] double height(const Imath::V2d& place) const;

    const BumpMap& bump_;
    std::shared_ptr<const BumpTexels> texels_;
    Imath::V2d offset_;
    Imath::M22d matrix_;
};

/// Of the classic form: where a sphere map with these axes is looked up for a direction of the
/// world. Beyond the rim there is the rim.
[[nodiscard]] FacePoint<double> moved_place(const Axes& axes, const Vec3d& direction,
                                            const Imath::V2d& shift);
/// The direction that such a map shows there.
[[nodiscard]] Vec3d moved_direction(const Axes& axes, const Vec3d& direction,
                                    const Imath::V2d& shift);

/// The share of a reflection that a surface's own relief lets pass: 1 above the horizon of the
/// smooth surface, whose normal is `n`, and (1 + n.r)^2 below it.
[[nodiscard]] double above_horizon(const Vec3d& r, const Vec3d& n);

}  // namespace mirrorball::detail
