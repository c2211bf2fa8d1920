// Mip levels of pictures of any size, exactly by area.
#pragma once

#include <vector>

#include <mirrorball/image.h>

namespace mirrorball::detail {

/// `first` and those after it down to 1 x 1; each has half the texels a side, rounded down. A texel
/// is the mean over exactly the area that it covers in the first level, odd sizes included.
[[nodiscard]] std::vector<Image> area_levels(Image first);

}  // namespace mirrorball::detail
