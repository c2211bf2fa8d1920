// OpenEXR's cubes: six faces in one picture, one below the other, +Z and -Z the other way round.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include <mirrorball/image.h>

namespace mirrorball::detail {

/// The strip's six pictures in our order.
inline std::vector<Image> cut_strip(const Image& strip) {
    const int n = strip.width();
    std::vector<Image> faces;
    for (int face = 0; face < 6; ++face) {
        Image& image = faces.emplace_back(n, n, strip.channels());
        for (int y = 0; y < n; ++y)
            std::copy_n(strip.row(face * n + y).data(), image.row(y).size(), image.row(y).data());
    }
    std::swap(faces[4], faces[5]);
    return faces;
}

}  // namespace mirrorball::detail
