#include "layout.h"

#include <algorithm>
#include <cassert>

#include <fmt/format.h>

namespace mirrorball::detail {
namespace {

// Cube faces in the order +X -X +Y -Y +Z -Z.
constexpr Cell kHorizontalCross[] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};
constexpr Cell kVerticalCross[] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {1, 3, true}};
constexpr Cell kHorizontalStrip[] = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}};
constexpr Cell kVerticalStrip[] = {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}};

// Paraboloids: front, back.
constexpr Cell kSideBySide[] = {{0, 0}, {1, 0}};
constexpr Cell kSideBySideTurned[] = {{0, 0}, {1, 0, true}};

constexpr Arrangement kArrangements[] = {
    {Layout::horizontal_cross, Projection::cube, 4, 3, kHorizontalCross},
    {Layout::vertical_cross, Projection::cube, 3, 4, kVerticalCross},
    {Layout::horizontal_strip, Projection::cube, 6, 1, kHorizontalStrip},
    {Layout::vertical_strip, Projection::cube, 1, 6, kVerticalStrip},
    {Layout::side_by_side, Projection::dual_paraboloid, 2, 1, kSideBySide},
    {Layout::side_by_side_turned, Projection::dual_paraboloid, 2, 1, kSideBySideTurned},
};

// Copies a row of texels, back to front where the face is turned.
void copy_texels(const float* from, float* to, int count, int channels, bool turned) {
    if (!turned) {
        std::copy_n(from, std::size_t(count) * channels, to);
        return;
    }
    for (int x = 0; x < count; ++x) {
        std::copy_n(from + std::size_t(count - 1 - x) * channels, channels,
                    to + std::size_t(x) * channels);
    }
}

}  // namespace

const Arrangement& arrangement(Layout layout) {
    const auto* found = std::find_if(std::begin(kArrangements), std::end(kArrangements),
                                     [&](const Arrangement& a) { return a.layout == layout; });
    assert(found != std::end(kArrangements));
    return *found;
}

bool fits(const Arrangement& a, std::int64_t width, std::int64_t height) {
    return width % a.columns == 0 && height % a.rows == 0 && width / a.columns == height / a.rows;
}

std::optional<Layout> layout_by_shape(Projection projection, int width, int height) {
    for (const Arrangement& a : kArrangements) {
        if (a.projection == projection && fits(a, width, height)) return a.layout;
    }
    return std::nullopt;
}

Image cut_face(const Image& picture, const Arrangement& a, int face) {
    const Cell& cell = a.cells[face];
    const int size = picture.height() / a.rows;
    Image image(size, size, picture.channels());
    for (int y = 0; y < size; ++y) {
        const int row = cell.turned ? size - 1 - y : y;
        copy_texels(picture.at(cell.column * size, cell.row * size + row), image.at(0, y), size,
                    image.channels(), cell.turned);
    }
    return image;
}

void paste_face(Image& picture, const Image& image, const Arrangement& a, int face) {
    const Cell& cell = a.cells[face];
    const int size = image.height();
    for (int y = 0; y < size; ++y) {
        const int row = cell.turned ? size - 1 - y : y;
        copy_texels(image.at(0, y), picture.at(cell.column * size, cell.row * size + row), size,
                    image.channels(), cell.turned);
    }
}

std::string shape_in_words(const Arrangement& a) {
    return fmt::format("a {} must be {} square faces wide and {} high", name(a.layout), a.columns,
                       a.rows);
}

}  // namespace mirrorball::detail
