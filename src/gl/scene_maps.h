// SceneMaps: an environment as the textures that a method looks up.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <mirrorball/reflection_maps.h>
#include <mirrorball/scene.h>

#include "map_textures.h"
#include "method_maps.h"

namespace mirrorball::gl {

class SceneMaps {
  public:
    /// `size` is the edge of a cube's face; other maps are as fine as such a cube. Maps of
    /// every roughness are made if they are asked for and the method looks up at each pixel.
    SceneMaps(const EnvironmentMap& environment, Method method, int size,
              std::span<const Lobe> lobes, bool rough = false);

    /// Re-makes maps that depend on where the camera looks.
    void look_from(const Axes& camera);

    /// For a surface with this material in a scene with that environment.
    [[nodiscard]] LookupMaps lookup(const Material& material,
                                    const SceneEnvironment& environment) const;

    [[nodiscard]] std::uint64_t bytes() const { return shown().bytes(); }

  private:
    [[nodiscard]] const MapTextures& shown() const { return warped_ ? warped_->textures() : maps_; }

    Method method_;
    int size_;
    std::vector<Lobe> lobes_;
    Axes axes_;  // of maps_
    MapTextures maps_;
    std::optional<MethodMaps> warped_;  // of maps with rims
    std::optional<Axes> made_for_;      // the camera that those were last made for
};

}  // namespace mirrorball::gl
