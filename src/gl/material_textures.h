// MaterialTextures: what materials look up besides light, made when it is first asked for.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include <mirrorball/fresnel.h>
#include <mirrorball/scene_assets.h>

#include "texture.h"

namespace mirrorball::gl {

class MaterialTextures {
  public:
    explicit MaterialTextures(std::shared_ptr<const SceneAssets> assets)
        : assets_(std::move(assets)) {}

    /// Textures of pictures that are the same stay.
    void set_assets(std::shared_ptr<const SceneAssets> assets);

    /// One of the assets' pictures; it repeats.
    const Texture& picture(const std::string& name);
    /// Section 6's 1-D texture: by the cosine, samples at its ends.
    const Texture& fresnel(const Fresnel& fresnel);
    /// By n.v and roughness: scale, bias.
    const Texture& dfg();

  private:
    std::shared_ptr<const SceneAssets> assets_;
    std::map<std::string, Texture> pictures_;
    std::map<std::string, Texture> fresnels_;
    std::optional<Texture> dfg_;
};

}  // namespace mirrorball::gl
