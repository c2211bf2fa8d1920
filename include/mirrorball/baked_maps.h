// BakedMaps: maps of an environment that were prefiltered beforehand, as files have them, to look
// up instead of prefiltering it again.
#pragma once

#include <vector>

#include <mirrorball/environment_map.h>
#include <mirrorball/lobe.h>
#include <mirrorball/prefilter.h>

namespace mirrorball {

class BakedMaps {
  public:
    /// Of all levels that have a lobe, whichever maps they are in; others are passed over. Made
    /// ready for sliders: each level is there in the size of the next sharper one, too.
    explicit BakedMaps(const std::vector<EnvironmentMap>& maps);

    /// In the place of LobeFilter. The level of that lobe, or, as a renderer's trilinear filter has
    /// it, what lies between the two next to it: in proportion to GGX's roughness, to the logarithm
    /// of a cosine lobe's exponent. Beyond the sharpest and the widest level it is that one. A
    /// level of the target's shape is given as it is, others resampled. A mirror's level is GGX of
    /// roughness 0 as well.
    /// \throws Error(Errc::usage) naming the lobe if no level is of its kind
    [[nodiscard]] EnvironmentMap operator()(const PrefilterTarget& target) const;

  private:
    struct Baked {
        Lobe lobe;
        double width = 0;  // a measure that grows with it, and is linear between levels
        EnvironmentMap map;
        EnvironmentMap in_sharper_size;  // nothing for the sharpest
    };
    using Levels = std::vector<Baked>;  // of lobes of one kind, the sharpest first

    [[nodiscard]] const Levels& levels_for(const Lobe& lobe) const;

    std::vector<Levels> kinds_;
};

}  // namespace mirrorball
