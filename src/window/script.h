// Scripts: what a hand would do to the window, a step a line.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace mirrorball::window {

struct ResizeStep {
    int width, height;
};
struct DropStep {
    std::string file;
};
struct KeyStep {
    std::string key;  ///< as browsers name it
};
struct DragStep {
    double dx, dy;  ///< pixels, by the left button
    int frames;
};
struct LobeStep {
    std::string kind;  ///< one that has a number
    double from, to;   ///< of the first frame and the last
    int frames;
};
struct WaitStep {
    int frames;
};
using Step = std::variant<ResizeStep, DropStep, KeyStep, DragStep, LobeStep, WaitStep>;

/// Lines of `resize W H`, `drop FILE`, `key KEY`, `drag DX DY [FRAMES]`, `lobe KIND FROM TO FRAMES`
/// and `wait FRAMES`; `#` begins a comment. \throws Error(Errc::usage) "NAME:LINE: ..."
[[nodiscard]] std::vector<Step> parse_script(std::string_view text, std::string_view name);

}  // namespace mirrorball::window
