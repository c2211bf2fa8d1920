// What our files say of their map in words, so that a map read back is the map written:
//
//     mirrorball.projection   "octahedral"
//     mirrorball.layout       "vertical-cross"; only where several faces lie in one picture
//     mirrorball.axes         "+x+y-z"
//     mirrorball.lobes        "source,ggx:0.25,ggx:0.5", one per level
//     mirrorball.quantity     "radiance", or "irradiance" where every level is diffuse
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <mirrorball/io.h>

namespace mirrorball::detail {

/// The caller's metadata, and ours of this map over it.
[[nodiscard]] Metadata describe(const EnvironmentMap& map, Layout layout, const Metadata& callers);

/// What a file's metadata say; what they do not mention is empty.
struct MapWords {
    std::optional<Projection> projection;
    std::optional<Layout> layout;
    std::optional<std::string> axes;  ///< parse_axes() text
    std::optional<std::vector<std::optional<Lobe>>> lobes;
    bool irradiance = false;
};
/// \throws Error(Errc::cannot_read) naming the file, the key and what is wrong with its value
[[nodiscard]] MapWords parse_words(const Metadata& metadata, const std::string& file_name);

/// Sets the lobe of each level. \throws Error(Errc::cannot_read) where the words do not fit the map
void apply_lobes(const MapWords& words, EnvironmentMap& map, const std::string& file_name);

}  // namespace mirrorball::detail
