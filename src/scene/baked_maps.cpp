#include <mirrorball/baked_maps.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/resample.h>

namespace mirrorball {
namespace {

Lobe::Kind kind_of(const Lobe& lobe) {
    return lobe.kind == Lobe::Kind::mirror ? Lobe::Kind::ggx : lobe.kind;
}

double width_of(const Lobe& lobe) {
    switch (lobe.kind) {
        case Lobe::Kind::phong:
        case Lobe::Kind::blinn_phong:
            return -std::log(std::max(lobe.parameter, 1e-9));
        case Lobe::Kind::ggx:
        case Lobe::Kind::charlie:
            return lobe.parameter;
        default:
            return 0;
    }
}

EnvironmentMap mixed(EnvironmentMap a, const EnvironmentMap& b, double share) {
    const auto of_b = static_cast<float>(share);
    for (std::size_t face = 0; face < a.levels[0].faces.size(); ++face) {
        const auto values = a.levels[0].faces[face].values();
        const auto others = b.levels[0].faces[face].values();
        std::transform(values.begin(), values.end(), others.begin(), values.begin(),
                       [=](float x, float y) { return x + (y - x) * of_b; });
    }
    return a;
}

}  // namespace

BakedMaps::BakedMaps(const std::vector<EnvironmentMap>& maps) {
    for (const EnvironmentMap& map : maps) {
        for (const Level& level : map.levels) {
            if (!level.lobe) continue;
            const auto found =
                std::find_if(kinds_.begin(), kinds_.end(), [&](const Levels& levels) {
                    return kind_of(levels.front().lobe) == kind_of(*level.lobe);
                });
            Levels& levels = found == kinds_.end() ? kinds_.emplace_back() : *found;
            levels.push_back(
                {*level.lobe, width_of(*level.lobe), {map.projection, map.axes, {level}}, {}});
        }
    }
    for (Levels& levels : kinds_) {
        std::stable_sort(levels.begin(), levels.end(),
                         [](const Baked& a, const Baked& b) { return a.width < b.width; });
        for (std::size_t i = 1; i < levels.size(); ++i) {
            const EnvironmentMap& sharper = levels[i - 1].map;
            levels[i].in_sharper_size =
                resample(levels[i].map, sharper.projection, sharper.width(), sharper.axes);
        }
    }
}

const BakedMaps::Levels& BakedMaps::levels_for(const Lobe& lobe) const {
    for (const Levels& levels : kinds_)
        if (kind_of(levels.front().lobe) == kind_of(lobe)) return levels;
    throw Error(Errc::usage, fmt::format("no map was baked for the lobe {} or others of its kind",
                                         to_string(lobe)));
}

EnvironmentMap BakedMaps::operator()(const PrefilterTarget& target) const {
    const Levels& levels = levels_for(target.lobe);
    const double width = width_of(target.lobe);
    const auto wider = std::find_if(levels.begin() + 1, levels.end(),
                                    [&](const Baked& level) { return level.width > width; });
    const Baked& sharp = *(wider - 1);
    EnvironmentMap result = sharp.map;
    if (wider != levels.end() && width > sharp.width) {
        result = mixed(std::move(result), wider->in_sharper_size,
                       (width - sharp.width) / (wider->width - sharp.width));
    }
    const MapShape wanted{target.projection, target.size, target.axes};
    if (shape_of(result) != wanted)
        result = resample(result, wanted.projection, wanted.size, wanted.axes);
    result.levels[0].lobe = target.lobe;
    return result;
}

}  // namespace mirrorball
