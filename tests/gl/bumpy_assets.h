// Assets of scenes with bump maps, as load_assets() has them.
#pragma once

#include <algorithm>
#include <vector>

#include <mirrorball/bump.h>

#include "gl_test.h"

namespace mirrorball::gl {

/// The environment, all built-in meshes with tangents, and these sources.
inline std::shared_ptr<SceneAssets> bumpy_assets(const EnvironmentMap& environment,
                                                 const std::vector<BumpMap>& bumps) {
    auto assets = assets_in(environment);
    for (auto& [name, mesh] : assets->meshes) mesh = with_tangents(std::move(mesh));
    for (const BumpMap& bump : bumps) {
        if (bump.is_smooth() || moves(bump)) continue;
        const HeightMap relief = make_bump(bump.source, bump.size, bump.size);
        BumpTexels texels{slopes(relief), relief.heights};
        const auto values = texels.heights.values();
        const auto [low_at, high_at] = std::minmax_element(values.begin(), values.end());
        const float low = *low_at, span = *high_at - low;
        for (float& value : values) value = span > 0 ? (value - low) / span : 1;
        assets->bumps[bump_key(bump)] = std::make_shared<const BumpTexels>(std::move(texels));
    }
    return assets;
}

}  // namespace mirrorball::gl
