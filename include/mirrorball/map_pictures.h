// Maps as flat pictures to look at: every parameterisation laid out as one, and where on it a
// direction is.
#pragma once

#include <mirrorball/environment_map.h>
#include <mirrorball/image.h>

namespace mirrorball {

/// Width over height of the picture: a cube is unfolded as a cross of 4 x 3 faces, two paraboloids
/// lie side by side.
[[nodiscard]] double map_picture_aspect(Projection projection);

/// The map made again in `projection` and `axes` and laid out in a picture about `height` pixels
/// high. Four channels: radiance, and 1 where the map is, 0 beside its faces and beyond its rims.
/// A pixel is looked up in the levels of the map whose texels have half its solid angle: without
/// mip levels, what lies between pixels is passed over, and some of it where pixels are long
/// strips. Quick enough for a picture that moves, at 100 to 200 ns a pixel and thread. \throws
/// Error(Errc::usage) unless 4 <= height <= 4096
[[nodiscard]] Image map_picture(const EnvironmentMap& map, Projection projection, const Axes& axes,
                                int height);

/// Where a map looks up a direction.
struct MapPlace {
    int face;
    double s, t;  ///< on the face; (0, 0) is top left
    double x, y;  ///< on the picture, 0 to 1; (0, 0) is top left
};
/// Of a direction in the world, of any length but 0.
[[nodiscard]] MapPlace place_on_map(Projection projection, const Axes& axes,
                                    const Vec3d& direction);

}  // namespace mirrorball
