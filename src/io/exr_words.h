// What is said of an OpenEXR file, whichever library reads it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace mirrorball::detail {

inline constexpr const char* kDeepPixels = "holds deep pixels; flat ones were expected";
inline constexpr const char* kRipmapLevels =
    "has ripmap levels; mip levels or one level were expected";
inline constexpr const char* kNeverWritten = "is incomplete: some of its pixels were never written";

inline std::string no_picture_among(const std::vector<std::string>& channels) {
    return fmt::format("has the channels {} (R, G and B or Y were expected)",
                       fmt::join(channels, ", "));
}

inline std::string sub_sampled(const std::string& channel, int x, int y) {
    return fmt::format("its channel {} is sub-sampled {} x {}; full ones were expected", channel, x,
                       y);
}

inline std::string tiles_too_large(std::int64_t tile_width, std::int64_t tile_height,
                                   std::int64_t width, std::int64_t height) {
    return fmt::format("its tiles are {} x {}, for a picture of {} x {}", tile_width, tile_height,
                       width, height);
}

/// Which of a file's parts and layers was read, where there is a choice.
inline void note_choice(std::int64_t part_count, std::int64_t part,
                        const std::vector<std::string>& channels, std::vector<std::string>& notes) {
    if (part_count > 1)
        notes.push_back(fmt::format("has {} parts; part {} was read", part_count, part + 1));
    if (channels.front().size() > 1)
        notes.push_back(
            fmt::format("has no plain R, G and B; {} were read", fmt::join(channels, ", ")));
}

}  // namespace mirrorball::detail
