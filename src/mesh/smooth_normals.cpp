// Normals from the faces around a position: Thürmer and Wüthrich 1998, "Computing Vertex Normals
// from Polygonal Facets". A face counts by its angle at the position, so that the result does not
// depend on how a flat part is cut into triangles.
#include <tuple>

#include <mirrorball/mesh.h>

#include "weld.h"

namespace mirrorball {

std::vector<Vec3f> smooth_normals(const Mesh& mesh) {
    const std::vector<std::uint32_t> first =
        detail::first_of_equals(mesh.positions.size(), [&](std::uint32_t i) {
            const Vec3f& p = mesh.positions[i];
            return std::make_tuple(p.x, p.y, p.z);
        });
    std::vector<Vec3d> sums(mesh.positions.size(), Vec3d(0));
    std::vector<Vec3f> of_a_face(mesh.positions.size(), Vec3f(0, 1, 0));

    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const std::uint32_t* corner = &mesh.indices[i];
        const Vec3d p[3] = {Vec3d(mesh.positions[corner[0]]), Vec3d(mesh.positions[corner[1]]),
                            Vec3d(mesh.positions[corner[2]])};
        const Vec3d face = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
        if (face == Vec3d(0)) continue;
        for (int k = 0; k < 3; ++k) {
            const double angle =
                detail::angle_between(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
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
