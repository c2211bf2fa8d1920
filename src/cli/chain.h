// Chains: prefiltered levels of halving size in one map.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <mirrorball/prefilter.h>

#include "command.h"

namespace mirrorball::cli {

/// "ggx:0.1,0.5,diffuse" as it stands, a number alone standing for another lobe of the kind before;
/// "table:FILE" is read (lobe.h). "ggx", "phong" or "charlie" alone is the chain that `mapping`
/// gives for `level_count` levels (empty: playcanvas for phong, else gltf). \throws Error
[[nodiscard]] std::vector<Lobe> parse_lobes(const std::string& text, const std::string& mapping,
                                            int level_count);

/// One target per lobe, each of half the size of the one before.
/// \throws Error(Errc::usage) if the last would have no texel
[[nodiscard]] std::vector<PrefilterTarget> chain_targets(const std::vector<Lobe>& lobes,
                                                         Projection projection, int size,
                                                         const Axes& axes);
[[nodiscard]] EnvironmentMap join_levels(std::vector<EnvironmentMap> levels);

/// What the maps of the targets hold.
[[nodiscard]] std::uint64_t bytes_needed(std::span<const PrefilterTarget> targets);

/// --tolerance.
[[nodiscard]] Option tolerance_option(double& tolerance);

/// Levels from `size` down to the last that has 16 texels or more: fewer cannot show even the
/// widest lobe without visible facets between their centres.
[[nodiscard]] int usual_level_count(int size);

}  // namespace mirrorball::cli
