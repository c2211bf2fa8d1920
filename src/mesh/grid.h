// Surfaces with two parameters, as grids of triangles.
#pragma once

#include <functional>

#include <mirrorball/mesh.h>

namespace mirrorball::detail {

struct GridVertex {
    Vec3d position, normal;
};

/// Adds (columns x rows) quads to `mesh`. `at` gives the vertex at column 0 to `columns` from left
/// to right and row 0 to `rows` from top to bottom, as seen from outside. Texture coordinates are 0
/// to 1 across, and `top` to `bottom`. Where a whole row is one point, a pole, each column has its
/// own vertex there with the coordinate of the column's middle, and half a quad is left out.
void add_grid(Mesh& mesh, int columns, int rows, const std::function<GridVertex(int, int)>& at,
              double top = 0, double bottom = 1);

}  // namespace mirrorball::detail
