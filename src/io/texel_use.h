// Which texels of a face count, and for how much, one at a time: for the few texels that are odd,
// where solid_angle_table() would be as large as the map.
#pragma once

#include <algorithm>

#include <mirrorball/projection.h>

namespace mirrorball::detail {

/// Exact steradians of one texel's used part; 0 for an unused texel. The value in
/// solid_angle_table().
inline double texel_solid_angle(Projection projection, int width, int height, int x, int y) {
    // the table is a mirrored quarter, to the last bit
    const int column = std::min(x, width - 1 - x), row = std::min(y, height - 1 - y);
    const FaceRect texel{double(column) / width, double(row) / height, double(column + 1) / width,
                         double(row + 1) / height};
    return visit(projection, [&](auto p) { return decltype(p)::solid_angle(0, texel); });
}

/// Whether faces have unused texels: they have where the projection does not reach their corners.
inline bool has_unused_texels(Projection projection) {
    return visit(projection, [](auto p) { return !decltype(p)::fills_square; });
}

}  // namespace mirrorball::detail
