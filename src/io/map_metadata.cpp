#include "map_metadata.h"

#include <algorithm>

#include <fmt/format.h>
#include <mirrorball/error.h>

namespace mirrorball::detail {
namespace {

constexpr const char* kProjectionKey = "mirrorball.projection";
constexpr const char* kLayoutKey = "mirrorball.layout";
constexpr const char* kAxesKey = "mirrorball.axes";
constexpr const char* kLobesKey = "mirrorball.lobes";
constexpr const char* kQuantityKey = "mirrorball.quantity";

constexpr std::string_view kSource = "source";
constexpr std::string_view kRadiance = "radiance", kIrradiance = "irradiance";

bool is_diffuse(const std::optional<Lobe>& lobe) {
    return lobe && lobe->kind == Lobe::Kind::diffuse;
}

bool is_irradiance(const EnvironmentMap& map) {
    return std::all_of(map.levels.begin(), map.levels.end(),
                       [](const Level& level) { return is_diffuse(level.lobe); });
}

std::string lobes_in_words(const EnvironmentMap& map) {
    std::string words;
    for (const Level& level : map.levels) {
        if (!words.empty()) words += ',';
        words += level.lobe ? to_string(*level.lobe) : kSource;
    }
    return words;
}

std::vector<std::optional<Lobe>> parse_lobes(std::string_view words) {
    std::vector<std::optional<Lobe>> lobes;
    for (std::size_t start = 0; start <= words.size();) {
        const std::size_t end = std::min(words.find(',', start), words.size());
        const std::string_view word = words.substr(start, end - start);
        lobes.push_back(word == kSource ? std::nullopt : std::optional(parse_lobe(word)));
        start = end + 1;
    }
    return lobes;
}

bool parse_quantity(std::string_view word) {
    if (word != kRadiance && word != kIrradiance) {
        throw Error(Errc::cannot_read,
                    fmt::format("'{}' is neither {} nor {}", word, kRadiance, kIrradiance));
    }
    return word == kIrradiance;
}

// Calls parse(value) if the file has the key, and says which key it was if that fails.
template <class Parse>
void with_value(const Metadata& metadata, const char* key, const std::string& file_name,
                Parse&& parse) {
    const auto found = metadata.find(key);
    if (found == metadata.end()) return;
    try {
        parse(found->second);
    } catch (const Error& error) {
        throw Error(Errc::cannot_read,
                    fmt::format("{}: its metadata {}: {}", file_name, key, error.what()));
    }
}

}  // namespace

Metadata describe(const EnvironmentMap& map, Layout layout, const Metadata& callers) {
    Metadata metadata = callers;
    metadata[kProjectionKey] = name(map.projection);
    metadata[kAxesKey] = to_string(map.axes);
    metadata[kLobesKey] = lobes_in_words(map);
    metadata[kQuantityKey] = is_irradiance(map) ? kIrradiance : kRadiance;
    metadata.erase(kLayoutKey);
    if (layout != Layout::automatic && layout != Layout::single)
        metadata[kLayoutKey] = name(layout);
    return metadata;
}

MapWords parse_words(const Metadata& metadata, const std::string& file_name) {
    MapWords words;
    with_value(metadata, kProjectionKey, file_name,
               [&](const std::string& value) { words.projection = parse_projection(value); });
    with_value(metadata, kLayoutKey, file_name,
               [&](const std::string& value) { words.layout = parse_layout(value); });
    with_value(metadata, kAxesKey, file_name, [&](const std::string& value) {
        static_cast<void>(parse_axes(value, words.projection.value_or(Projection::equirect)));
        words.axes = value;
    });
    with_value(metadata, kLobesKey, file_name,
               [&](const std::string& value) { words.lobes = parse_lobes(value); });
    with_value(metadata, kQuantityKey, file_name,
               [&](const std::string& value) { words.irradiance = parse_quantity(value); });
    return words;
}

void apply_lobes(const MapWords& words, EnvironmentMap& map, const std::string& file_name) {
    if (words.lobes) {
        if (words.lobes->size() != map.levels.size()) {
            throw Error(Errc::cannot_read,
                        fmt::format("{}: its metadata {} name {} levels, and it has {}", file_name,
                                    kLobesKey, words.lobes->size(), map.levels.size()));
        }
        for (std::size_t i = 0; i < map.levels.size(); ++i) map.levels[i].lobe = (*words.lobes)[i];
        if (words.irradiance && !is_irradiance(map)) {
            throw Error(Errc::cannot_read,
                        fmt::format("{}: its metadata say {} in {} and other lobes than diffuse "
                                    "in {}",
                                    file_name, kIrradiance, kQuantityKey, kLobesKey));
        }
    } else if (words.irradiance) {
        for (Level& level : map.levels) level.lobe = Lobe{Lobe::Kind::diffuse};
    }
}

}  // namespace mirrorball::detail
