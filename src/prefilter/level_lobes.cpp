// Which lobe each mip level stands for, in the programs that read them.
#include <mirrorball/prefilter.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <mirrorball/error.h>

namespace mirrorball {
namespace {

Lobe ggx(double roughness) {
    return {Lobe::Kind::ggx, std::clamp(roughness, 0.0, 1.0)};
}
Lobe phong(double exponent) {
    return {Lobe::Kind::phong, exponent};
}

// level / (level_count - 1), 0 for a single level
double share(int level, int level_count) {
    return level_count > 1 ? static_cast<double>(level) / (level_count - 1) : 0;
}

// 2^(scale gloss + bias), glossScale 10, glossBias 1
double cmft_exponent(int level, int level_count) {
    return std::exp2(10 * (1 - share(level, level_count)) + 1);
}

struct Mapping {
    std::string_view name;
    Lobe (*lobe)(int level, int level_count);
};

constexpr Mapping kMappings[] = {
    {"gltf", [](int level, int count) { return ggx(share(level, count)); }},
    // level = L_max r (2 - r)
    {"filament", [](int level, int count) { return ggx(1 - std::sqrt(1 - share(level, count))); }},
    {"unreal",
     [](int level, int count) { return ggx(std::exp2((1 - (count - 1 - level)) / 1.2)); }},
    // level = 6 r (1.7 - 0.7 r), whatever the number of levels
    {"unity",
     [](int level, int) {
         const double root = 1.7 * 1.7 - 4 * 0.7 * std::min(level, 6) / 6;
         return ggx((1.7 - std::sqrt(root)) / 1.4);
     }},
    {"playcanvas",
     [](int level, int) {
         if (level == 0) return Lobe{};
         return phong(std::max(1.0, std::floor(2048 * std::exp2(-2 * level))));
     }},
    {"cmft", [](int level, int count) { return phong(cmft_exponent(level, count)); }},
    // its lighting model "phongbrdf" keeps the cosine of the light's angle, which is the lobe's own
    {"cmft-phongbrdf", [](int level, int count) { return phong(cmft_exponent(level, count) + 1); }},
};

}  // namespace

std::vector<std::string> level_mappings() {
    std::vector<std::string> names;
    for (const Mapping& mapping : kMappings) names.emplace_back(mapping.name);
    return names;
}

std::vector<Lobe> level_lobes(std::string_view name, int level_count) {
    for (const Mapping& mapping : kMappings) {
        if (mapping.name != name) continue;
        std::vector<Lobe> lobes;
        for (int level = 0; level < level_count; ++level)
            lobes.push_back(mapping.lobe(level, level_count));
        return lobes;
    }
    throw Error(Errc::usage, fmt::format("no level mapping \"{}\"; there are {}", name,
                                         fmt::join(level_mappings(), ", ")));
}

}  // namespace mirrorball
