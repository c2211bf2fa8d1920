// Between rings of latitude and the faces of a cube.
//
// Where a cube's axes lie along the grid's, its faces are four sides and two caps. On a side each
// column of texels has one longitude: rings are interpolated along psi to those longitudes, and
// then each texel along theta, eight taps twice. The texels of a cap take 8 x 8 taps at once; an
// eighth of a cap has the positions and weights of all of it.
//
// Analysis does the same backwards: it adds where synthesis reads, so that the sum over the grid is
// the sum over the texels. Where it differs is a cap, whose texels at one distance a along the axis
// of a quadrant lie on a line that crosses the grid's columns once each: they are added to points
// where columns cross that line, and those then to rings. Adding, unlike reading, waits for itself,
// and 8 + 8 additions wait less than 64.
//
//     sides: [side][block of columns of texels][ring, those between the caps][column][RGBx]
//     caps:  [north, south][4 rings beyond the pole, rings from the pole on][grid column, and the
//            first eight again][RGBx]
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <mirrorball/environment_map.h>

#include "harmonics/ring_transform.h"
#include "harmonics/taps.h"

namespace mirrorball::detail {

/// Where a face of the grid's cube lies among a map's: texel (u, v) is at
/// origin + u * along_u + v * along_v of the values of `face`.
struct FacePlacement {
    int face;
    std::ptrdiff_t origin, along_u, along_v;
};

/// Sides 0 to 3 face psi = 0, 90, 180 and 270 degrees (+z, +x, -z, -x of the grid's frame), u along
/// psi and v down; then the caps +y and -y, u along +x and v along +z.
using CubePlacement = std::array<FacePlacement, 6>;

/// If the map's axes lie along the grid's (by `to_grid`, from the map's own frame), where its faces
/// are. \pre map.projection == cube
[[nodiscard]] bool place_cube(int size, const Axes& map_in_grid, CubePlacement& placement);

/// What every channel of a texel is clamped to.
struct Range {
    alignas(16) float lowest[4];
    alignas(16) float highest[4];
};

/// Columns of texels of a side that lie together: a block's rings are on few pages, and stay in the
/// cache while its texels are made.
inline constexpr int kBlock = 32;
/// Values from a ring of a block to the next: an odd number of cache lines, so that the eight rings
/// of a texel do not fall on the same ones.
inline constexpr std::ptrdiff_t kSideStride = 4 * kBlock + 16;

/// A block of texels of one side, columns [u0, u1) and rows [v0, v1).
struct Block {
    int u0, u1, v0, v1;
};

/// Where the taps of texel (u, v) of a side's left half are: those of a block together.
[[nodiscard]] inline std::size_t side_tap(int u, int v, int size) {
    return (static_cast<std::size_t>(u / kBlock) * size + v) * kBlock + u % kBlock;
}

/// What a quadrant of a cap reads and writes.
struct Quadrant {
    int size, half, column_count, axis_column;
    const TapList* rings;
    const TapList* columns;
    const TapList* line_rings;
    int reach;           // columns to each side of the axis
    std::size_t stride;  // values from a ring to the next
};

/// Positions and weights, for a grid and a size of face. The same for synthesis and analysis.
class CubeGrid {
  public:
    /// `power` is that of the degrees to be interpolated, see TapDesign.
    CubeGrid(int size, const RingTransform& rings, std::span<const double> power);

    struct Buffers {
        ScratchArray sides, caps;
    };
    [[nodiscard]] Buffers make_buffers() const;

    // Synthesis: every group of rings, in any order, then the texels.

    void scatter_group(int group, const std::array<GroupValues, 3>& planes, Buffers& buffers) const;
    /// Clamps every channel to [lowest, highest].
    void make_texels(Buffers& buffers, const CubePlacement& placement, const Vec3f& lowest,
                     const Vec3f& highest, std::vector<Image>& faces) const;

    // Analysis: the texels, each times its solid angle, then every group.

    void spread_texels(const std::vector<Image>& faces, const CubePlacement& placement,
                       Buffers& buffers) const;
    void gather_group(int group, const Buffers& buffers, std::array<GroupValues, 3>& planes) const;

  private:
    struct QuadrantPlacement {
        int face;
        std::ptrdiff_t middle, along, across;
    };
    [[nodiscard]] QuadrantPlacement place_quadrant(int cap, int quadrant,
                                                   const CubePlacement& placement) const;
    // Where column u of texels of a side is on the first ring.
    [[nodiscard]] std::size_t side_offset(int side, int u) const;
    [[nodiscard]] int first_group() const { return first_side_ring_ / lane_count_; }
    [[nodiscard]] double coordinate(int i) const { return (2.0 * i + 1 - size_) / size_; }

    std::shared_ptr<ScratchPool> scratch_;
    int size_, half_;  // half_: texels from the middle of a face out
    int ring_count_, column_count_, lane_count_, group_count_;
    int first_side_ring_, cap_group_count_;
    int side_ring_count_, cap_ring_count_;
    std::size_t cap_stride_;                 // values from a ring to the next
    std::vector<std::size_t> side_offsets_;  // [side][u]
    TapList side_columns_;                   // [u], grid columns from the side's middle
    TapList side_rings_;                     // at side_tap(u, v), from the first side ring
    TapList cap_rings_;                      // [a][b], 0 <= b <= a, from the first ring
    TapList cap_columns_;                    // the same, columns off the quadrant's axis
    int reach_;                              // columns to each side of a quadrant's axis
    TapList line_rings_;                     // [a][column off the axis], where it crosses line a
    std::vector<float> solid_angles_;        // [|v|][|u|], from the middle out
};

}  // namespace mirrorball::detail
