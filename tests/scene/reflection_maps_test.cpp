#include <mirrorball/reflection_maps.h>

#include <gtest/gtest.h>

#include <cmath>

#include <mirrorball/builtin.h>
#include <mirrorball/compare.h>
#include <mirrorball/lookup.h>
#include <mirrorball/prefilter.h>
#include <mirrorball/projections/cube.h>

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

// What lookups between the levels of the rough maps are off by, in the root mean square over that
// of what there is, and at the brightest over that.
struct RoughError {
    double rms, largest;
};

RoughError rough_error(const ReflectionMaps& maps, const EnvironmentMap& exact, double alpha) {
    double error = 0, light = 0, largest = 0, brightest = 0;
    const std::vector<double> areas =
        solid_angle_table(exact.projection, exact.width(), exact.height());
    for (int face = 0; face < Cube::face_count; ++face) {
        for (int y = 0; y < exact.height(); ++y) {
            for (int x = 0; x < exact.width(); ++x) {
                const FacePoint<double> centre{face, (x + 0.5) / exact.width(),
                                               (y + 0.5) / exact.height()};
                const Vec3d d = exact.axes.to_world(Cube::direction(centre));
                const Vec3f truth = exact.levels[0].faces[face].rgb(x, y);
                const Vec3f off = look_up_rough(maps, d, alpha) - truth;
                const double area = areas[static_cast<std::size_t>(y) * exact.width() + x];
                error += area * off.length2();
                light += area * truth.length2();
                largest = std::max(largest, static_cast<double>(off.length()));
                brightest = std::max(brightest, static_cast<double>(truth.length()));
            }
        }
    }
    return {std::sqrt(error / light), largest / brightest};
}

ReflectionMaps rough_maps(const EnvironmentMap& sky, Projection projection) {
    return make_reflection_maps(sky, {}, projection, mirror_map_size(sky, projection),
                                default_axes(projection), {.rough = true});
}

// GGX is exact at the levels but for the texels' own interpolation. Between two of them, each the
// blur of half the other's alpha, what lights leave is met at its peak and a few percent too wide
// around it. Between the finest and the mirror there is no blur at all on one side.
TEST(ReflectionMaps, RoughOnesServeEveryAlpha) {
    struct Case {
        const char* sky;
        double between, below_finest;
    };
    for (const Case& c : {Case{"sunset", 0.085, 0.4}, Case{"studio", 0.05, 0.1}}) {
        const EnvironmentMap sky =
            make_builtin(c.sky, Projection::equirect, 256, default_axes(Projection::equirect));
        const ReflectionMaps maps = rough_maps(sky, Projection::cube);
        ASSERT_EQ(maps.rough.level_count(), 6);
        EXPECT_EQ(maps.rough.width(), 256);
        EXPECT_EQ(maps.rough.levels[5].lobe, (Lobe{Lobe::Kind::ggx, 1}));
        std::vector<double> alphas;
        std::vector<PrefilterTarget> targets;
        for (double alpha = 1; alpha > 0.007; alpha /= std::exp2(0.5)) {
            alphas.push_back(alpha);
            targets.push_back({{Lobe::Kind::ggx, std::sqrt(alpha)}, Projection::cube, 32, {}});
        }
        for (PrefilterTarget& target : targets) target.axes = maps.mirror.axes;
        const std::vector<EnvironmentMap> exact = prefilter(sky, targets);
        for (std::size_t i = 0; i < alphas.size(); ++i) {
            const RoughError error = rough_error(maps, exact[i], alphas[i]);
            const bool at_level = i % 2 == 0 && alphas[i] > 0.03, below = alphas[i] < 0.031;
            // Next to alpha 1 there is a kink at the horizon, that texels of the last level round.
            const double tolerance = i == 0     ? 0.015
                                     : at_level ? 0.006
                                     : below    ? c.below_finest
                                                : c.between;
            EXPECT_LT(error.rms, tolerance) << c.sky << " " << alphas[i];
            if (!below) {
                EXPECT_LT(error.largest, 0.12) << c.sky << " " << alphas[i];
            }
        }
    }
}

TEST(ReflectionMaps, RoughOnesBeginAtTheMirror) {
    const EnvironmentMap sky = sampled(Projection::equirect, 128, smooth_light);
    const ReflectionMaps maps = rough_maps(sky, Projection::octahedral);
    const Vec3d d(0.3, -0.5, 0.7);
    const double sharp = mirror_alpha(32);
    EXPECT_EQ(look_up_rough(maps, d, 0), look_up(maps.mirror, d));
    EXPECT_EQ(look_up_rough(maps, d, sharp), look_up(maps.mirror, d));
    EXPECT_EQ(look_up_rough(maps, d, 1), look_up(maps.rough, d, maps.rough.level_count() - 1));
    EXPECT_EQ(look_up_rough(maps, d, 3), look_up_rough(maps, d, 1));
}

// Nowhere is there a step: neither where levels meet nor where the mirror begins.
TEST(ReflectionMaps, RoughPlacesAreContinuous) {
    constexpr int kLevels = 6;
    const double finest = std::exp2(1 - kLevels), sharp = mirror_alpha(64);
    for (int level = 0; level < kLevels; ++level) {
        const double alpha = finest * std::exp2(level);
        EXPECT_DOUBLE_EQ(rough_place(alpha, kLevels, sharp).lod, level);
        EXPECT_NEAR(rough_place(alpha * (1 - 1e-9), kLevels, sharp).lod, level, 1e-8);
    }
    EXPECT_NEAR(rough_place(finest * (1 - 1e-9), kLevels, sharp).share, 1, 1e-8);
    EXPECT_NEAR(rough_place(sharp * (1 + 1e-9), kLevels, sharp).share, 0, 1e-8);
    EXPECT_EQ(rough_place(0, kLevels, sharp).share, 0);
    // A mirror's map coarser than the finest level.
    EXPECT_NEAR(rough_place(finest * (1 - 1e-9), kLevels, mirror_alpha(4)).share, 1, 1e-8);
    double before = 0;
    for (double alpha = 1e-3; alpha < 1.2; alpha *= 1.01) {
        const RoughPlace place = rough_place(alpha, kLevels, sharp);
        EXPECT_GE(place.share + place.lod, before);
        before = place.share + place.lod;
    }
}

TEST(ReflectionMaps, RoughOnesOfUniformLightAreUniform) {
    const EnvironmentMap white =
        sampled(Projection::cube, 16, [](const Vec3d&) { return Vec3d(1); });
    const ReflectionMaps maps = rough_maps(white, Projection::equirect);
    for (const double alpha : {0.0, 0.02, 0.1, 0.3, 0.7, 1.0})
        EXPECT_NEAR(look_up_rough(maps, {0.1, 0.9, -0.3}, alpha).y, 1, 2e-5) << alpha;
}

TEST(ReflectionMaps, NoRoughOnesUnlessAskedFor) {
    const EnvironmentMap white =
        sampled(Projection::cube, 16, [](const Vec3d&) { return Vec3d(1); });
    const Axes axes = default_axes(Projection::cube);
    EXPECT_EQ(make_reflection_maps(white, {}, Projection::cube, 16, axes).rough.level_count(), 0);
}

}  // namespace
}  // namespace mirrorball
