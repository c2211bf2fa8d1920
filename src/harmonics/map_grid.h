// Between rings of latitude and the texels of any map, eight taps along each.
//
// Where a map has no structure to use (cube_grid.h), each texel reads, or adds to, 8 x 8 values of
// a grid [column][4 rings beyond the north pole, rings, 4 beyond the south pole][RGBx].
#pragma once

#include <array>
#include <vector>

#include "harmonics/texel_grid.h"

namespace mirrorball::detail {

class MapGrid final : public TexelGrid {
  public:
    MapGrid(const MapShape& shape, const RingTransform& rings, const GridTaps& taps);

    [[nodiscard]] Buffer make_buffer() const override;
    void scatter_group(int group, const std::array<GroupValues, 3>& planes,
                       Buffer& buffer) const override;
    void make_texels(Buffer& buffer, const Vec3f& lowest, const Vec3f& highest,
                     std::vector<Image>& faces) const override;
    void spread_texels(const std::vector<Image>& faces, Buffer& buffer) const override;
    void gather_group(int group, const Buffer& buffer,
                      std::array<GroupValues, 3>& planes) const override;

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
