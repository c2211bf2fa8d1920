// Meshes: triangles with normals, built in or read from OBJ and glTF files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <mirrorball/axes.h>
#include <mirrorball/vector.h>

namespace mirrorball {

using Vec4f = Imath::V4f;

/// Triangles, counter-clockwise seen from outside. Vertices of one index are one vertex: where a
/// surface has an edge, its two sides have vertices of their own.
struct Mesh {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;              ///< unit, one per position
    std::vector<Vec2f> texture_coordinates;  ///< one per position, or none; (0, 0) is top left
    std::vector<Vec4f> tangents;             ///< one per position, or none: with_tangents()
    std::vector<std::uint32_t> indices;      ///< three per triangle

    [[nodiscard]] std::size_t triangle_count() const { return indices.size() / 3; }
};

/// The smallest box with sides along the axes, and the smallest ball about its centre. \pre the
/// mesh has a vertex
struct Bounds {
    Vec3d least, most;
    double radius = 0;  ///< of the ball

    [[nodiscard]] Vec3d centre() const { return (least + most) * 0.5; }
};
[[nodiscard]] Bounds bounds(const Mesh& mesh);

/// Meshes that need no file, around the origin, with texture coordinates:
///
///     sphere   radius 1; poles on y
///     torus    about y; radius 1 to the middle of a tube of radius 0.4
///     plane    -1 to 1 in x and z, facing +y
///     cube     -1 to 1; flat faces
///     teapot   Newell's, spout towards +x, 2 wide; from his control points, smooth normals
struct BuiltinMesh {
    std::string name, description;
};
[[nodiscard]] std::vector<BuiltinMesh> builtin_meshes();

/// `detail` is the number of segments per quarter turn of a sphere and of the torus's tube, per
/// edge of plane and cube, and per edge of a patch of the teapot; 0 takes what looks smooth.
/// \throws Error(Errc::usage) naming the meshes there are, or unless 0 <= detail <= 512
[[nodiscard]] Mesh make_mesh(std::string_view name, int detail = 0);

struct MeshReadOptions {
    std::uint64_t memory_limit = std::numeric_limits<std::uint64_t>::max();  ///< bytes, roughly
};

/// OBJ (.obj), glTF 2.0 (.gltf, .glb): all triangles of the file's default scene, transformed, as
/// one mesh. Polygons are cut into triangles; triangles without area, lines and points are left
/// out. Normals that are missing or 0 are made: the mean of those of the faces around a position,
/// weighted by their angles there. Tangents are glTF's TANGENT if every vertex has one and a normal
/// of the file, made unit and perpendicular to it; w changes its sign in a mirrored node.
/// Materials, skins, morph targets and animations are passed over. \throws Error(Errc::cannot_read)
/// naming the file, what was found and what was expected
[[nodiscard]] Mesh read_mesh(const std::filesystem::path& path,
                             const MeshReadOptions& options = {});

/// The normals that read_mesh() makes. Positions that are equal share one, whatever their indices;
/// where faces cancel out, as the two sides of a sheet do, each has that of a face of its own.
[[nodiscard]] std::vector<Vec3f> smooth_normals(const Mesh& mesh);

/// Adds the frames in which a picture's relief is told (bump.h): of each vertex
///
///     x = tangent.xyz                       unit, in the surface, where s grows
///     y = tangent.w * cross(normal, x)      up in the picture, where t falls
///     z = normal
///
/// w is +1, or -1 where the surface shows the picture mirrored. It is what glTF stores as TANGENT.
/// As MikkTSpace does (Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited", and the code
/// that has become the standard of it): each triangle has a direction along s; a vertex takes the
/// mean of those around it, each laid into the vertex's plane and made unit, weighted by the
/// triangle's angle there as seen along the normal. Vertices are one if position, normal and
/// texture coordinates are equal, whatever their indices; where mirrored triangles meet others, a
/// vertex becomes two, the mirrored one at the end. Different from MikkTSpace:
///
/// - Texture coordinates that differ by whole numbers are equal too, so that a tile's seams do not
///   show. MikkTSpace takes the mean on each side of them alone.
/// - Triangles of one handedness that touch in a vertex only, at an equal place of the texture, are
///   one; MikkTSpace takes those that are connected by edges.
/// - Triangles without area, or whose texture has none but by its coordinates' rounding, add
/// nothing.
///   A vertex that nothing is added to gets some direction in its plane.
/// - Polygons are triangles here; MikkTSpace knows quads.
///
/// A mesh that has tangents already stays as it is. Some 25 ms for 70000 triangles.
/// \pre normals are unit; all numbers are finite
/// \throws Error(Errc::usage) if the mesh has no texture coordinates
[[nodiscard]] Mesh with_tangents(Mesh mesh);

/// A mesh whose triangles each reflect into one face of a cube: section 2 of the survey.
///
/// The reflection vector r is found at the vertices and is linear in between, so the places of a
/// triangle that reflect into one face are a convex polygon, cut out here. On it a plain 2-D
/// texture of that face, looked up projectively, shows the very thing that the cube map indexed by
/// the interpolated r would.
struct SplitMesh {
    std::vector<Vec3f> positions;  ///< of the world
    std::vector<Vec3f> normals;
    /// (s q, t q, q) with q > 0: what a projective lookup divides. (0, 0) is the face's top left.
    std::vector<Vec3f> texture_coordinates;
    /// Triangles by face, in the order +X -X +Y -Y +Z -Z of the cube's own frame.
    std::vector<std::uint32_t> indices[6];
};

/// Cuts a mesh whose positions and normals are the world's, as an eye sees it. The cube's frame in
/// the world is `cube_axes`. Where a surface is smooth it stays without gaps: two triangles that
/// share an edge, positions and normals, are cut at the same points of it, to the bit, whatever
/// their indices. Normals of new vertices are interpolated and not made unit again. Some 2 ms for
/// 20000 triangles.
/// \pre normals are unit
[[nodiscard]] SplitMesh split_by_cube_face(const Mesh& world_mesh, const Vec3d& eye,
                                           const Axes& cube_axes);

}  // namespace mirrorball
