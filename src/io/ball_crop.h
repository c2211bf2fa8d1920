// Cutting the picture of a ball out of a photograph.
#pragma once

#include <string>

#include <mirrorball/io.h>

namespace mirrorball::detail {

/// Texels along an edge of the square that is cut: the circle's diameter, rounded, at least 1.
[[nodiscard]] int crop_size(const CropCircle& circle);

/// Checks that the circle is one, and lies in the picture but for at most a pixel, by which a
/// circle fitted by hand may miss. `picture_name` is for the message. \throws Error(Errc::usage)
void check_crop(const std::string& picture_name, int width, int height, const CropCircle& circle);

/// The square around the circle, crop_size() texels wide, interpolated bilinearly: the circle need
/// not lie on whole pixels. Where it does, the pixels are copied. Beyond the picture its border
/// goes on. \pre check_crop() passed
[[nodiscard]] Image crop_to_circle(const Image& picture, const CropCircle& circle);

}  // namespace mirrorball::detail
