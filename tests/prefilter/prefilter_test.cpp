// Prefiltering against closed forms, and the fast way against the brute-force truth.
#include <mirrorball/prefilter.h>

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <mirrorball/compare.h>
#include <mirrorball/io.h>
#include <tbb/global_control.h>

#include "support.h"
#include "synthetic.h"

namespace mirrorball {
namespace {

PrefilterTarget target(const char* lobe, int size = 8, Projection projection = Projection::cube) {
    return {parse_lobe(lobe), projection, size, default_axes(projection)};
}

EnvironmentMap fast(const EnvironmentMap& source, const PrefilterTarget& target) {
    return prefilter(source, std::span(&target, 1))[0];
}

const char* const kLobes[] = {"diffuse",         "phong:10",    "phong:100", "phong:1000",
                              "blinn-phong:400", "ggx:0.25",    "ggx:0.5",   "ggx:0.75",
                              "ggx:1",           "charlie:0.3", "charlie:1"};

// lambda_1 / lambda_0: how much of a linear ramp a lobe lets through. By quadrature where there is
// no closed form.
double first_order(const Lobe& lobe) {
    if (lobe.kind == Lobe::Kind::diffuse) return 2.0 / 3;
    if (lobe.kind == Lobe::Kind::phong) return (lobe.parameter + 1) / (lobe.parameter + 2);
    double sum = 0;
    constexpr int count = 200000;
    for (int i = 0; i < count; ++i) {
        const double x = (i + 0.5) / count, theta = kPi / 2 * x * x;
        sum += lobe.value(std::cos(theta)) * std::cos(theta) * 2 * kPi * std::sin(theta) * kPi * x /
               count;
    }
    return sum;
}

TEST(Prefilter, LinearRampsComeOutByFunkHecke) {
    const Vec3d slope(0.3, -0.5, 0.4);
    const auto ramp = [&](const Vec3d& d) { return Vec3d(1 + slope.dot(d)); };
    const EnvironmentMap source = averaged(Projection::equirect, 256, ramp);
    for (const char* text : kLobes) {
        const Lobe lobe = parse_lobe(text);
        const double through = first_order(lobe);
        const EnvironmentMap expected = sampled(Projection::cube, 8, [&](const Vec3d& r) {
            return Vec3d(lobe.integral() * (1 + through * slope.dot(r)));
        });
        // the sum over 256 x 128 texels, against the integral: 2.8e-4 measured, for the narrowest
        EXPECT_LT(compare(prefilter_reference(source, target(text)), expected).maximum_relative,
                  5e-4)
            << text;
        EXPECT_LT(compare(fast(source, target(text)), expected).maximum_relative, 4e-3) << text;
    }
}

TEST(Prefilter, OneLitTexelBecomesTheLobe) {
    EnvironmentMap source = make_environment_map(Projection::equirect, 256);
    source.levels[0].faces[0].set_rgb(200, 40, {1e5f, 5e4f, 1.0f});
    const Vec3d light = Equirect::direction(FacePoint<double>{0, 200.5 / 256, 40.5 / 128});
    const double solid_angle = solid_angle_table(Projection::equirect, 256, 128)[40 * 256 + 200];
    for (const char* text : kLobes) {
        const Lobe lobe = parse_lobe(text);
        const EnvironmentMap expected = sampled(Projection::cube, 8, [&](const Vec3d& r) {
            return Vec3d(1e5, 5e4, 1) * (lobe.value(r.dot(light)) * solid_angle);
        });
        // dividing by the weights' sum instead of the integral is all the difference there is
        EXPECT_LT(compare(prefilter_reference(source, target(text)), expected).relative_rmse, 1e-3)
            << text;
        EXPECT_LT(compare(fast(source, target(text)), expected).relative_rmse, 4e-3) << text;
    }
}

TEST(Prefilter, UniformLightStaysUniform) {
    for (const Projection from : {Projection::equirect, Projection::cube, Projection::sphere}) {
        const EnvironmentMap source =
            sampled(from, 32, [](const Vec3d&) { return Vec3d(0.5, 1, 3e4); });
        for (const char* text :
             {"diffuse", "phong:20", "phong:10000000", "ggx:0.001", "ggx:0.6", "mirror"}) {
            const double scale = parse_lobe(text).integral();
            for (const bool reference : {true, false}) {
                const EnvironmentMap map = reference ? prefilter_reference(source, target(text, 4))
                                                     : fast(source, target(text, 4));
                const LevelStatistics s = statistics(map);
                EXPECT_NEAR(s.minimum.z / (3e4 * scale), 1, 1e-6) << text;
                EXPECT_NEAR(s.maximum.x / (0.5 * scale), 1, 1e-6) << text;
                EXPECT_EQ(map.levels[0].lobe, parse_lobe(text));
            }
        }
    }
}

EnvironmentMap sun_over_dim_sky() {
    return averaged(Projection::equirect, 256, [](const Vec3d& d) {
        const Vec3d sun = Vec3d(0.6, 0.35, -0.72).normalized();
        if (d.dot(sun) > std::cos(0.03)) return Vec3d(1e4, 9e3, 7e3);
        return Vec3d(0.2, 0.3, 0.5) * (1 + d.y) + Vec3d(0.05);
    });
}

EnvironmentMap noise() {
    std::mt19937 random(23);
    std::uniform_real_distribution<double> uniform;
    return sampled(Projection::cube, 48, [&](const Vec3d&) {
        return Vec3d(uniform(random), uniform(random), uniform(random));
    });
}

void expect_fast_near_truth(const EnvironmentMap& source, const char* what) {
    for (const char* text : kLobes) {
        const Difference d =
            compare(fast(source, target(text)), prefilter_reference(source, target(text)));
        EXPECT_LT(d.relative_rmse, 2.5e-3) << what << " " << text;
        // the largest stands where only the crease at a lobe's horizon sees a light
        EXPECT_LT(d.maximum_relative, 6e-2) << what << " " << text;
    }
}

TEST(Prefilter, FastIsNearTheTruth) {
    expect_fast_near_truth(sun_over_dim_sky(), "sun over dim sky");
    expect_fast_near_truth(noise(), "noise");
}

TEST(Prefilter, FastIsNearTheTruthOnRealPanoramas) {
    const auto path = shared_file("hdri/studio.hdr");
    if (!path) GTEST_SKIP() << "shared/hdri/studio.hdr is not beside the repository";
    const EnvironmentMap source = read_map(path->string()).map;
    for (const char* text : {"diffuse", "phong:100", "ggx:0.25", "ggx:0.5"}) {
        const Difference d =
            compare(fast(source, target(text, 4)), prefilter_reference(source, target(text, 4)));
        // 3.0e-3 measured for ggx:0.25, under lamps of 3500 times the mean
        EXPECT_LT(d.relative_rmse, 4e-3) << text;
    }
}

TEST(Prefilter, EveryProjectionInAndOutGivesTheSame) {
    const EnvironmentMap expected =
        prefilter_reference(averaged(Projection::equirect, 128, smooth_light),
                            target("ggx:0.5", 64, Projection::equirect));
    for (std::size_t i = 0; i < kProjectionCount; ++i) {
        const auto projection = static_cast<Projection>(i);
        const EnvironmentMap source = averaged(projection, size_for(projection, 128), smooth_light);
        const EnvironmentMap map =
            prefilter_reference(source, target("ggx:0.5", 64, Projection::equirect));
        // a sphere map's rim is coarse: 5e-3 measured; all others are below 1e-3
        EXPECT_LT(compare(map, expected).maximum_relative,
                  projection == Projection::sphere ? 1e-2 : 2e-3)
            << name(projection);
        const int size = size_for(projection, 64);
        const EnvironmentMap there = prefilter_reference(
            averaged(Projection::equirect, 128, smooth_light), target("ggx:0.5", size, projection));
        for (int k = 0; k < 50; ++k) {
            const Vec3d d =
                Vec3d(std::cos(k * 2.4), std::sin(k * 0.9), std::cos(k * 1.7 + 1)).normalized();
            const auto read = [&](const EnvironmentMap& m) {
                return visit(m.projection, [&](auto p) {
                    const auto at = decltype(p)::project(m.axes.to_map(d));
                    return m.levels[0].faces[at.face].rgb(
                        std::min(static_cast<int>(at.s * m.width()), m.width() - 1),
                        std::min(static_cast<int>(at.t * m.height()), m.height() - 1));
                });
            };
            // nearest texels, up to half a texel of 1/64 turn (more near a sphere map's rim) apart
            if (projection == Projection::sphere && d.z < -0.7) continue;
            EXPECT_NEAR(read(there).y, read(expected).y, 0.06) << name(projection) << " " << d;
        }
    }
}

TEST(Prefilter, SameBitsOnAnyNumberOfThreads) {
    const EnvironmentMap source = noise();
    for (const bool reference : {true, false}) {
        const auto run = [&] {
            const PrefilterTarget t = target("ggx:0.4", 6);
            return reference ? prefilter_reference(source, t) : fast(source, t);
        };
        const EnvironmentMap expected = run();
        for (const int threads : {1, 2, 3, 7}) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            const EnvironmentMap map = run();
            for (int face = 0; face < 6; ++face) {
                const auto a = map.levels[0].faces[face].values();
                const auto b = expected.levels[0].faces[face].values();
                ASSERT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end())) << threads;
            }
        }
    }
}

}  // namespace
}  // namespace mirrorball
