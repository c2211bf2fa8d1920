// SceneMaps: an environment as the textures that a method looks up.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <mirrorball/baked_maps.h>
#include <mirrorball/prefilter.h>
#include <mirrorball/progress.h>
#include <mirrorball/scene.h>

#include "map_textures.h"
#include "method_maps.h"

namespace mirrorball::gl {

/// They are made of the environment as its file has it. Where it is turned, so are lookups: that
/// costs nothing but maps that are made for the camera.
class SceneMaps {
  public:
    /// Of the filter's source; what is baked, if anything, stands for the filter. `size` is the
    /// edge of a cube's face; other maps are as fine as such a cube. Maps of every roughness are
    /// made if they are asked for and the method looks up at each pixel.
    SceneMaps(std::shared_ptr<LobeFilter> filter, Method method, int size, bool rough = false,
              std::shared_ptr<const BakedMaps> baked = nullptr, const Progress& progress = {});

    /// Makes maps for the lobes that have none. Those of other lobes stay, up to some memory, for a
    /// scene may come back to them; a lobe's map is the same whenever it is made. `quick`: large
    /// maps are half as fine until they are asked for without it, and maps of every roughness,
    /// which are made once, stand in for what would take long.
    void set_lobes(std::span<const Lobe> lobes, bool quick = false, const Progress& progress = {});

    /// Re-makes maps that depend on where the camera looks in an environment that is turned so.
    void look_from(const Axes& camera, const SceneEnvironment& environment);

    /// For a surface with this material in a scene with that environment, if its lobe is set.
    [[nodiscard]] LookupMaps lookup(const Material& material,
                                    const SceneEnvironment& environment) const;

    /// Of those that are looked up, with the lobes that are set.
    [[nodiscard]] std::uint64_t bytes() const { return shown().bytes() - unused_bytes(); }
    /// Of all.
    [[nodiscard]] std::uint64_t kept_bytes() const {
        return maps_.bytes() + (warped_ ? warped_->textures().bytes() : 0);
    }

  private:
    [[nodiscard]] const MapTextures& shown() const { return warped_ ? warped_->textures() : maps_; }

    struct Kept {
        Lobe lobe;
        bool is_coarse;      // made for a quick picture
        std::uint64_t used;  // the last turn in which it was
    };

    [[nodiscard]] EnvironmentMap filtered(const PrefilterTarget& target,
                                          const Progress& progress) const;
    void make_rough(const Progress& progress);
    void need_rough(const Progress& progress);
    [[nodiscard]] bool takes_long(const Lobe& lobe) const;
    void make_glossy(const Lobe& lobe, bool quick, const Progress& progress);
    void forget_unused();
    void forget(std::size_t lobe);
    [[nodiscard]] std::uint64_t unused_bytes() const;
    [[nodiscard]] std::size_t index_of(const Lobe& lobe) const;

    std::shared_ptr<LobeFilter> filter_;
    std::shared_ptr<const BakedMaps> baked_;
    Method method_;
    Projection projection_;  // of maps_
    int size_;
    Axes axes_;  // of maps_
    MapTextures maps_;
    std::vector<Kept> lobes_;  // of maps_.glossy
    std::uint64_t turn_ = 0;
    std::optional<MethodMaps> warped_;               // of maps with rims
    std::optional<std::pair<Axes, Axes>> made_for_;  // with these axes of maps_, for this camera
};

}  // namespace mirrorball::gl
