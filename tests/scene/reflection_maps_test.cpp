#include <mirrorball/reflection_maps.h>

#include <gtest/gtest.h>

#include <cmath>

#include <mirrorball/builtin.h>
#include <mirrorball/compare.h>
#include <mirrorball/prefilter.h>

#include "synthetic.h"

namespace mirrorball {
namespace {

const std::vector<Lobe> kLobes = {
    {Lobe::Kind::phong, 50}, {Lobe::Kind::ggx, 0.4}, {Lobe::Kind::phong, 50}};

TEST(ReflectionMaps, OneMapForEachLobe) {
    const EnvironmentMap sky =
        make_builtin("sunset", Projection::equirect, 128, default_axes(Projection::equirect));
    const ReflectionMaps maps = make_reflection_maps(sky, kLobes, Projection::octahedral, 64,
                                                     default_axes(Projection::octahedral));
    ASSERT_EQ(maps.lobes.size(), 2u);
    ASSERT_EQ(maps.glossy.size(), 2u);
    EXPECT_EQ(maps.index_of(kLobes[1]), 1u);
    EXPECT_EQ(maps.mirror.level_count(), 7);
    for (const EnvironmentMap* map :
         {&maps.mirror, &maps.glossy[0], &maps.glossy[1], &maps.diffuse}) {
        EXPECT_EQ(map->projection, Projection::octahedral);
        // Blurring keeps the flux; the cosine's integral is pi. The maps hold values at texel
        // centres, of which a sum is no integral: off by texels squared, at 32 of them 3e-3.
        const Vec3d expected = flux(sky) * (map == &maps.diffuse ? kPi : 1);
        EXPECT_NEAR(flux(*map).y / expected.y, 1, 4e-3);
    }
}

TEST(ReflectionMaps, UniformLightStaysUniform) {
    const EnvironmentMap white =
        sampled(Projection::cube, 16, [](const Vec3d&) { return Vec3d(1); });
    const ReflectionMaps maps =
        make_reflection_maps(white, kLobes, Projection::cube, 32, default_axes(Projection::cube));
    for (int level = 0; level < maps.mirror.level_count(); ++level)
        EXPECT_NEAR(maps.mirror.levels[level].faces[2].rgb(0, 0).y, 1, 1e-6);
    EXPECT_NEAR(maps.glossy[1].levels[0].faces[3].rgb(1, 2).x, 1, 1e-5);
    EXPECT_NEAR(maps.diffuse.levels[0].faces[3].rgb(1, 2).x, kPi, 1e-5);
}

// The second derivative of the lobe about a point of light against a texel's width, which is what
// bilinear lookup is off by: h^2/8 along each axis.
TEST(ReflectionMaps, SizesSuitTheLobes) {
    for (const Lobe& lobe : {Lobe{Lobe::Kind::phong, 10}, Lobe{Lobe::Kind::phong, 1000},
                             Lobe{Lobe::Kind::ggx, 0.3}, Lobe{Lobe::Kind::ggx, 0.7}}) {
        const double h = 2.0 / glossy_map_size(lobe, Projection::cube), step = 1e-3 * h;
        const double curvature =
            2 * (lobe.value(1) - lobe.value(std::cos(10 * step))) / (100 * step * step);
        EXPECT_LT(2 * curvature * h * h / 8 / lobe.value(1), 0.015) << to_string(lobe);
    }
    EXPECT_EQ(glossy_map_size({Lobe::Kind::mirror}, Projection::cube), 1024);
    EXPECT_EQ(glossy_map_size({Lobe::Kind::phong, 1}, Projection::equirect) % 4, 0);
    EXPECT_LE(glossy_map_size({Lobe::Kind::charlie, 0.01}, Projection::cube), 1024);
}

TEST(ReflectionMaps, MirrorAsFineAsTheEnvironment) {
    const EnvironmentMap sky = make_environment_map(Projection::equirect, 1000);
    EXPECT_EQ(mirror_map_size(sky, Projection::cube), 256);
    EXPECT_EQ(mirror_map_size(sky, Projection::octahedral), 512);
    EXPECT_EQ(mirror_map_size(make_environment_map(Projection::cube, 64), Projection::equirect),
              256);
}

TEST(ReflectionMaps, LobesOfASceneAreThoseThatAreSeen) {
    Scene scene;
    scene.objects.resize(3);
    scene.objects[0].material.glossy = 0.5;
    scene.objects[1].material.lobe = {Lobe::Kind::phong, 7};
    scene.objects[2].material.glossy = 0.5;
    EXPECT_EQ(lobes_of(scene), std::vector<Lobe>{scene.objects[0].material.lobe});
}

}  // namespace
}  // namespace mirrorball
