#include "tidy.h"

#include <algorithm>
#include <limits>

#include "tangents.h"

namespace mirrorball::detail {
namespace {

// Twice the area against the square of the longest edge. Where positions are rounded to float, a
// ratio below this is three points on a line.
constexpr double kLeastRatio = 1e-12;

void drop_triangles_without_area(Mesh& mesh) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
        if (!has_area(Vec3d(mesh.positions[a]), Vec3d(mesh.positions[b]), Vec3d(mesh.positions[c])))
            continue;
        mesh.indices[kept++] = a;
        mesh.indices[kept++] = b;
        mesh.indices[kept++] = c;
    }
    mesh.indices.resize(kept);
}

void drop_unused_vertices(Mesh& mesh) {
    constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> moved_to(mesh.positions.size(), kUnused);
    for (const std::uint32_t index : mesh.indices) moved_to[index] = 0;

    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < moved_to.size(); ++i) {
        if (moved_to[i] == kUnused) continue;
        mesh.positions[kept] = mesh.positions[i];
        mesh.normals[kept] = mesh.normals[i];
        if (!mesh.texture_coordinates.empty())
            mesh.texture_coordinates[kept] = mesh.texture_coordinates[i];
        if (!mesh.tangents.empty()) mesh.tangents[kept] = mesh.tangents[i];
        moved_to[i] = kept++;
    }
    mesh.positions.resize(kept);
    mesh.normals.resize(kept);
    if (!mesh.texture_coordinates.empty()) mesh.texture_coordinates.resize(kept);
    if (!mesh.tangents.empty()) mesh.tangents.resize(kept);
    for (std::uint32_t& index : mesh.indices) index = moved_to[index];
}

}  // namespace

bool has_area(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d ab = b - a, ac = c - a, bc = c - b;
    const double longest2 = std::max({ab.length2(), ac.length2(), bc.length2()});
    return ab.cross(ac).length() > kLeastRatio * longest2;
}

void tidy(Mesh& mesh) {
    drop_triangles_without_area(mesh);
    drop_unused_vertices(mesh);
}

void complete_normals(Mesh& mesh) {
    std::vector<Vec3f> made;
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        Vec3f& normal = mesh.normals[i];
        if (normal == Vec3f(0)) {
            if (made.empty()) made = smooth_normals(mesh);
            normal = made[i];
        } else {
            normal = Vec3f(Vec3d(normal).normalized());
        }
    }
}

void complete_tangents(Mesh& mesh) {
    if (mesh.texture_coordinates.empty()) mesh.tangents.clear();
    for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
        Vec4f& tangent = mesh.tangents[i];
        const Vec3d along(tangent.x, tangent.y, tangent.z);
        const Vec3d in_surface = unit_in_plane(along, Vec3d(mesh.normals[i]));
        if (in_surface == Vec3d(0)) {
            mesh.tangents.clear();
            return;
        }
        tangent = tangent_of(in_surface, tangent.w);
    }
}

}  // namespace mirrorball::detail
