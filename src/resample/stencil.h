// What a texel of the result takes from the source: a box of it, kept small in a plan; and the box
// as a stencil, the source's texels with their weights.
#pragma once

#include <array>
#include <cstdint>

namespace mirrorball::detail {

enum class BoxKind : std::uint8_t {
    none,    ///< nothing: an unused texel, or one that is cut into cells
    smooth,  ///< monotone bicubic interpolation at the centre
    small,   ///< the mean over a box that sees at most 4 x 4 texels
    large,   ///< the mean over a larger one
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

/// A box's texels, by columns and rows from `column`, `row` on. Of a mean: weights, zero beyond its
/// own. Of a smooth one: 4 x 4 texels, the four weights of monotone_cubic() along either axis.
struct Stencil {
    static constexpr int kMost = 12;
    BoxKind kind;
    bool across_edges;                     ///< has texels beyond its face's edges or used part
    std::int16_t column_count, row_count;  ///< columns by fours
    int face;
    /// Where it begins on its face, and where on the face mirrored.
    int column[2], row[2];
    float columns[kMost], rows[kMost];
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
