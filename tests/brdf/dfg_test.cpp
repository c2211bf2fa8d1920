// DFG tables against integrals of another kind: over directions of light, not half vectors, with
// the BRDFs of brdf.h; against closed forms; and against themselves at any number of threads.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cmath>

#include <mirrorball/brdf.h>
#include <mirrorball/dfg.h>
#include <mirrorball/error.h>

#include "prefilter/gauss_legendre.h"

namespace mirrorball {
namespace {

// The integral of f(wi, wo) wi.z over the hemisphere of wi, in panels of 16 Gauss points: 24 over
// the angle to the normal, 12 over the azimuth, which are narrower towards the mirror direction.
// With twice as many panels it changes by less than 1e-8 where the roughness is 0.25 or more.
Vec3d furnace(const Brdf& brdf, double n_dot_v) {
    constexpr int kThetaPanels = 24, kAzimuthPanels = 12;
    const Vec3d wo(-std::sqrt(1 - n_dot_v * n_dot_v), 0, n_dot_v);
    Vec3d sum(0);
    const auto panels = [](int count, auto&& f) {
        for (int i = 0; i < count; ++i)
            for (const auto& [x, weight] : detail::gauss_legendre(16))
                f((i + (1 + x) / 2) / count, weight / 2 / count);
    };
    panels(kThetaPanels, [&](double t, double theta_weight) {
        const double theta = t * kPi / 2, sine = std::sin(theta), z = std::cos(theta);
        panels(kAzimuthPanels, [&](double v, double azimuth_weight) {
            const double azimuth = kPi * v * v;  // both signs of it: twice
            const Vec3d wi(sine * std::cos(azimuth), sine * std::sin(azimuth), z);
            sum += brdf.evaluate(wi, wo) *
                   (z * sine * theta_weight * kPi / 2 * azimuth_weight * 2 * 2 * kPi * v);
        });
    });
    return sum;
}

// The channels have F0 = 1, 0 and 0.3: A + B, B and 0.3 A + B.
Brdf ggx(double roughness) {
    return Microfacet{.roughness_x = roughness,
                      .roughness_y = roughness,
                      .fresnel = Fresnel::schlick(Vec3d(1, 0, 0.3))};
}

TEST(Dfg, AgreesWithTheBrdfIntegratedOverDirectionsOfLight) {
    for (const double roughness : {0.25, 0.5, 0.75, 1.0}) {
        for (const double n_dot_v : {0.02, 0.1, 0.5, 1.0}) {
            SCOPED_TRACE(testing::Message() << roughness << " " << n_dot_v);
            const Vec3d truth = furnace(ggx(roughness), n_dot_v);
            const Dfg dfg = ggx_dfg(n_dot_v, roughness);
            EXPECT_NEAR(dfg.albedo(), truth.x, 1e-7);
            EXPECT_NEAR(dfg.bias, truth.y, 1e-7);
            EXPECT_NEAR(dfg.reflectance(Vec3d(0.3)).x, truth.z, 1e-7);
        }
    }
}

TEST(Dfg, AgreesWithCharlieIntegratedOverDirectionsOfLight) {
    for (const double roughness : {0.25, 0.5, 1.0}) {
        for (const double n_dot_v : {0.02, 0.25, 0.5, 0.9}) {
            SCOPED_TRACE(testing::Message() << roughness << " " << n_dot_v);
            EXPECT_NEAR(charlie_albedo(n_dot_v, roughness),
                        furnace(Sheen{.roughness = roughness}, n_dot_v).x, 1e-7);
        }
    }
}

// To the four digits that are known; 0.25 at 0.1 is the integral above, 0.50515.
TEST(Dfg, HasTheKnownValues) {
    const struct {
        double roughness, n_dot_v, scale, bias;
    } known[] = {{0.25, 0.1, 0.5051, 0.3916}, {0.25, 0.5, 0.9559, 0.0326}, {0.25, 1, 0.9957, 0},
                 {0.5, 0.1, 0.7520, 0.1397},  {0.5, 0.5, 0.8349, 0.0224},  {0.5, 1, 0.9159, 0},
                 {0.75, 0.1, 0.7955, 0.0526}, {0.75, 0.5, 0.6548, 0.0085}, {0.75, 1, 0.6269, 0},
                 {1, 0.1, 0.7362, 0.0239},    {1, 0.5, 0.4478, 0.0030},    {1, 1, 0.3069, 0}};
    for (const auto& k : known) {
        SCOPED_TRACE(testing::Message() << k.roughness << " " << k.n_dot_v);
        // They were sampled: 3e-4 is their scatter.
        EXPECT_NEAR(ggx_dfg(k.n_dot_v, k.roughness).scale, k.scale, 3e-4);
        EXPECT_NEAR(ggx_dfg(k.n_dot_v, k.roughness).bias, k.bias, 3e-4);
    }
    const double sheen[2][3] = {{0.4314, 0.2296, 0.0575}, {0.3939, 0.2873, 0.1674}};
    const double cosines[] = {0.25, 0.5, 0.9};
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(charlie_albedo(cosines[i], 0.5), sheen[0][i], 6e-5);
        EXPECT_NEAR(charlie_albedo(cosines[i], 1), sheen[1][i], 6e-5);
    }
}

// Integrals that can be done by hand: at normal incidence and roughness 1, E = 1 - ln 2 and
// Charlie's is sqrt(2)/10; at grazing, E = 1, at roughness 1 B = 1/21 and Charlie's is 2/pi.
TEST(Dfg, HasTheClosedFormsAtItsCorners) {
    EXPECT_NEAR(ggx_dfg(1, 1).albedo(), 1 - std::log(2.0), 1e-9);
    EXPECT_NEAR(charlie_albedo(1, 1), std::sqrt(2.0) / 10, 1e-8);
    EXPECT_NEAR(ggx_dfg(0, 1).bias, 1.0 / 21, 1e-9);
    EXPECT_NEAR(charlie_albedo(0, 1), 2 / kPi, 1e-9);
    for (const double roughness : {1e-6, 1e-3, 0.05, 0.3, 0.7, 1.0})
        EXPECT_NEAR(ggx_dfg(0, roughness).albedo(), 1, 1e-9) << roughness;
    for (const double n_dot_v : {0.0, 0.01, 0.4, 1.0}) {
        const double fresnel = fresnel_schlick(n_dot_v, 0);
        EXPECT_EQ(ggx_dfg(n_dot_v, 0).bias, fresnel);
        EXPECT_EQ(ggx_dfg(n_dot_v, 0).scale, 1 - fresnel);
    }
    for (const double n_dot_v : {0.01, 0.4, 1.0})
        EXPECT_NEAR(ggx_dfg(n_dot_v, 1e-3).scale, 1 - fresnel_schlick(n_dot_v, 0), 1e-6);
    EXPECT_EQ(charlie_albedo(0.3, 0), charlie_albedo(0.3, 0.01));
}

TEST(Dfg, IsANumberBetween0And1AndChangesSmoothly) {
    const double values[] = {0, 1e-9, 1e-6, 1e-4, 1e-3, 0.01, 0.1, 0.3, 0.7, 0.999, 1 - 1e-9, 1};
    for (const double n_dot_v : values) {
        for (const double roughness : values) {
            SCOPED_TRACE(testing::Message() << n_dot_v << " " << roughness);
            const Dfg dfg = ggx_dfg(n_dot_v, roughness);
            EXPECT_GE(dfg.scale, 0);
            EXPECT_GE(dfg.bias, 0);
            EXPECT_LE(dfg.albedo(), 1 + 2e-6);
            const double charlie = charlie_albedo(n_dot_v, roughness);
            EXPECT_TRUE(charlie >= 0 && charlie < 41) << charlie;  // sqrt(1e4 / 2 pi) at the corner
        }
    }
    for (int i = 1; i <= 1000; ++i) {
        const double step =
            std::abs(ggx_dfg(i / 1000.0, 0.5).scale - ggx_dfg((i - 1) / 1000.0, 0.5).scale);
        EXPECT_LT(step, 0.03 / std::sqrt(i)) << i;
    }
}

TEST(Dfg, MeanAlbedoIsThatOfDirectionalAlbedos) {
    for (const double roughness : {0.3, 0.6, 1.0}) {
        constexpr int kCount = 2000;
        double sum = 0;
        for (int i = 0; i < kCount; ++i) {
            const double u = (i + 0.5) / kCount, c = u * u;
            sum += 4 * u * c / kCount * ggx_dfg(c, roughness).albedo();
        }
        EXPECT_NEAR(ggx_mean_albedo(roughness), sum, 1e-5);
    }
    EXPECT_NEAR(ggx_mean_albedo(0), 1, 1e-14);
}

// F0 = 1 with B added is E; both compensations then give all light back.
TEST(MultipleScattering, GivesBackAllThatAWhiteSurfaceLoses) {
    for (const double roughness : {0.0, 0.4, 1.0}) {
        for (const double n_dot_v : {0.05, 0.6, 1.0}) {
            const Dfg dfg = ggx_dfg(n_dot_v, roughness);
            const Vec3d white(1);
            EXPECT_NEAR((dfg.reflectance(white) * energy_compensation(white, dfg.albedo())).x, 1,
                        1e-12);
            const MultipleScattering all = multiple_scattering(dfg, white);
            EXPECT_NEAR(all.single.x + all.multiple.x, 1, 1e-12);
            EXPECT_NEAR(all.diffuse.x, 0, 1e-12);
        }
    }
    // Without F0 nothing is multiplied, and a series of bounces is its sum:
    // single * missing * mean * (1 + missing mean + ...)
    const Dfg dfg{0.5, 0.1};
    EXPECT_EQ(energy_compensation(Vec3d(0), 0.6), Vec3d(1));
    const double mean = 0.3 + 0.7 / 21, single = 0.25;
    double series = 0, term = single;
    for (int i = 0; i < 60; ++i) series += term *= 0.4 * mean;
    EXPECT_NEAR(multiple_scattering(dfg, Vec3d(0.3)).multiple.y, series, 1e-12);
    EXPECT_NEAR(multiple_scattering(dfg, Vec3d(0.3)).diffuse.y, 1 - single - series, 1e-12);
}

TEST(DfgTable, HoldsTheIntegralsAtItsTexels) {
    const DfgTable table(16, 8);
    ASSERT_EQ(table.image().width(), 16);
    ASSERT_EQ(table.image().height(), 8);
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 16; ++x) {
            const double n_dot_v = (x + 0.5) / 16, roughness = (y + 0.5) / 8;
            const Dfg dfg = ggx_dfg(n_dot_v, roughness);
            const Vec3f texel = table.image().rgb(x, y);
            EXPECT_EQ(texel.x, static_cast<float>(dfg.scale));
            EXPECT_EQ(texel.y, static_cast<float>(dfg.bias));
            EXPECT_EQ(texel.z, static_cast<float>(charlie_albedo(n_dot_v, roughness)));
            EXPECT_NEAR(table.ggx(n_dot_v, roughness).scale, texel.x, 1e-6);
            EXPECT_NEAR(table.charlie(n_dot_v, roughness), texel.z, 1e-6);
        }
    }
    // halfway between texels, their mean; beyond the outermost centres, the outermost
    EXPECT_NEAR(table.ggx(4.0 / 16, 3.5 / 8).bias,
                (table.image().rgb(3, 3).y + table.image().rgb(4, 3).y) / 2, 1e-7);
    EXPECT_NEAR(table.ggx(3.5 / 16, 4.0 / 8).bias,
                (table.image().rgb(3, 3).y + table.image().rgb(3, 4).y) / 2, 1e-7);
    EXPECT_EQ(table.ggx(0, 0).scale, table.image().rgb(0, 0).x);
    EXPECT_EQ(table.ggx(1, 1).scale, table.image().rgb(15, 7).x);
}

// Straight lines between 64 x 64 texels; the curve bends most where the view grazes.
TEST(DfgTable, InterpolatesCloseToTheIntegrals) {
    const DfgTable table(64, 64);
    for (const double roughness : {0.21, 0.5, 0.93}) {
        for (const double n_dot_v : {0.1, 0.33, 0.5, 0.8, 0.97}) {
            const Dfg exact = ggx_dfg(n_dot_v, roughness), read = table.ggx(n_dot_v, roughness);
            EXPECT_NEAR(read.scale, exact.scale, 3e-3) << n_dot_v << " " << roughness;
            EXPECT_NEAR(read.bias, exact.bias, 3e-3) << n_dot_v << " " << roughness;
        }
    }
}

TEST(DfgTable, IsTheSameAtAnyNumberOfThreads) {
    const auto on = [](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        tbb::task_arena arena(static_cast<int>(threads));
        return arena.execute([] { return DfgTable(20, 12).image(); });
    };
    const Image a = on(1), b = on(3);
    EXPECT_TRUE(std::equal(a.values().begin(), a.values().end(), b.values().begin()));
}

TEST(DfgTable, RefusesSizesThatCannotBe) {
    for (const auto& [width, height] : {std::pair{1, 8}, {8, 0}, {-3, 8}, {8, 4097}}) {
        try {
            (void)DfgTable(width, height);
            FAIL() << width << " x " << height;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), Errc::usage);
            EXPECT_NE(std::string(error.what()).find("expected 2 to 4096"), std::string::npos);
        }
    }
}

}  // namespace
}  // namespace mirrorball
