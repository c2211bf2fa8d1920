// What a renderer keeps from picture to picture must not show.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "gl/target.h"
#include "gl_test.h"

namespace mirrorball::gl {
namespace {

class KeptMapsTest : public GlTest {};

Scene glossy_scene(double roughness, Method method = Method::cube) {
    Material material = full_material();
    material.lobe = {Lobe::Kind::ggx, roughness};
    return scene_with("torus", material, method);
}

Image seen(Renderer& renderer, const Scene& scene) {
    return radiance(renderer, scene, 48, 32);
}

bool same_bits(const Image& a, const Image& b) {
    return std::equal(a.values().begin(), a.values().end(), b.values().begin(), b.values().end());
}

double mean_difference(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.values().size(); ++i)
        sum += std::abs(a.values()[i] - b.values()[i]);
    return sum / static_cast<double>(a.values().size());
}

// A slider goes away and comes back.
TEST_F(KeptMapsTest, PicturesDoNotDependOnThoseBefore) {
    const auto assets = assets_in(builtin_environment("sunset"));
    for (const Method method : {Method::cube, Method::sphere, Method::cube_split}) {
        Renderer renderer(assets);
        const Scene scene = glossy_scene(0.4, method);
        const Image first = seen(renderer, scene);
        const std::uint64_t bytes = renderer.map_bytes(scene);
        for (const double roughness : {0.5, 0.31, 0.9})
            EXPECT_FALSE(same_bits(seen(renderer, glossy_scene(roughness, method)), first));
        EXPECT_TRUE(same_bits(seen(renderer, scene), first)) << name(method);
        EXPECT_EQ(renderer.map_bytes(scene), bytes) << name(method);
        Renderer fresh(assets);
        EXPECT_TRUE(same_bits(seen(fresh, scene), first)) << name(method);
    }
}

TEST_F(KeptMapsTest, NorOnOtherMethods) {
    const auto assets = assets_in(builtin_environment("sunset"));
    Renderer renderer(assets);
    std::vector<Image> first;
    for (const Method method : all_methods())
        first.push_back(seen(renderer, glossy_scene(0.4, method)));
    for (std::size_t i = first.size(); i-- > 0;) {
        const Scene scene = glossy_scene(0.4, all_methods()[i]);
        EXPECT_TRUE(same_bits(seen(renderer, scene), first[i])) << name(scene.method);
    }
}

// On a screen, linear light.
Image drawn(Renderer& renderer, const Scene& scene, bool quick) {
    const Target target(48, 32);
    target.bind();
    renderer.draw(scene, target.width(), target.height(), {.quick = quick});
    return target.read(3);
}

// Large maps are half as fine in pictures that the next one replaces, and in no other.
TEST_F(KeptMapsTest, QuickPicturesLeaveNoCoarseMaps) {
    const auto assets = assets_in(builtin_environment("studio", 1024));
    for (const Method method :
         {Method::cube, Method::sphere, Method::cube_split, Method::octahedral}) {
        const Scene scene = glossy_scene(0.2, method);
        Renderer fresh(assets), renderer(assets);
        const Image exact = drawn(fresh, scene, false);
        const Image quick = drawn(renderer, scene, true);
        EXPECT_FALSE(same_bits(quick, exact)) << name(method);
        EXPECT_LT(mean_difference(quick, exact), 0.5 / 255) << name(method);
        EXPECT_TRUE(same_bits(drawn(renderer, scene, true), quick)) << name(method);
        EXPECT_TRUE(same_bits(drawn(renderer, scene, false), exact)) << name(method);
        EXPECT_TRUE(same_bits(drawn(renderer, scene, true), exact)) << "it is there";
        EXPECT_TRUE(same_bits(drawn(renderer, glossy_scene(0.3, method), true),
                              drawn(fresh, glossy_scene(0.3, method), false)))
            << "it was not large";
    }
}

// A scene that turns its environment shows what one in the turned environment does, and turning
// back the same bits.
TEST_F(KeptMapsTest, TurnedEnvironmentsNeedNoNewMaps) {
    const auto assets = assets_in(smooth_environment());
    for (const Method method : all_methods()) {
        Renderer renderer(assets);
        const Scene straight = glossy_scene(0.4, method);
        const Image first = seen(renderer, straight);
        Scene turning = straight;
        turning.environment.yaw = 0.7, turning.environment.pitch = -0.4;
        turning.environment.roll = 0.2;
        const Image turned_scene = seen(renderer, turning);

        auto turned_assets = std::make_shared<SceneAssets>(*assets);
        Axes& axes = turned_assets->environment.axes;
        axes = turned(axes, turning.environment);
        Renderer other(turned_assets);
        const Image turned_map = seen(other, straight);
        EXPECT_GT(mean_difference(turned_scene, first), 0.05) << name(method);
        // Those that split or interpolate polygons do it elsewhere.
        EXPECT_LT(mean_difference(turned_scene, turned_map), 0.006) << name(method);
        EXPECT_TRUE(same_bits(seen(renderer, straight), first)) << name(method);
    }
}

TEST_F(KeptMapsTest, NewAssetsAreThoseOfANewRenderer) {
    const auto assets = assets_in(builtin_environment("sunset"));
    Renderer renderer(assets);
    const Scene scene = glossy_scene(0.4);
    const Image first = seen(renderer, scene);

    auto studio = std::make_shared<SceneAssets>(*assets);
    studio->environment = builtin_environment("studio");
    renderer.set_assets(studio);
    Renderer in_studio(studio);
    EXPECT_TRUE(same_bits(seen(renderer, scene), seen(in_studio, scene)));

    auto cube = std::make_shared<SceneAssets>(*studio);
    cube->meshes["torus"] = make_mesh("cube", 4);
    renderer.set_assets(cube);
    Renderer with_cube(cube);
    EXPECT_TRUE(same_bits(seen(renderer, scene), seen(with_cube, scene)));

    renderer.set_assets(assets);
    EXPECT_TRUE(same_bits(seen(renderer, scene), first));
}

}  // namespace
}  // namespace mirrorball::gl
