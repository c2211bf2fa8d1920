#include "material_textures.h"

#include <utility>

#include <mirrorball/dfg.h>

#include "same_assets.h"

namespace mirrorball::gl {
namespace {

constexpr int kFresnelSampleCount = 512;
constexpr int kDfgSize = 128;

}  // namespace

void MaterialTextures::set_assets(std::shared_ptr<const SceneAssets> assets) {
    std::erase_if(pictures_, [&](const auto& picture) {
        return !is_same(assets_->pictures, assets->pictures, picture.first);
    });
    if (assets_->dfg != assets->dfg) dfg_.reset();
    assets_ = std::move(assets);
}

const Texture& MaterialTextures::picture(const std::string& name) {
    const auto found = pictures_.find(name);
    if (found != pictures_.end()) return found->second;
    Texture texture = upload(assets_->pictures.at(name), true);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_REPEAT);
    return pictures_.emplace(name, std::move(texture)).first->second;
}

const Texture& MaterialTextures::fresnel(const Fresnel& fresnel) {
    const std::string key = to_string(fresnel);
    const auto found = fresnels_.find(key);
    if (found != fresnels_.end()) return found->second;
    const FresnelMap map(fresnel, kFresnelSampleCount);
    return fresnels_.emplace(key, upload(map.image())).first->second;
}

const Texture& MaterialTextures::dfg() {
    if (!dfg_) dfg_ = upload(assets_->dfg ? *assets_->dfg : DfgTable(kDfgSize, kDfgSize).image());
    return *dfg_;
}

}  // namespace mirrorball::gl
