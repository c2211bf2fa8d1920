// What every mesh goes through before a caller sees it.
#pragma once

#include <mirrorball/mesh.h>

namespace mirrorball::detail {

[[nodiscard]] bool has_area(const Vec3d& a, const Vec3d& b, const Vec3d& c);

/// Leaves out triangles without area, then vertices that no triangle uses. The order of what
/// remains stays.
void tidy(Mesh& mesh);

/// Makes normals unit, and makes those that are 0: from the faces around.
void complete_normals(Mesh& mesh);

/// Makes tangents unit and perpendicular to the normals. Leaves none if a vertex has 0 or one along
/// its normal, or if there are no texture coordinates, which they are of.
void complete_tangents(Mesh& mesh);

}  // namespace mirrorball::detail
