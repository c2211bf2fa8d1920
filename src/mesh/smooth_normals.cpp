// Normals from the faces around a position: Thürmer and Wüthrich 1998, "Computing Vertex Normals
// from Polygonal Facets". A face counts by its angle at the position, so that the result does not
// depend on how a flat part is cut into triangles.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include <mirrorball/mesh.h>

namespace mirrorball {
namespace {

// For each vertex the first, in the order of positions, of those that lie where it lies.
std::vector<std::uint32_t> first_of_equals(const std::vector<Vec3f>& positions) {
    const auto key = [&](std::uint32_t i) {
        return std::make_tuple(positions[i].x, positions[i].y, positions[i].z);
    };
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto ka = key(a), kb = key(b);
        return ka != kb ? ka < kb : a < b;
    });
    std::vector<std::uint32_t> first(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool equal = i > 0 && key(order[i]) == key(order[i - 1]);
        first[order[i]] = equal ? first[order[i - 1]] : order[i];
    }
    return first;
}

double angle_between(const Vec3d& a, const Vec3d& b) {
    return std::atan2(a.cross(b).length(), a.dot(b));
}

}  // namespace

std::vector<Vec3f> smooth_normals(const Mesh& mesh) {
    const std::vector<std::uint32_t> first = first_of_equals(mesh.positions);
    std::vector<Vec3d> sums(mesh.positions.size(), Vec3d(0));
    std::vector<Vec3f> of_a_face(mesh.positions.size(), Vec3f(0, 1, 0));

    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const std::uint32_t* corner = &mesh.indices[i];
        const Vec3d p[3] = {Vec3d(mesh.positions[corner[0]]), Vec3d(mesh.positions[corner[1]]),
                            Vec3d(mesh.positions[corner[2]])};
        const Vec3d face = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
        if (face == Vec3d(0)) continue;
        for (int k = 0; k < 3; ++k) {
            const double angle = angle_between(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
            sums[first[corner[k]]] += face * angle;
            of_a_face[corner[k]] = Vec3f(face);
        }
    }

    // Angles are of the order of 1, so what is left of faces that cancel is rounding.
    constexpr double kCancelled = 1e-9;
    std::vector<Vec3f> normals(mesh.positions.size());
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const Vec3d& sum = sums[first[i]];
        normals[i] = sum.length() > kCancelled ? Vec3f(sum.normalized()) : of_a_face[i];
    }
    return normals;
}

}  // namespace mirrorball
