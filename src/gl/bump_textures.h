// BumpTextures: bump maps on the graphics card, made when they are first asked for.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include <mirrorball/scene.h>
#include <mirrorball/scene_assets.h>

#include "texture.h"

namespace mirrorball::gl {

class BumpTextures {
  public:
    explicit BumpTextures(std::shared_ptr<const SceneAssets> assets) : assets_(std::move(assets)) {}

    /// Textures of bump maps that are the same stay.
    void set_assets(std::shared_ptr<const SceneAssets> assets);

    /// du, dv, their variance over all directions, the height from 0 to 1, in all levels. Of what
    /// moves only the last moment asked for is kept.
    const Texture& get(const BumpMap& bump, double time);

  private:
    struct Kept {
        double time;
        Texture texture;
    };

    std::shared_ptr<const SceneAssets> assets_;
    std::map<std::string, Kept> kept_;  // by bump_key()
};

}  // namespace mirrorball::gl
