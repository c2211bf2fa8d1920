#include "harmonics/texel_grid.h"

#include "harmonics/cube_grid.h"
#include "harmonics/map_grid.h"

namespace mirrorball::detail {

GridTaps::GridTaps(const RingTransform& rings, std::span<const double> power)
    : along_columns(power, kPi / rings.ring_count()),
      along_rings(power, 2 * kPi / rings.column_count()) {}

std::unique_ptr<TexelGrid> make_texel_grid(const MapShape& shape, const RingTransform& rings,
                                           const GridTaps& taps, GridUse use) {
    if (const auto placement = place_cube(shape))
        return std::make_unique<CubeGrid>(shape.size, *placement, rings, taps, use);
    return std::make_unique<MapGrid>(shape, rings, taps);
}

}  // namespace mirrorball::detail
