// All of a viewer's state as a line of text.
#pragma once

#include <string>
#include <string_view>

#include <mirrorball/viewer.h>

namespace mirrorball {

struct ViewerState {
    Scene scene;
    Comparison comparison;
    std::size_t selected = 0;
};

/// "showing=wipe&other=cube-vertex&wipe=0.5&full_scale=0.2&selected=0&scene={...}"
[[nodiscard]] std::string to_text(const ViewerState& state);
/// What is left out is as in a Viewer that nobody touched. \throws Error(Errc::usage) naming what
/// is not known, and as parse_scene() does
[[nodiscard]] ViewerState parse_viewer_state(std::string_view text);

}  // namespace mirrorball
