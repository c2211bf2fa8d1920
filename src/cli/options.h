// Options that mean the same in every verb, and what follows from them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <mirrorball/io.h>
#include <mirrorball/resample.h>

#include "command.h"

namespace mirrorball::cli {

inline constexpr int kLargestSize = 1 << 20;

/// Every verb's.
struct Shared {
    int threads = 0;                 ///< 0: as many as the machine has
    std::uint64_t memory_limit = 0;  ///< bytes
    bool quiet = false, json = false;
};
void add_shared_options(Command& command, Shared& shared);

/// Verbs' that read a map.
struct Input {
    std::string source;
    std::vector<std::string> faces;
    MapReadOptions options;
};
void add_input_argument(Command& command, Input& input, bool required = true);
/// Any number of them, at least one.
void add_inputs_argument(Command& command, std::vector<std::string>& sources);
void add_input_options(Command& command, Input& input);

/// Reads the map within the limit on memory and tells the notes. Missing input is a usage error. A
/// panorama that leaves no room for `result_bytes` is reduced to one that does, and that is told.
[[nodiscard]] LoadedMap load(const Input& input, const Shared& shared,
                             std::uint64_t result_bytes = 0);
[[nodiscard]] LoadedMap load(const std::string& source, const Input& input, const Shared& shared,
                             std::uint64_t result_bytes = 0);
/// What load() is asked for: the file's name, or the faces' in one. \throws Error(Errc::usage)
[[nodiscard]] std::string source_of(const Input& input);

/// "-90,30,0" -> radians.
struct Rotation {
    double yaw = 0, pitch = 0, roll = 0;
};
[[nodiscard]] Rotation parse_rotation(const std::string& text);
[[nodiscard]] CropCircle parse_crop(const std::string& text);
/// "2G", "512M", "1000000" -> bytes; K, M and G are powers of 1024.
[[nodiscard]] std::uint64_t parse_memory(const std::string& text);
[[nodiscard]] Interpolation parse_interpolation(const std::string& text);
[[nodiscard]] Transfer parse_transfer(const std::string& text);

// Choices, for help and completion.
[[nodiscard]] Choices projection_choices();
[[nodiscard]] Choices layout_choices();
[[nodiscard]] Choices texel_format_choices();
[[nodiscard]] Choices axes_choices();
[[nodiscard]] Choices lobe_choices();
[[nodiscard]] Choices mapping_choices();
[[nodiscard]] Choices tone_map_choices();
[[nodiscard]] Choices input_choices();
[[nodiscard]] Choices builtin_choices();
/// Of a Fresnel term.
[[nodiscard]] Choices surface_choices();
inline Choices file_choices() {
    return {.values = {}, .closed = false, .files = true};
}

/// The size at which `target` keeps the resolution of `source`: as many texels around a great
/// circle through the centre of the picture. An equirect W and a cube W/4 go together.
[[nodiscard]] int size_that_keeps_resolution(const EnvironmentMap& source, Projection target);
/// The number that --size would be for this map: a face's edge, an equirect's width.
[[nodiscard]] int size_of(const EnvironmentMap& map, int level = 0);
/// Bytes of a map's level 0 and, with `mips`, of its chain.
[[nodiscard]] std::uint64_t bytes_needed(Projection projection, int size, bool mips);
[[nodiscard]] std::uint64_t bytes_held(const EnvironmentMap& map);
/// \throws Error(Errc::usage) with both figures when `bytes` are more than --memory allows, or if
/// `size` does not suit the projection
void check_size(Projection projection, int size);
void check_memory(std::uint64_t bytes, const std::string& what, const Shared& shared);
/// "3.1 MB"
[[nodiscard]] std::string bytes_text(std::uint64_t bytes);

}  // namespace mirrorball::cli
