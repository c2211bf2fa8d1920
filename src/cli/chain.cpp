#include "chain.h"

#include <algorithm>

#include <fmt/format.h>

#include <mirrorball/error.h>

#include "command.h"

namespace mirrorball::cli {
namespace {

std::vector<Lobe> whole_chain(Lobe::Kind kind, const std::string& text, const std::string& mapping,
                              int level_count) {
    const std::string usual = kind == Lobe::Kind::ggx ? "gltf" : "playcanvas";
    const std::string& chosen = mapping.empty() ? usual : mapping;
    const std::vector<Lobe> lobes = level_lobes(chosen, level_count);
    for (const Lobe& lobe : lobes) {
        if (lobe.kind != kind && lobe.kind != Lobe::Kind::mirror) {
            throw Error(Errc::usage,
                        fmt::format("--mapping: {} is a chain of {} lobes, --lobe is {}", chosen,
                                    split(to_string(lobe), ':').front(), text));
        }
    }
    return lobes;
}

}  // namespace

std::vector<Lobe> parse_lobes(const std::string& text, const std::string& mapping,
                              int level_count) {
    if (text == "ggx") return whole_chain(Lobe::Kind::ggx, text, mapping, level_count);
    if (text == "phong") return whole_chain(Lobe::Kind::phong, text, mapping, level_count);
    if (!mapping.empty()) {
        throw Error(Errc::usage, fmt::format("--mapping is for a whole chain, --lobe ggx or phong; "
                                             "found --lobe {}",
                                             text));
    }
    std::vector<Lobe> lobes;
    for (const std::string& part : split(text, ',')) lobes.push_back(parse_lobe(part));
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

int usual_level_count(int size) {
    int count = 1;
    while (size >> count >= 16) ++count;
    return std::max(2, count);
}

}  // namespace mirrorball::cli
