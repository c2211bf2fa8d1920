// Maps that were baked beforehand are looked up in the place of those that a renderer makes.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mirrorball/baked_maps.h>
#include <mirrorball/error.h>
#include <mirrorball/prefilter.h>

#include "gl_test.h"

namespace mirrorball::gl {
namespace {

class BakedMapsTest : public GlTest {};

Lobe ggx(double roughness) {
    return {Lobe::Kind::ggx, roughness, nullptr};
}
Lobe phong(double exponent) {
    return {Lobe::Kind::phong, exponent, nullptr};
}

PrefilterTarget cube_target(const Lobe& lobe, int size) {
    return {lobe, Projection::cube, size, default_axes(Projection::cube)};
}

EnvironmentMap uniform(const Lobe& lobe, int size, const Vec3f& light) {
    EnvironmentMap map = make_environment_map(Projection::cube, size);
    map.levels[0].lobe = lobe;
    for (Image& face : map.levels[0].faces)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) face.set_rgb(x, y, light);
    return map;
}

// A chain as bake has it, each level of half the size of the one before.
EnvironmentMap chain(const EnvironmentMap& environment, std::initializer_list<double> roughnesses,
                     int size) {
    EnvironmentMap map{Projection::cube, default_axes(Projection::cube), {}};
    LobeFilter filter(std::make_shared<EnvironmentMap>(environment));
    for (const double roughness : roughnesses) {
        map.levels.push_back(filter(cube_target(ggx(roughness), size)).levels[0]);
        map.levels.back().lobe = ggx(roughness);
        size /= 2;
    }
    return map;
}

Material glossy(const Lobe& lobe) {
    Material material = mirror_material();
    material.mirror = 0;
    material.glossy = 1;
    material.lobe = lobe;
    return material;
}

Scene sphere_of(const Material& material) {
    Scene scene = scene_with("sphere", material, Method::cube);
    scene.environment.background = false;
    return scene;
}

// Of colours that nothing in the environment has, so that none of it can come from there.
std::shared_ptr<SceneAssets> assets_of_other_colours() {
    const auto assets = assets_in(smooth_environment());
    assets->baked = std::make_shared<BakedMaps>(
        std::vector{uniform(ggx(0.2), 8, {50, 0, 0}), uniform(ggx(0.6), 4, {0, 50, 0}),
                    uniform(phong(10), 4, {0, 0, 50}), uniform(phong(1000), 8, {0, 50, 50}),
                    uniform({Lobe::Kind::diffuse}, 4, {50 * static_cast<float>(kPi), 0, 0})});
    return assets;
}

Vec3f middle(Renderer& renderer, const Material& material) {
    return radiance(renderer, sphere_of(material), 32, 32).rgb(16, 16);
}

void expect_light(const Vec3f& light, const Vec3f& expected) {
    // Maps are stored as half floats: 11 bits.
    EXPECT_LT((light - expected).length(), 50 * 0.001f) << light << " and not " << expected;
}

TEST_F(BakedMapsTest, WhatIsDrawnComesFromThem) {
    Renderer renderer(assets_of_other_colours());
    expect_light(middle(renderer, glossy(ggx(0.2))), {50, 0, 0});
    expect_light(middle(renderer, glossy(ggx(0.6))), {0, 50, 0});
    expect_light(middle(renderer, glossy(phong(10))), {0, 0, 50});
    expect_light(middle(renderer, diffuse_material()), {50, 0, 0});
}

TEST_F(BakedMapsTest, BetweenLevelsLightIsMixed) {
    Renderer renderer(assets_of_other_colours());
    expect_light(middle(renderer, glossy(ggx(0.3))), {37.5f, 12.5f, 0});
    expect_light(middle(renderer, glossy(phong(100))), {0, 25, 50});
    // Beyond the first and the last there is nothing to mix with.
    expect_light(middle(renderer, glossy(ggx(0.1))), {50, 0, 0});
    expect_light(middle(renderer, glossy(ggx(1))), {0, 50, 0});
    expect_light(middle(renderer, glossy(phong(1e5))), {0, 50, 50});
}

// By whichever method: maps of other projections are resampled.
TEST_F(BakedMapsTest, EveryMethodTakesThem) {
    Renderer renderer(assets_of_other_colours());
    for (const Method method : all_methods()) {
        Scene scene = sphere_of(glossy(ggx(0.6)));
        scene.method = method;
        const Vec3f light = radiance(renderer, scene, 32, 32).rgb(16, 16);
        EXPECT_LT((light - Vec3f(0, 50, 0)).length(), 0.05f) << name(method);
    }
}

TEST_F(BakedMapsTest, MirrorsAndTheBackgroundShowTheEnvironment) {
    const auto plain = assets_in(smooth_environment());
    Renderer baked(assets_of_other_colours()), without(plain);
    const Scene scene = scene_with("sphere", mirror_material(), Method::cube);
    const Image a = radiance(baked, scene, 32, 32), b = radiance(without, scene, 32, 32);
    EXPECT_TRUE(std::equal(a.values().begin(), a.values().end(), b.values().begin()));
}

// At a level the picture is that of the renderer's own map of that lobe.
TEST_F(BakedMapsTest, ALevelIsThePictureOfThatLobe) {
    const EnvironmentMap& environment = builtin_environment("studio", 256);
    const auto exact = assets_in(environment);
    const auto baked = std::make_shared<SceneAssets>(*exact);
    baked->baked = std::make_shared<BakedMaps>(std::vector{
        chain(environment, {0.25, 0.5, 0.75, 1}, 128), uniform({Lobe::Kind::diffuse}, 4, {})});
    Renderer a(exact), b(baked);
    for (const double roughness : {0.25, 0.5, 0.75, 1.0}) {
        const Scene scene = sphere_of(glossy(ggx(roughness)));
        const Image first = radiance(a, scene, 64, 64), second = radiance(b, scene, 64, 64);
        double most = 0, brightest = 0;
        for (std::size_t i = 0; i < first.values().size(); ++i) {
            most = std::max<double>(most, std::abs(first.values()[i] - second.values()[i]));
            brightest = std::max<double>(brightest, first.values()[i]);
        }
        // Their sizes differ: what bilinear lookup makes of 16 texels to a radian, or of fewer.
        EXPECT_LT(most, 0.015 * brightest) << roughness;
    }
}

TEST_F(BakedMapsTest, NewOnesTakeThePlaceOfTheOld) {
    const auto first = assets_of_other_colours();
    Renderer renderer(first);
    expect_light(middle(renderer, glossy(ggx(0.6))), {0, 50, 0});
    const auto second = std::make_shared<SceneAssets>(*first);
    second->baked = std::make_shared<BakedMaps>(
        std::vector{uniform(ggx(0.6), 4, {0, 0, 25}), uniform({Lobe::Kind::diffuse}, 4, {})});
    renderer.set_assets(second);
    expect_light(middle(renderer, glossy(ggx(0.6))), {0, 0, 25});
}

TEST_F(BakedMapsTest, ALobeOfNoKindThatWasBakedIsRefused) {
    Renderer renderer(assets_of_other_colours());
    try {
        middle(renderer, glossy({Lobe::Kind::charlie, 0.5, nullptr}));
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::usage);
        EXPECT_THAT(error.what(), testing::HasSubstr("charlie:0.5"));
    }
}

}  // namespace
}  // namespace mirrorball::gl
