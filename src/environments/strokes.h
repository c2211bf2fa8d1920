// Letters, digits and signs as strokes: a few line segments each, drawn with a round pen.
#pragma once

#include <string_view>

#include "noise.h"

namespace mirrorball::detail {

/// Distance from p to the line segment from a to b.
[[nodiscard]] double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b);

/// Distance from p to the nearest stroke of `text`, which is centred on the origin and 1 high (from
/// the middle of the pen to the middle of the pen), x to the right and y up. Far off, any distance
/// that is not less than that to the text's box. Knows + - X Y Z 0-9, and ' for a degree sign.
[[nodiscard]] double distance_to_text(const Vec2& p, std::string_view text);

/// Width of `text` on the same scale.
[[nodiscard]] double text_width(std::string_view text);

}  // namespace mirrorball::detail
