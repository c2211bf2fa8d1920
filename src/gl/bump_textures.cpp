// Levels hold the variance of the slopes under a texel, not their squares: half floats would leave
// nothing of a small difference of two squares, and bilinear lookup would count as variance what a
// magnified texture shows.
#include "bump_textures.h"

#include <algorithm>
#include <vector>

#include "bump/levels.h"
#include "same_assets.h"

namespace mirrorball::gl {
namespace {

GLint wrap_mode(Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat:
            return GL_REPEAT;
        case Wrap::clamp:
            return GL_CLAMP_TO_EDGE;
        case Wrap::mirror:
            return GL_MIRRORED_REPEAT;
    }
    return GL_REPEAT;
}

// Heights that nobody knows are one texel.
float height_at(const Image& heights, int x, int y) {
    return *heights.at(std::min(x, heights.width() - 1), std::min(y, heights.height() - 1));
}

std::vector<Image> texture_levels(const BumpTexels& texels) {
    const std::vector<BumpLevel> bumps = bump_levels(texels.slopes);
    const std::vector<Image> heights = detail::area_levels(texels.heights);
    std::vector<Image> levels;
    for (std::size_t i = 0; i < bumps.size(); ++i) {
        const BumpLevel& bump = bumps[i];
        const Image& height = heights[std::min(i, heights.size() - 1)];
        Image& level = levels.emplace_back(bump.mean.width(), bump.mean.height(), 4);
        for (int y = 0; y < level.height(); ++y)
            for (int x = 0; x < level.width(); ++x) {
                float* texel = level.at(x, y);
                std::copy_n(bump.mean.at(x, y), 2, texel);
                texel[2] = static_cast<float>(covariance(bump, x, y).mean());
                texel[3] = height_at(height, x, y);
            }
    }
    return levels;
}

Texture make(const BumpTexels& texels, Wrap wrap) {
    Texture texture = upload(texture_levels(texels));
    glTexParameteri(texture.target, GL_TEXTURE_WRAP_S, wrap_mode(wrap));
    glTexParameteri(texture.target, GL_TEXTURE_WRAP_T, wrap_mode(wrap));
    return texture;
}

}  // namespace

void BumpTextures::set_assets(std::shared_ptr<const SceneAssets> assets) {
    std::erase_if(kept_, [&](const auto& kept) {
        return !is_same(assets_->bumps, assets->bumps, kept.first);
    });
    assets_ = std::move(assets);
}

const Texture& BumpTextures::get(const BumpMap& bump, double time) {
    const double moment = moves(bump) ? time : 0;
    const std::string key = bump_key(bump);
    const auto found = kept_.find(key);
    if (found != kept_.end() && found->second.time == moment) return found->second.texture;
    Kept kept{moment, make(*bump_texels(bump, *assets_, time), bump.wrap)};
    return kept_.insert_or_assign(key, std::move(kept)).first->second.texture;
}

}  // namespace mirrorball::gl
