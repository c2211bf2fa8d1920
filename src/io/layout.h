// How the faces of a map lie in one picture: crosses, strips, side by side.
//
// Each such layout is a table of cells, so that cutting faces out and pasting them in are one loop
// each. Drawings: docs/conventions.md.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <mirrorball/io.h>

namespace mirrorball::detail {

/// The place of one face, in faces from the picture's top left corner.
struct Cell {
    int column, row;
    bool turned = false;  ///< by 180 degrees
};

/// The cells of a layout, in the order of the projection's faces, which are all square.
struct Arrangement {
    Layout layout;
    Projection projection;
    int columns, rows;
    std::span<const Cell> cells;
};

/// \pre layout is one that holds several faces: neither automatic nor single
[[nodiscard]] const Arrangement& arrangement(Layout layout);

/// Whether a picture of this size is made of whole square faces in this layout.
[[nodiscard]] bool fits(const Arrangement& arrangement, std::int64_t width, std::int64_t height);

/// The layout that a picture of several faces has by its shape; none where it fits none.
/// \pre projection has more than one face
[[nodiscard]] std::optional<Layout> layout_by_shape(Projection projection, int width, int height);

/// One face of the picture. \pre fits(arrangement, picture's size)
[[nodiscard]] Image cut_face(const Image& picture, const Arrangement& arrangement, int face);

/// The reverse. \pre the picture has the face's channels and is columns x rows of the face's size
void paste_face(Image& picture, const Image& image, const Arrangement& arrangement, int face);

/// "a horizontal-cross must be 4 faces wide and 3 high", for messages.
[[nodiscard]] std::string shape_in_words(const Arrangement& arrangement);

}  // namespace mirrorball::detail
