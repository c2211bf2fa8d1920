#include "shown_maps.h"

#include <cmath>
#include <utility>

#include <mirrorball/prefilter.h>
#include <mirrorball/reflection_maps.h>
#include <mirrorball/tone_map.h>

#include "io/codec.h"

namespace mirrorball {
namespace {

// Of cubes, whose texels are alike.
constexpr int kSmallFace = 128, kBlurredFace = 32;

std::uint8_t code(float linear) {
    return static_cast<std::uint8_t>(std::lround(detail::linear_to_srgb(linear) * 255));
}

ScreenPicture on_screen(const Image& light, double exposure, ToneMap tone_map) {
    ScreenPicture picture{light.width(), light.height(), {}, 0};
    picture.rgba.reserve(static_cast<std::size_t>(light.texel_count()) * 4);
    for (int y = 0; y < light.height(); ++y) {
        for (int x = 0; x < light.width(); ++x) {
            const Vec3f color = tone_mapped(light.rgb(x, y), exposure, tone_map);
            for (const float channel : {color.x, color.y, color.z})
                picture.rgba.push_back(code(channel));
            picture.rgba.push_back(light.at(x, y)[3] > 0 ? 255 : 0);
        }
    }
    return picture;
}

}  // namespace

void ShownMaps::set_environment(const EnvironmentMap& environment) {
    const int face = std::min(kSmallFace, mirror_map_size(environment, Projection::cube));
    small_ = std::make_shared<const EnvironmentMap>(
        make_mirror_map(environment, Projection::cube, face, environment.axes));
    filter_.emplace(small_);
    diffuse_.reset(), glossy_.reset();
    kept_.clear();
}

EnvironmentMap ShownMaps::blurred(const Lobe& lobe) {
    return (*filter_)({lobe, Projection::cube, kBlurredFace, small_->axes});
}

const EnvironmentMap& ShownMaps::map(MapContent content, const Lobe& lobe) {
    switch (content) {
        case MapContent::diffuse:
            if (!diffuse_) diffuse_ = blurred({Lobe::Kind::diffuse});
            return *diffuse_;
        case MapContent::glossy:
            if (!glossy_ || !(glossy_->first == lobe)) glossy_.emplace(lobe, blurred(lobe));
            return glossy_->second;
        case MapContent::environment:
            break;
    }
    return *small_;
}

const ScreenPicture& ShownMaps::picture(MapContent content, Projection projection, int height,
                                        const Look& look) {
    Kept& kept = kept_[{content, projection, height}];
    if (!kept.picture.rgba.empty() && kept.look == look) return kept.picture;
    EnvironmentMap turned = map(content, look.lobe);
    turned.axes = look.environment;
    // As bright as a white surface that receives it.
    const double exposure = content == MapContent::diffuse ? look.exposure / kPi : look.exposure;
    kept = {look,
            on_screen(map_picture(turned, projection, look.axes, height), exposure, look.tone_map)};
    kept.picture.version = ++last_version_;
    return kept.picture;
}

}  // namespace mirrorball
