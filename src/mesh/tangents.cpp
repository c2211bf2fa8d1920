// Tangent frames of a mesh, as MikkTSpace makes them; the header says where these differ.
//
// On a triangle P is linear in (s, t). With the edges e1, e2 from one corner and their steps
// (s1, t1), (s2, t2) in the texture, Cramer's rule gives where s grows and t stays:
//
//     dP/ds = (t2 e1 - t1 e2) / (s1 t2 - s2 t1)
//
// Its divisor is twice the area in the texture. Triangles are counter-clockwise from outside and t
// points down, so it is negative where the picture is seen as it is: (s, -t) has to turn as the
// triangle does. There cross(normal, dP/ds) points up in the picture, w = +1; and where it is
// positive, the picture is mirrored and w = -1. The plane of make_mesh() as an example: normal +y,
// s along +x, t along +z; cross(y, x) = -z, up.
#include "tangents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include <mirrorball/error.h>

#include "brdf/directions.h"
#include "tidy.h"
#include "weld.h"

namespace mirrorball {
namespace {

enum Side { kAsItIs, kMirrored, kUnknown };
constexpr int kSides = 2;

// Unit, along s.
struct Growth {
    Side side = kUnknown;
    Vec3d direction{0};
};

struct Corner {
    Vec3d position;
    Imath::V2d place;
};

std::array<Corner, 3> corners_of(const Mesh& mesh, std::size_t triangle) {
    std::array<Corner, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t i = mesh.indices[3 * triangle + k];
        corners[k] = {Vec3d(mesh.positions[i]), Imath::V2d(mesh.texture_coordinates[i])};
    }
    return corners;
}

// Twice the area in the texture, or 0 if it is no more than what rounding the coordinates to float,
// each by up to 2^-24 of itself, can make of a line.
double texture_area(const std::array<Corner, 3>& corners) {
    constexpr double kRounding = 1.0 / (1 << 22);
    const Imath::V2d a = corners[1].place - corners[0].place,
                     b = corners[2].place - corners[0].place;
    const double area = a.x * b.y - b.x * a.y;
    double farthest = 0;
    for (const Corner& corner : corners)
        farthest = std::max({farthest, std::abs(corner.place.x), std::abs(corner.place.y)});
    const double longest = std::max({a.length(), b.length(), (b - a).length()});
    return std::abs(area) > kRounding * farthest * longest ? area : 0;
}

Growth growth_of(const std::array<Corner, 3>& corners) {
    const auto& [p, q, r] = corners;
    const double area = texture_area(corners);
    if (area == 0 || !detail::has_area(p.position, q.position, r.position)) return {};
    const Vec3d along = (q.position - p.position) * (r.place.y - p.place.y) -
                        (r.position - p.position) * (q.place.y - p.place.y);
    return area < 0 ? Growth{kAsItIs, -along.normalized()} : Growth{kMirrored, along.normalized()};
}

// A place of a picture that repeats, within its first tile.
double in_tile(double coordinate) {
    return coordinate - std::floor(coordinate);
}

std::vector<std::uint32_t> first_of_equals(const Mesh& mesh) {
    return detail::first_of_equals(mesh.positions.size(), [&](std::uint32_t i) {
        const Vec3f &p = mesh.positions[i], &n = mesh.normals[i];
        const Vec2f& place = mesh.texture_coordinates[i];
        return std::make_tuple(p.x, p.y, p.z, n.x, n.y, n.z, in_tile(place.x), in_tile(place.y));
    });
}

// The means around each vertex, on either side. What is equal is kept at its first vertex.
class Frames {
  public:
    explicit Frames(const Mesh& mesh) : mesh_(mesh), first_(first_of_equals(mesh)) {
        for (Mean& mean : means_) {
            mean.sums.resize(mesh.positions.size(), Vec3d(0));
            mean.is_there.resize(mesh.positions.size());
        }
        for (std::size_t i = 0; i < mesh.triangle_count(); ++i) sides_.push_back(add(i));
    }

    /// Its triangle's, or if that has none, what is around the vertex.
    [[nodiscard]] Side side_of_corner(std::size_t corner) const {
        const Side of_triangle = sides_[corner / 3];
        if (of_triangle != kUnknown) return of_triangle;
        const std::uint32_t i = first_[mesh_.indices[corner]];
        return means_[kMirrored].is_there[i] && !means_[kAsItIs].is_there[i] ? kMirrored : kAsItIs;
    }

    [[nodiscard]] Vec4f tangent(Side side, std::uint32_t vertex) const {
        // Angles are of the order of 1, so what is left of directions that cancel is rounding.
        constexpr double kCancelled = 1e-9;
        const Vec3d sum = means_[side].sums[first_[vertex]], n = normal(vertex);
        const Vec3d direction = sum.length() > kCancelled ? sum : detail::about(n, Vec3d(1, 0, 0));
        return detail::tangent_of(direction.normalized(), side == kMirrored ? -1.0f : 1.0f);
    }

  private:
    struct Mean {
        std::vector<Vec3d> sums;
        std::vector<bool> is_there;
    };

    Side add(std::size_t triangle) {
        const std::array<Corner, 3> corners = corners_of(mesh_, triangle);
        const auto [side, direction] = growth_of(corners);
        if (side == kUnknown) return side;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh_.indices[3 * triangle + k];
            const Vec3d n = normal(vertex), here = corners[k].position;
            const double angle =
                detail::angle_between(detail::in_plane(corners[(k + 1) % 3].position - here, n),
                                      detail::in_plane(corners[(k + 2) % 3].position - here, n));
            means_[side].sums[first_[vertex]] += detail::unit_in_plane(direction, n) * angle;
            means_[side].is_there[first_[vertex]] = true;
        }
        return side;
    }

    [[nodiscard]] Vec3d normal(std::uint32_t vertex) const { return Vec3d(mesh_.normals[vertex]); }

    const Mesh& mesh_;
    std::vector<std::uint32_t> first_;
    std::vector<Side> sides_;  // of triangles
    Mean means_[kSides];
};

// Adds the vertex once more, and returns its number.
std::uint32_t add_copy(Mesh& mesh, std::uint32_t vertex) {
    mesh.positions.push_back(mesh.positions[vertex]);
    mesh.normals.push_back(mesh.normals[vertex]);
    mesh.texture_coordinates.push_back(mesh.texture_coordinates[vertex]);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

}  // namespace

Mesh with_tangents(Mesh mesh) {
    if (mesh.texture_coordinates.size() != mesh.positions.size())
        throw Error(Errc::usage, "tangents need texture coordinates, and the mesh has none");
    if (!mesh.tangents.empty()) return mesh;

    const Frames frames(mesh);
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    std::vector<bool> used[kSides] = {std::vector<bool>(count), std::vector<bool>(count)};
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        used[frames.side_of_corner(i)][mesh.indices[i]] = true;

    std::vector<Vec4f> tangents(count), of_copies;
    std::vector<std::uint32_t> mirrored(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const bool is_split = used[kAsItIs][i] && used[kMirrored][i];
        tangents[i] = frames.tangent(used[kMirrored][i] && !is_split ? kMirrored : kAsItIs, i);
        mirrored[i] = is_split ? add_copy(mesh, i) : i;
        if (is_split) of_copies.push_back(frames.tangent(kMirrored, i));
    }
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        if (frames.side_of_corner(i) == kMirrored) mesh.indices[i] = mirrored[mesh.indices[i]];

    mesh.tangents = std::move(tangents);
    mesh.tangents.insert(mesh.tangents.end(), of_copies.begin(), of_copies.end());
    return mesh;
}

}  // namespace mirrorball
