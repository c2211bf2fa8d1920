// What tests of meshes share: areas, volumes, and edges counted by position.
#pragma once

#include <array>
#include <map>
#include <utility>

#include <mirrorball/mesh.h>

namespace mirrorball {

using PositionKey = std::array<float, 3>;

inline PositionKey key_of(const Vec3f& p) {
    // -0 and 0 are one place
    return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
}

/// By its two ends: how often an edge is walked from the first to the second.
using DirectedEdges = std::map<std::pair<PositionKey, PositionKey>, int>;

inline void count_edges(const std::vector<Vec3f>& positions,
                        const std::vector<std::uint32_t>& indices, DirectedEdges& edges) {
    for (std::size_t i = 0; i < indices.size(); i += 3)
        for (int k = 0; k < 3; ++k)
            ++edges[{key_of(positions[indices[i + k]]),
                     key_of(positions[indices[i + (k + 1) % 3]])}];
}

/// Edges that are not walked exactly as often the other way: borders and T-junctions.
inline std::size_t open_edges(const DirectedEdges& edges) {
    std::size_t count = 0;
    for (const auto& [edge, uses] : edges) {
        const auto back = edges.find({edge.second, edge.first});
        if (back == edges.end() || back->second != uses) ++count;
    }
    return count;
}

inline std::size_t open_edges(const Mesh& mesh) {
    DirectedEdges edges;
    count_edges(mesh.positions, mesh.indices, edges);
    return open_edges(edges);
}

/// Half the cross product of two sides: the area along the normal.
inline Vec3d area_vector(const std::vector<Vec3f>& positions, const std::uint32_t* corner) {
    const Vec3d a(positions[corner[0]]), b(positions[corner[1]]), c(positions[corner[2]]);
    return (b - a).cross(c - a) * 0.5;
}

inline double area(const std::vector<Vec3f>& positions, const std::vector<std::uint32_t>& indices) {
    double sum = 0;
    for (std::size_t i = 0; i < indices.size(); i += 3)
        sum += area_vector(positions, &indices[i]).length();
    return sum;
}

inline double area(const Mesh& mesh) {
    return area(mesh.positions, mesh.indices);
}

/// Positive if faces are counter-clockwise from outside: Gauss's theorem.
inline double volume(const Mesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        sum += Vec3d(mesh.positions[mesh.indices[i]])
                   .dot(area_vector(mesh.positions, &mesh.indices[i]));
    return sum / 3;
}

}  // namespace mirrorball
