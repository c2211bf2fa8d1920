// Pictures whose file lists texels in another order than rows from the top, left to right.
#pragma once

#include <algorithm>
#include <utility>

#include <mirrorball/image.h>

namespace mirrorball::detail {

/// What a stored picture needs to be seen as it is meant, in this order: rows and columns swapped,
/// then left and right, then top and bottom.
struct Orientation {
    bool transposed = false, flipped_x = false, flipped_y = false;

    [[nodiscard]] bool upright() const { return !transposed && !flipped_x && !flipped_y; }
};

/// The eight orientations by the number that TIFF and EXIF give them; others are upright.
[[nodiscard]] inline Orientation tiff_orientation(int number) {
    switch (number) {
        case 2:
            return {false, true, false};
        case 3:
            return {false, true, true};
        case 4:
            return {false, false, true};
        case 5:
            return {true, false, false};
        case 6:
            return {true, true, false};
        case 7:
            return {true, true, true};
        case 8:
            return {true, false, true};
        default:
            return {};
    }
}

[[nodiscard]] inline Image oriented(Image stored, Orientation orientation) {
    if (orientation.upright()) return stored;
    int width = stored.width(), height = stored.height();
    if (orientation.transposed) std::swap(width, height);
    Image seen(width, height, stored.channels());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            int from_x = orientation.flipped_x ? width - 1 - x : x;
            int from_y = orientation.flipped_y ? height - 1 - y : y;
            if (orientation.transposed) std::swap(from_x, from_y);
            const float* from = stored.at(from_x, from_y);
            std::copy(from, from + stored.channels(), seen.at(x, y));
        }
    return seen;
}

}  // namespace mirrorball::detail
