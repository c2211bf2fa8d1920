#include <mirrorball/prefilter.h>

#include <optional>

#include "prefilter/light_tree.h"
#include "prefilter/target.h"

namespace mirrorball {

std::vector<EnvironmentMap> prefilter(const EnvironmentMap& source,
                                      std::span<const PrefilterTarget> targets,
                                      const Progress& progress) {
    std::vector<EnvironmentMap> results;
    std::optional<detail::LightTree> tree;
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const PrefilterTarget& target = targets[i];
        Progress part;
        if (progress)
            part = [&, i](double fraction) {
                return progress((static_cast<double>(i) + fraction) /
                                static_cast<double>(targets.size()));
            };
        if (target.lobe.is_delta()) {
            results.push_back(detail::mirror_target(source, target, part));
            continue;
        }
        if (!tree) tree.emplace(source);
        const detail::TreeLobe lobe(target.lobe);
        results.push_back(detail::fill_target(
            target, [&](const Vec3d& axis) { return tree->filtered(lobe, axis); }, part));
    }
    return results;
}

}  // namespace mirrorball
