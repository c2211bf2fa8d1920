// The table of sources, and the one way into it.
#include <fmt/format.h>

#include <mirrorball/error.h>

#include "tile.h"

namespace mirrorball {
namespace {

struct Source {
    BumpSource told;
    Image (*draw)(const detail::Tile&);
};

const std::vector<Source>& sources() {
    using namespace detail;
    static const std::vector<Source> all = {
        {{"flat", "nothing", 1, false}, draw_flat},
        {{"ripples", "rings on water from a few places, moving outward", 1, true}, draw_ripples},
        {{"waves", "wind waves on deep water, moving", 16, true}, draw_waves},
        {{"brushed", "brushed metal: fine lines to the right", 0.05, false}, draw_brushed},
        {{"hammered", "hammered metal: round dents", 0.2, false}, draw_hammered},
        {{"bark", "bark: ridges and furrows, upright", 0.5, false}, draw_bark},
        {{"scratches", "a polished surface with straight scratches", 0.05, false}, draw_scratches},
        {{"noise", "eight octaves of gradient noise", 1, false}, draw_noise},
    };
    return all;
}

const Source& find_source(std::string_view name) {
    std::string names;
    for (const Source& source : sources()) {
        if (source.told.name == name) return source;
        names += (names.empty() ? "" : ", ") + source.told.name;
    }
    throw Error(Errc::usage, fmt::format("\"{}\" is no bump source; there are {}", name, names));
}

double checked_side(double side, const char* what) {
    constexpr double kLeast = 1e-6, kMost = 1e6;
    if (side >= kLeast && side <= kMost) return side;
    throw Error(Errc::usage, fmt::format("a tile's {} of {} m (from {} to {} was expected)", what,
                                         side, kLeast, kMost));
}

}  // namespace

std::vector<BumpSource> bump_sources() {
    std::vector<BumpSource> all;
    for (const Source& source : sources()) all.push_back(source.told);
    return all;
}

HeightMap make_bump(std::string_view name, int width, int height,
                    const BumpSourceOptions& options) {
    assert(width >= 1 && height >= 1);
    const Source& source = find_source(name);
    const double across =
        checked_side(options.width != 0 ? options.width : source.told.width, "width");
    const double down =
        checked_side(options.height != 0 ? options.height : across * height / width, "height");
    if (!std::isfinite(options.time))
        throw Error(Errc::usage,
                    fmt::format("the time is {} s (a finite number was expected)", options.time));
    return {source.draw({across, down, width, height, options.time}), across, down, Wrap::repeat};
}

}  // namespace mirrorball
