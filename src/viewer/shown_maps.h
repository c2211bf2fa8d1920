// ShownMaps: small pictures of an environment's maps, made when they are asked for and kept.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <tuple>

#include <mirrorball/prefilter.h>
#include <mirrorball/viewer.h>

namespace mirrorball {

class ShownMaps {
  public:
    /// Begins anew with another environment, as its file has it.
    void set_environment(const EnvironmentMap& environment);

    struct Look {
        Axes environment;  ///< of the map, turned as the scene has it
        Lobe lobe;         ///< of MapContent::glossy
        double exposure = 1;
        ToneMap tone_map = ToneMap::film;
        Axes axes;  ///< of the picture

        bool operator==(const Look&) const = default;
    };
    const ScreenPicture& picture(MapContent content, Projection projection, int height,
                                 const Look& look);

  private:
    [[nodiscard]] EnvironmentMap blurred(const Lobe& lobe);
    const EnvironmentMap& map(MapContent content, const Lobe& lobe);

    struct Kept {
        Look look;
        ScreenPicture picture;
    };
    // A small cube with mip levels: pictures of a few hundred pixels show no more.
    std::shared_ptr<const EnvironmentMap> small_;
    std::optional<LobeFilter> filter_;
    std::optional<EnvironmentMap> diffuse_;
    std::optional<std::pair<Lobe, EnvironmentMap>> glossy_;
    std::map<std::tuple<MapContent, Projection, int>, Kept> kept_;
    std::uint64_t last_version_ = 0;
};

}  // namespace mirrorball
