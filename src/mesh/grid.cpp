#include "grid.h"

namespace mirrorball::detail {
namespace {

bool is_pole(const Mesh& mesh, std::uint32_t row_start, int columns) {
    for (int c = 1; c <= columns; ++c)
        if (mesh.positions[row_start + c] != mesh.positions[row_start]) return false;
    return true;
}

void move_to_middles(Mesh& mesh, std::uint32_t row_start, int columns) {
    for (int c = 0; c < columns; ++c)
        mesh.texture_coordinates[row_start + c].x = static_cast<float>((c + 0.5) / columns);
}

}  // namespace

void add_grid(Mesh& mesh, int columns, int rows, const std::function<GridVertex(int, int)>& at,
              double top, double bottom) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    const std::uint32_t width = columns + 1;
    for (int r = 0; r <= rows; ++r) {
        const double t = top + (bottom - top) * r / rows;
        for (int c = 0; c <= columns; ++c) {
            const GridVertex vertex = at(c, r);
            mesh.positions.emplace_back(vertex.position);
            mesh.normals.emplace_back(vertex.normal);
            mesh.texture_coordinates.emplace_back(static_cast<float>(double(c) / columns),
                                                  static_cast<float>(t));
        }
    }
    const bool pole_above = is_pole(mesh, base, columns);
    const bool pole_below = is_pole(mesh, base + width * rows, columns);
    if (pole_above) move_to_middles(mesh, base, columns);
    if (pole_below) move_to_middles(mesh, base + width * rows, columns);

    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            const std::uint32_t a = base + width * r + c, b = a + 1, p = a + width, q = p + 1;
            if (pole_above && r == 0)
                mesh.indices.insert(mesh.indices.end(), {a, p, q});
            else if (pole_below && r == rows - 1)
                mesh.indices.insert(mesh.indices.end(), {a, p, b});
            else
                mesh.indices.insert(mesh.indices.end(), {a, p, q, a, q, b});
        }
    }
}

}  // namespace mirrorball::detail
