// OpenEXR's environment maps have their samples on the edges of a picture: the first column is s =
// 0 and the last s = 1, so that the border of a cube face is stored on both faces, the poles of an
// equirect are whole rows, and its last column is its first. Ours have texel centres. These
// re-sample one grid to the other, of the same size, with 4 x 4 cubic polynomials that reach over
// edges and poles, and hold the result between the smallest and largest texel that it is made of.
//
// There and back changes a smooth map by little. Of harmonics to band 2 between 0.3 and 4, cube
// faces of 64 texels keep all but a root mean square of 7e-6 (worst 7e-4, at the corners), an
// equirect of 256 x 128 all but 3e-7 (tests/io/edge_grid_test.cpp). What is as sharp as a texel is
// blurred.
#pragma once

#include <vector>

#include <mirrorball/image.h>

namespace mirrorball::detail {

/// Six faces in our order and orientation. \pre square, of one size
[[nodiscard]] std::vector<Image> cube_from_edge_grid(const std::vector<Image>& faces);
[[nodiscard]] std::vector<Image> cube_to_edge_grid(const std::vector<Image>& faces);

/// \pre width = 2 height
[[nodiscard]] Image equirect_from_edge_grid(const Image& image);
[[nodiscard]] Image equirect_to_edge_grid(const Image& image);

}  // namespace mirrorball::detail
