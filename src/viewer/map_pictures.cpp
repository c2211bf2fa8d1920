#include <mirrorball/map_pictures.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/lookup.h>

#include "core/parallel.h"
#include "io/layout.h"

namespace mirrorball {
namespace {

using detail::Arrangement;
using detail::Cell;

// One face fills the picture.
constexpr Cell kOneCell{0, 0};

Arrangement arrangement_of(Projection projection) {
    switch (projection) {
        case Projection::cube:
            return detail::arrangement(Layout::horizontal_cross);
        case Projection::dual_paraboloid:
            return detail::arrangement(Layout::side_by_side);
        default:
            return {Layout::single, projection, 1, 1, {&kOneCell, 1}};
    }
}

// Solid angle of the texels that are looked up over that of the pixel. With 1 pictures are softer
// than they need be.
constexpr double kTexelOverPixel = 0.5;

double mean_solid_angle(const EnvironmentMap& map) {
    const double texels = static_cast<double>(map.width()) * map.height();
    return 4 * kPi / (face_count(map.projection) * texels);
}

// A face with 1 in a fourth channel where the projection uses it, each pixel looked up in the
// levels whose texels are so large next to it.
Image looked_up(const EnvironmentMap& map, Projection projection, const Axes& axes, int face,
                int width, int height) {
    Image result(width, height, 4);
    const double texels_per_area = kTexelOverPixel / (mean_solid_angle(map) * width * height);
    visit(projection, [&](auto target) {
        using Map = decltype(target);
        detail::parallel_for(height, [&](std::int64_t row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < width; ++x) {
                const FacePoint<double> p{face, (x + 0.5) / width, (y + 0.5) / height};
                if (!Map::covers(p)) continue;
                const Vec3f light =
                    look_up_at_lod(map, axes.to_world(Map::direction(p)),
                                   std::log2(Map::density(p) * texels_per_area) / 2);
                std::copy_n(&light.x, 3, result.at(x, y));
                result.at(x, y)[3] = 1;
            }
        });
    });
    return result;
}

}  // namespace

double map_picture_aspect(Projection projection) {
    const Arrangement arrangement = arrangement_of(projection);
    return static_cast<double>(arrangement.columns * aspect(projection)) / arrangement.rows;
}

Image map_picture(const EnvironmentMap& map, Projection projection, const Axes& axes, int height) {
    constexpr int kLeast = 4, kMost = 4096;
    if (height < kLeast || height > kMost) {
        throw Error(Errc::usage, fmt::format("the height of a map's picture is from {} to {}, not "
                                             "{}",
                                             kLeast, kMost, height));
    }
    const Arrangement arrangement = arrangement_of(projection);
    const int face_height = std::max(1, height / arrangement.rows);
    const int face_width = face_height * aspect(projection);
    Image picture(arrangement.columns * face_width, arrangement.rows * face_height, 4);
    for (int face = 0; face < face_count(projection); ++face) {
        const Image laid_out = looked_up(map, projection, axes, face, face_width, face_height);
        if (arrangement.layout == Layout::single) return laid_out;
        detail::paste_face(picture, laid_out, arrangement, face);
    }
    return picture;
}

MapPlace place_on_map(Projection projection, const Axes& axes, const Vec3d& direction) {
    const Arrangement arrangement = arrangement_of(projection);
    return visit(projection, [&](auto map) -> MapPlace {
        const FacePoint<double> p = decltype(map)::project(axes.to_map(direction));
        const Cell& cell = arrangement.cells[static_cast<std::size_t>(p.face)];
        const double s = cell.turned ? 1 - p.s : p.s, t = cell.turned ? 1 - p.t : p.t;
        return {p.face, p.s, p.t, (cell.column + s) / arrangement.columns,
                (cell.row + t) / arrangement.rows};
    });
}

}  // namespace mirrorball
