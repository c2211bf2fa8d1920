#include "chain.h"

#include <algorithm>

#include <fmt/format.h>

#include <mirrorball/error.h>

#include "options.h"

namespace mirrorball::cli {
namespace {

struct Chain {
    std::string_view name;  // of the lobe without its parameter
    Lobe::Kind kind;        // of the levels that the mapping gives
    const char* usual_mapping;
};
constexpr Chain kChains[] = {
    {"ggx", Lobe::Kind::ggx, "gltf"},
    {"phong", Lobe::Kind::phong, "playcanvas"},
    {"charlie", Lobe::Kind::ggx, "gltf"},  // the same roughnesses
};

std::vector<Lobe> whole_chain(const Chain& chain, const std::string& mapping, int level_count) {
    const std::string chosen = mapping.empty() ? chain.usual_mapping : mapping;
    std::vector<Lobe> lobes = level_lobes(chosen, level_count);
    for (Lobe& lobe : lobes) {
        if (lobe.kind != chain.kind && lobe.kind != Lobe::Kind::mirror) {
            throw Error(Errc::usage,
                        fmt::format("--mapping: {} is a chain of {} lobes, --lobe is {}", chosen,
                                    split(to_string(lobe), ':').front(), chain.name));
        }
        if (chain.name == "charlie")
            lobe = {Lobe::Kind::charlie, std::max(lobe.parameter, kLeastCharlieRoughness)};
    }
    return lobes;
}

// A lobe as typed: unlike in metadata, a table is a file to read.
Lobe read_lobe(const std::string& text) {
    constexpr std::string_view table = "table:";
    if (text.starts_with(table)) return read_lobe_table(text.substr(table.size()));
    return parse_lobe(text);
}

bool is_number(const std::string& text) {
    return !text.empty() && text.find_first_not_of("0123456789.eE+-") == std::string::npos;
}

}  // namespace

std::vector<Lobe> parse_lobes(const std::string& text, const std::string& mapping,
                              int level_count) {
    for (const Chain& chain : kChains)
        if (text == chain.name) return whole_chain(chain, mapping, level_count);
    if (!mapping.empty()) {
        throw Error(Errc::usage, fmt::format("--mapping is for a whole chain, --lobe ggx, phong or "
                                             "charlie; found --lobe {}",
                                             text));
    }
    std::vector<Lobe> lobes;
    std::string kind;  // of the one before, with its colon
    for (const std::string& part : split(text, ',')) {
        lobes.push_back(read_lobe(is_number(part) ? kind + part : part));
        if (!is_number(part)) kind = part.substr(0, part.find(':') + 1);
    }
    return lobes;
}

std::vector<PrefilterTarget> chain_targets(const std::vector<Lobe>& lobes, Projection projection,
                                           int size, const Axes& axes) {
    const int least = projection == Projection::equirect ? 2 : 1;
    std::vector<PrefilterTarget> targets;
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        const int level_size = size >> i;
        if (level_size < least) {
            throw Error(Errc::usage, fmt::format("{} levels do not fit in size {}, which has {}",
                                                 lobes.size(), size, i));
        }
        targets.push_back({lobes[i], projection, level_size, axes});
    }
    return targets;
}

EnvironmentMap join_levels(std::vector<EnvironmentMap> levels) {
    EnvironmentMap chain{levels.front().projection, levels.front().axes, {}};
    for (EnvironmentMap& level : levels) chain.levels.push_back(std::move(level.levels.front()));
    return chain;
}

std::uint64_t bytes_needed(std::span<const PrefilterTarget> targets) {
    std::uint64_t bytes = 0;
    for (const PrefilterTarget& target : targets)
        bytes += bytes_needed(target.projection, target.size, false);
    return bytes;
}

Option tolerance_option(double& tolerance) {
    const SetValue set = [&tolerance](const std::string& typed) {
        constexpr double most = 0.1;
        const double value = parse_real_number(typed, 0, most);
        if (value == 0) {
            throw Error(Errc::usage,
                        fmt::format("\"{}\" is not a number above 0 and up to {}", typed, most));
        }
        tolerance = value;
    };
    return {"--tolerance", "T",
            "of prefiltering: what a level may be off by, rms over its own rms [1e-4; above 0, up "
            "to 0.1]",
            set};
}

int usual_level_count(int size) {
    int count = 1;
    while (size >> count >= 16) ++count;
    return std::max(2, count);
}

}  // namespace mirrorball::cli
