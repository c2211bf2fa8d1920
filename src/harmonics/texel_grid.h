// Between a grid of rings and the texels of a map.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include <mirrorball/environment_map.h>

#include "harmonics/ring_transform.h"
#include "harmonics/taps.h"

namespace mirrorball::detail {

/// Interpolation along either direction of a grid, for degrees of power `power` (see TapDesign).
struct GridTaps {
    TapDesign along_columns;  ///< from ring to ring
    TapDesign along_rings;    ///< from column to column

    GridTaps(const RingTransform& rings, std::span<const double> power);
};

/// Synthesis reads texels off the grid; analysis adds each, times its solid angle, to what
/// synthesis would read it from, so that a sum over the grid is the sum over the texels.
class TexelGrid {
  public:
    /// Values on the grid, in an order that suits the texels.
    using Buffer = ScratchArray;

    TexelGrid() = default;
    TexelGrid(const TexelGrid&) = delete;
    TexelGrid& operator=(const TexelGrid&) = delete;
    virtual ~TexelGrid() = default;

    [[nodiscard]] virtual Buffer make_buffer() const = 0;

    // Synthesis: every group of rings, in any order, then the texels.

    virtual void scatter_group(int group, const std::array<GroupValues, 3>& planes,
                               Buffer& buffer) const = 0;
    /// Clamps every channel to [lowest, highest].
    virtual void make_texels(Buffer& buffer, const Vec3f& lowest, const Vec3f& highest,
                             std::vector<Image>& faces) const = 0;

    // Analysis: the texels, then every group.

    virtual void spread_texels(const std::vector<Image>& faces, Buffer& buffer) const = 0;
    virtual void gather_group(int group, const Buffer& buffer,
                              std::array<GroupValues, 3>& planes) const = 0;
};

/// What a grid is for: analysis needs the texels' solid angles besides.
enum class GridUse { analysis, synthesis };

/// Of the kind that suits the shape. The grid's frame is the world.
[[nodiscard]] std::unique_ptr<TexelGrid> make_texel_grid(const MapShape& shape,
                                                         const RingTransform& rings,
                                                         const GridTaps& taps, GridUse use);

}  // namespace mirrorball::detail
