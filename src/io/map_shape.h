// Which projection stored pictures have, and how its faces lie in them: the user's word before the
// file's, the file's before what their shape suggests; a shape that contradicts any of them is an
// error. Asks for sizes only, so that it can be decided before a texel is read.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <mirrorball/io.h>

#include "map_metadata.h"

namespace mirrorball::detail {

/// What is there, before anyone decides what it is.
struct StoredPictures {
    std::size_t face_count;
    int width, height;                          ///< of each, at level 0
    std::optional<Projection> projection = {};  ///< where the format itself says
    std::optional<Axes> axes = {};              ///< likewise
    std::optional<Projection> by_names = {};    ///< where the faces were files of their own
};

/// What the pictures are. `layout` is automatic where each face is a picture of its own.
struct Shape {
    Projection projection;
    Layout layout;
};

/// Guesses are noted. \throws Error that says what was found and what was expected
[[nodiscard]] Shape decide_shape(const std::string& source, const StoredPictures& stored,
                                 const MapWords& words, const MapReadOptions& options,
                                 std::vector<std::string>& notes);

[[nodiscard]] Axes decide_axes(Projection projection, const StoredPictures& stored,
                               const MapWords& words, const MapReadOptions& options);

}  // namespace mirrorball::detail
