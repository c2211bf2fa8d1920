// Between rings of latitude and the faces of a cube whose axes lie along the grid's.
//
// Such a cube has four sides and two caps, and looks the same after a quarter turn about the poles.
// So the grid is four quadrants of columns, each about an axis that points to the middle of a side,
// and what holds for a texel in one quadrant holds for the same texel of the other three: one set
// of weights, sixteen values at a time.
//
// Texels lie on lines: the rows of a side, and on a cap the rows across the quadrant's axis, from
// the pole to the edge. A line is part of a great circle and crosses each column of its quadrant
// once, at a *node*.
//
//        side: line v, v down                    cap: line a, from the pole to the edge
//        |   |   |   |   |   columns              \ _|_ /
//        o---o---o---o---o   nodes               o-o-o-o-o
//        |   |   |   |   |                        \  |  /
//        o-x-o-x-x-x-o-x-o   texels x         o-x--o-x-o--x-o
//
// Synthesis reads nodes from rings by eight taps along the column, then texels from nodes by eight
// taps along the line. Analysis adds texels to nodes and nodes to rings by the same weights.
//
//     buffer: [4 rings beyond the north pole, rings, 4 beyond the south pole]
//             [column off the quadrant's axis, from -reach to reach][quadrant][RGBx]
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "harmonics/texel_grid.h"

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

/// Of a cube map whose axes lie along the world's; of none other.
[[nodiscard]] std::optional<CubePlacement> place_cube(const MapShape& shape);

class CubeGrid final : public TexelGrid {
  public:
    CubeGrid(int size, const CubePlacement& placement, const RingTransform& rings,
             const GridTaps& taps, GridUse use);

    [[nodiscard]] Buffer make_buffer() const override;
    void scatter_group(int group, const std::array<GroupValues, 3>& planes,
                       Buffer& buffer) const override;
    void make_texels(Buffer& buffer, const Vec3f& lowest, const Vec3f& highest,
                     std::vector<Image>& faces) const override;
    void spread_texels(const std::vector<Image>& faces, Buffer& buffer) const override;
    void gather_group(int group, const Buffer& buffer,
                      std::array<GroupValues, 3>& planes) const override;

    /// The same line of texels in each of the four quadrants.
    struct Line {
        // Taps of the nodes |c| columns off the axis, on rings.
        const std::int32_t* node_first;
        const float* node_weights;
        bool from_south;  // rings are counted from the south pole

        // Taps of the texels, on nodes.
        int count;
        const std::int32_t* first;
        const float* weights;

        const float* solid_angles;
        struct Place {
            int face;
            std::ptrdiff_t begin, step;
        };
        std::array<Place, 4> places;
    };

  private:
    void place_sides(const GridTaps& taps);
    void place_caps(const GridTaps& taps);
    void weigh_texels();
    [[nodiscard]] Line line(int i) const;
    [[nodiscard]] int line_count() const { return size_ + 2 * half_; }
    [[nodiscard]] double coordinate(int i) const { return (2.0 * i + 1 - size_) / size_; }
    [[nodiscard]] int node_count() const { return 2 * reach_ + 1; }
    [[nodiscard]] std::size_t buffer_row(int ring) const;
    [[nodiscard]] std::size_t first_row(const Line& line) const;
    [[nodiscard]] std::ptrdiff_t row_step(const Line& line) const;
    [[nodiscard]] ScratchArray make_nodes(int line_count) const;
    [[nodiscard]] std::size_t node_row(int line) const {
        return 16 * static_cast<std::size_t>(line) * node_count();
    }
    template <class F>
    void for_each_pair_beyond_poles(const F& f) const;

    std::shared_ptr<ScratchPool> scratch_;
    CubePlacement placement_;
    int size_, half_;  // half_: lines of a cap's quadrant
    int ring_count_, column_count_, lane_count_;
    int reach_;                            // columns to each side of a quadrant's axis
    std::size_t stride_;                   // values from a ring to the next
    TapList side_nodes_, cap_nodes_;       // [line][|column off the axis|]
    TapList side_texels_;                  // [u]: the same on all lines
    TapList cap_texels_;                   // [line][across]
    std::vector<std::size_t> cap_begins_;  // where each line of a cap begins among its texels
    std::vector<float> solid_angles_;      // [rows from the middle out][u]
    float pole_share_ = 0;                 // of a texel at the pole, in each quadrant
};

}  // namespace mirrorball::detail
