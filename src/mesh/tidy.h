// What every mesh goes through before a caller sees it.
#pragma once

#include <mirrorball/mesh.h>

namespace mirrorball::detail {

/// Leaves out triangles without area, then vertices that no triangle uses. The order of what
/// remains stays.
void tidy(Mesh& mesh);

/// Makes normals unit, and makes those that are 0: from the faces around.
void complete_normals(Mesh& mesh);

}  // namespace mirrorball::detail
