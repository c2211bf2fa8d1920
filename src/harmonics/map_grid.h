// Between rings of latitude and the texels of any map, eight taps along each.
//
// Where a map has no structure to use (cube_grid.h), each texel reads, or adds to, 8 x 8 values of
// a grid [column][4 rings beyond the north pole, rings, 4 beyond the south pole][RGBx].
#pragma once

#include <array>
#include <vector>

#include <mirrorball/environment_map.h>

#include "harmonics/ring_transform.h"
#include "harmonics/taps.h"

namespace mirrorball::detail {

class MapGrid {
  public:
    /// For level 0 of maps like `shape`; the grid's frame is the world. `power` as in TapDesign.
    MapGrid(const EnvironmentMap& shape, const RingTransform& rings, std::span<const double> power);

    using Buffer = ScratchArray;
    [[nodiscard]] Buffer make_buffer() const;

    // Synthesis: every group of rings, then the texels.
    void scatter_group(int group, const std::array<GroupValues, 3>& planes, Buffer& buffer) const;
    /// Clamps every channel to [lowest, highest].
    void make_texels(Buffer& buffer, const Vec3f& lowest, const Vec3f& highest,
                     std::vector<Image>& faces) const;

    // Analysis: the texels, each times its solid angle, then every group.
    void spread_texels(const std::vector<Image>& faces, Buffer& buffer) const;
    void gather_group(int group, const RingTransform& rings, const Buffer& buffer,
                      std::array<GroupValues, 3>& planes) const;

  private:
    struct Texel {
        int face;
        std::int32_t offset;  // of its values
        float solid_angle;
    };
    std::shared_ptr<ScratchPool> scratch_;
    int ring_count_, column_count_, lane_count_;
    std::size_t stride_;                     // in rings
    std::vector<Texel> texels_;              // used ones, by the first of their columns
    TapList rings_, columns_;                // of each texel
    std::vector<std::size_t> block_begins_;  // texels whose first column is in block i
};

}  // namespace mirrorball::detail
