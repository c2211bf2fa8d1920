// What a texel of the result takes from the source: a box of it, kept small in a plan; and the box
// as a stencil, the source's texels with their weights.
#pragma once

#include <array>
#include <cstdint>

namespace mirrorball::detail {

enum class BoxKind : std::uint8_t {
    none,    ///< nothing: an unused texel, or one that is cut into cells
    smooth,  ///< monotone bicubic interpolation at the centre
    mean,    ///< the mean over the box
};

/// Where a box lies on a face, its centre in 2^-32 of the face, its size in 1/8192 texel.
struct Box {
    std::uint32_t s = 0, t = 0;
    std::uint16_t width = 0, height = 0;
    std::uint8_t face = 0;
    BoxKind kind = BoxKind::none;
    bool at_rim = false;  ///< may see unused texels
};
static_assert(sizeof(Box) == 16);

/// Edge of the largest box, in texels.
inline constexpr double kLargestBox = 7.99;
inline constexpr double kBoxUnit = 1.0 / 8192;

inline constexpr int kBlock = 128;  ///< texels that are worked on together
/// Room for the stencils of that many boxes of usual size, or for one more of the largest, which
/// sees ten texels along either axis.
inline constexpr int kMostStencils = kBlock + 8;

/// A block of stencils: 4 x 4 texels from `column`, `row` on, and their weights, which are a box or
/// a part of a larger one. Of a mean: the weights of columns and rows. Of a smooth one: the four
/// weights of monotone_cubic() along either axis. Of none: nothing.
struct Stencils {
    static constexpr int kPadded = kMostStencils + 16;  ///< arrays are read by registers

    int count = 0;
    int face = -1;  ///< of all of them; those of kind none have no face
    BoxKind kind[kMostStencils];
    /// Whether it has texels beyond its face's edges or used part.
    std::int32_t across_edges[kPadded] = {};
    std::int32_t column[kPadded] = {}, row[kPadded] = {};
    float columns[kPadded][4], rows[kPadded][4];

    void clear() { count = 0, face = -1; }
};

/// A symmetry of the sphere that carries texels of a projection's face to texels: mirrored along s
/// or t, to another face, and by quarters of the face's width along s (equirects only).
struct Move {
    int face = 0;
    bool flip_s = false, flip_t = false;
    int quarters = 0;
};
/// Where what begins at `first` and is `count` of `size` long begins if the whole is mirrored.
inline int mirrored(bool mirror, int first, int count, int size) {
    return mirror ? size - first - count : first;
}

inline constexpr int kMostFaces = 6;
using Moves = std::array<Move, kMostFaces>;  ///< of each face

}  // namespace mirrorball::detail
