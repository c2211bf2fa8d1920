// Faces and positions as messages name them.
#pragma once

#include <string>
#include <string_view>

#include <mirrorball/projection.h>

namespace mirrorball::detail {

/// "face +X" of a cube, "the front" of a dual paraboloid; empty for projections of one face.
[[nodiscard]] std::string_view face_in_words(Projection projection, int face);

/// "an equirect map", "a cube map".
[[nodiscard]] std::string map_in_words(Projection projection);

/// "texel (3, 4) of face +X, level 2".
[[nodiscard]] std::string texel_in_words(Projection projection, int level, int face, int x, int y);

}  // namespace mirrorball::detail
