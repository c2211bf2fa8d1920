#include <mirrorball/map_pictures.h>

#include <algorithm>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/resample.h>

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

// The face with 1 in a fourth channel where the projection uses it.
Image with_coverage(const Image& face, Projection projection) {
    Image result(face.width(), face.height(), 4);
    visit(projection, [&](auto map) {
        using Map = decltype(map);
        for (int y = 0; y < face.height(); ++y) {
            for (int x = 0; x < face.width(); ++x) {
                const FacePoint<double> centre{0, (x + 0.5) / face.width(),
                                               (y + 0.5) / face.height()};
                if (!Map::covers(centre)) continue;
                std::copy_n(face.at(x, y), 3, result.at(x, y));
                result.at(x, y)[3] = 1;
            }
        }
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
    const EnvironmentMap laid_out = resample(map, projection, face_width, axes);
    Image picture(arrangement.columns * face_width, arrangement.rows * face_height, 4);
    for (int face = 0; face < face_count(projection); ++face) {
        const Image covered = with_coverage(laid_out.levels[0].faces[face], projection);
        if (arrangement.layout == Layout::single) return covered;
        detail::paste_face(picture, covered, arrangement, face);
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
