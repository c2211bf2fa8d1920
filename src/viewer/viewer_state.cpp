#include "viewer_state.h"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/scene_file.h>

namespace mirrorball {
namespace {

// JSON without the blanks between its tokens.
std::string compact(std::string_view json) {
    std::string result;
    bool in_string = false, escaped = false;
    for (const char c : json) {
        if (in_string) {
            in_string = escaped || c != '"';
            escaped = !escaped && c == '\\';
        } else if (c == ' ' || c == '\n') {
            continue;
        } else {
            in_string = c == '"';
        }
        result += c;
    }
    return result;
}

double parse_number(std::string_view key, const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !std::isfinite(value)) {
        throw Error(Errc::usage,
                    fmt::format("a viewer's state: {} is \"{}\", expected a number", key, text));
    }
    return value;
}

void set(ViewerState& state, std::string_view key, const std::string& value) {
    if (key == "showing") {
        state.comparison.showing = parse_showing(value);
    } else if (key == "other") {
        state.comparison.other = parse_method(value);
    } else if (key == "wipe") {
        state.comparison.wipe = parse_number(key, value);
    } else if (key == "full_scale") {
        state.comparison.full_scale = parse_number(key, value);
    } else if (key == "selected") {
        state.selected = static_cast<std::size_t>(std::fmax(0, parse_number(key, value)));
    } else if (key == "scene") {
        state.scene = parse_scene(value, "scene");
    } else {
        throw Error(Errc::usage,
                    fmt::format("a viewer's state has no \"{}\"; there are showing, other, wipe, "
                                "full_scale, selected and scene",
                                key));
    }
}

}  // namespace

std::string to_text(const ViewerState& state) {
    const Comparison& comparison = state.comparison;
    return fmt::format("showing={}&other={}&wipe={}&full_scale={}&selected={}&scene={}",
                       name(comparison.showing), name(comparison.other), comparison.wipe,
                       comparison.full_scale, state.selected, compact(to_json(state.scene)));
}

ViewerState parse_viewer_state(std::string_view text) {
    ViewerState state;
    while (!text.empty()) {
        const std::size_t equals = std::min(text.find('='), text.size());
        const std::string_view key = text.substr(0, equals);
        text.remove_prefix(std::min(equals + 1, text.size()));
        // The scene is last: all that is left.
        const std::size_t end =
            key == "scene" ? text.size() : std::min(text.find('&'), text.size());
        set(state, key, std::string(text.substr(0, end)));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return state;
}

}  // namespace mirrorball
