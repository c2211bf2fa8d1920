// BRDFs as zonal lobes per view: against closed forms where the kernel is zonal, against every
// other axis where it is not, and shaded against the sum of equation 16.
#include <mirrorball/view_lobe.h>

#include <cmath>

#include <gtest/gtest.h>
#include <mirrorball/brdf_properties.h>
#include <mirrorball/error.h>
#include <mirrorball/prefilter.h>
#include <tbb/global_control.h>

#include "brdf/directions.h"
#include "io/io_test_support.h"
#include "synthetic.h"

namespace mirrorball {
namespace {

Vec3d view_at(double degrees, double azimuth = 0) {
    const double theta = degrees * kPi / 180, phi = azimuth * kPi / 180;
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

double degrees_between(const Vec3d& a, const Vec3d& b) {
    return 2 * std::asin(std::min(1.0, (a - b).length() / 2)) * 180 / kPi;
}

void expect_lobe(const Lobe& found, const Lobe& expected, double tolerance) {
    const double peak = expected.value(1);
    for (int degrees = 0; degrees <= 180; degrees += 3) {
        const double t = std::cos(degrees * kPi / 180);
        EXPECT_NEAR(found.value(t), expected.value(t) * (1 / expected.integral()), tolerance * peak)
            << to_string(expected) << " " << degrees;
    }
}

TEST(ViewLobe, OfLambertIsTheCosineForEveryView) {
    for (const double degrees : {0.0, 30.0, 80.0}) {
        const ViewLobe lobe =
            fit_view_lobe(Lambert{.reflectance = {0.8, 0.5, 0.1}}, view_at(degrees));
        EXPECT_LT(degrees_between(lobe.axis, {0, 0, 1}), 0.5) << degrees;
        expect_lobe(lobe.lobe, parse_lobe("diffuse"), 2e-3);
        EXPECT_NEAR(lobe.albedo.x, 0.8, 1e-3);
        EXPECT_NEAR(lobe.albedo.z, 0.1, 1e-4);
        EXPECT_LT(lobe.fit_error, 0.01);
    }
}

// Lewis's form has no cosine left: the map of the survey's equation 18, exactly.
TEST(ViewLobe, OfLewissPhongIsThePhongLobe) {
    const Phong phong{.form = Phong::Form::lewis, .reflectance = Vec3d(0.6), .exponent = 40};
    const ViewLobe lobe = fit_view_lobe(phong, view_at(40));
    EXPECT_LT(degrees_between(lobe.axis, view_at(40, 180)), 0.1);
    expect_lobe(lobe.lobe, parse_lobe("phong:40"), 1e-3);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(lobe.albedo[c], 0.6, 1e-3);
    EXPECT_LT(lobe.fit_error, 5e-3);
}

TEST(ViewLobe, NarrowLobesAreFoundAndResolved) {
    for (const double roughness : {0.02, 0.05, 0.2}) {
        const Brdf ggx = Microfacet{.roughness_x = roughness, .roughness_y = roughness};
        const ViewLobe lobe = fit_view_lobe(ggx, view_at(30));
        EXPECT_LT(degrees_between(lobe.axis, view_at(30, 180)), 2) << roughness;
        const Integral furnace = furnace_radiance(ggx, view_at(30), 1 << 16);
        EXPECT_NEAR(lobe.albedo.x, furnace.value.x, 3e-3 * furnace.value.x + 4 * furnace.error)
            << roughness;
        EXPECT_LT(lobe.fit_error, 0.2) << roughness;
    }
}

// The cosine and the shadows pull the highlight out of the mirror direction, towards the normal.
TEST(ViewLobe, RoughHighlightsAreNotWhereMirrorsHaveThem) {
    const Brdf rough = Microfacet{.roughness_x = 0.5, .roughness_y = 0.5};
    const ViewLobe lobe = fit_view_lobe(rough, view_at(60));
    EXPECT_NEAR(lobe.axis.y, 0, 1e-9);
    EXPECT_LT(lobe.axis.x, 0);
    EXPECT_LT(degrees_between(lobe.axis, {0, 0, 1}), 59);
    EXPECT_GT(degrees_between(lobe.axis, {0, 0, 1}), 45);
}

// In least squares over the sphere: the mean over circles about any axis beside holds less energy.
TEST(ViewLobe, NoAxisBesideIsBetter) {
    const Brdf rough = Microfacet{.roughness_x = 0.4, .roughness_y = 0.6};
    for (const Vec3d& view : {view_at(50), view_at(50, 35)}) {
        const ViewLobe lobe = fit_view_lobe(rough, view);
        const auto energy_about = [&](const Vec3d& axis) {
            double energy = 0;
            for (int i = 0; i < 240; ++i) {
                const double angle = kPi * (i + 0.5) / 240;
                double mean = 0;
                for (int k = 0; k < 96; ++k) {
                    const Vec3d wi = detail::about(
                        axis, detail::spherical(std::cos(angle), 2 * kPi * (k + 0.5) / 96));
                    if (wi.z > 0) mean += rough.evaluate(wi, view).x * wi.z / 96;
                }
                energy += mean * mean * std::sin(angle);
            }
            return energy;
        };
        const double here = energy_about(lobe.axis);
        for (int k = 0; k < 6; ++k) {
            const Vec3d beside =
                detail::about(lobe.axis, detail::spherical(std::cos(0.05), k * kPi / 3));
            EXPECT_LE(energy_about(beside), here * (1 + 1e-4)) << k;
        }
    }
}

TEST(ViewLobe, MirrorsAreKeptApart) {
    const ViewLobe mirror = fit_view_lobe(Mirror{}, view_at(20));
    EXPECT_TRUE(mirror.lobe.is_delta());
    EXPECT_EQ(mirror.albedo, Vec3d(0));
    EXPECT_GT(mirror.mirror.x, 0);
    EXPECT_LT(degrees_between(mirror.axis, view_at(20, 180)), 1e-6);
    const ViewLobe both = fit_view_lobe(0.5 * Brdf(Mirror{}) + 0.5 * Brdf(Lambert{}), view_at(20));
    EXPECT_NEAR(both.albedo.x, 0.5, 1e-3);
    EXPECT_NEAR(both.mirror.x, 0.5 * mirror.mirror.x, 1e-12);
}

TEST(ViewLobe, BlackIsBlack) {
    const ViewLobe lobe = fit_view_lobe(Brdf(), view_at(10));
    EXPECT_EQ(lobe.albedo, Vec3d(0));
    EXPECT_EQ(lobe.fit_error, 0);
}

TEST(ViewStack, LooksBetweenItsLobes) {
    const ViewStack stack(Microfacet{.roughness_x = 0.3, .roughness_y = 0.5}, 3, 4);
    ASSERT_EQ(stack.lobes().size(), 12u);
    // at a node: that lobe alone
    const ViewLobe& node = stack.lobes()[1 * 4 + 2];
    const ViewStack::Lookup there = stack.look_up(node.view);
    double weight = 0;
    for (int k = 0; k < 4; ++k) weight += there.layers[k] == 6 ? there.weights[k] : 0;
    EXPECT_NEAR(weight, 1, 1e-9);
    EXPECT_LT(degrees_between(there.axis, node.axis), 1e-6);
    // between: all four, and an axis among theirs; around and beyond the last elevation too
    for (const Vec3d& view : {view_at(20, 30), view_at(60, 350), view_at(89, 200)}) {
        const ViewStack::Lookup between = stack.look_up(view);
        double sum = 0;
        for (const double w : between.weights) sum += w;
        EXPECT_NEAR(sum, 1, 1e-12);
        EXPECT_NEAR(between.axis.length(), 1, 1e-12);
        EXPECT_LT(degrees_between(between.axis, {-view.x, -view.y, view.z}), 45);
    }
}

TEST(ViewStack, ShadesAsEquation16) {
    const EnvironmentMap map = sampled(Projection::cube, 24, smooth_light);
    struct Case {
        const char* brdf;
        double error;  // a fifth more than was measured
    };
    // Grazing highlights are streaks, which no zonal lobe is; a sheen is a ring.
    for (const Case& c :
         {Case{"lambert:0.7", 5e-3}, Case{"phong:20", 5e-3}, Case{"ggx:roughness=0.5", 0.045},
          Case{"ggx:roughness=0.35,metal=gold", 0.03}, Case{"charlie:0.5", 0.07}}) {
        const Brdf brdf = parse_brdf(c.brdf);
        const double error = measure_fit(map, brdf, ViewStack(brdf, 9), 48);
        RecordProperty(c.brdf, std::to_string(error));
        EXPECT_LT(error, c.error) << c.brdf;
        EXPECT_GT(error, 1e-9) << c.brdf;
    }
}

// A streak is no zonal lobe; yet views along and across the brush differ, and the azimuth knows.
TEST(ViewStack, AnisotropyNeedsAzimuths) {
    const EnvironmentMap map = sampled(Projection::cube, 12, smooth_light);
    const Brdf brushed = Microfacet{.roughness_x = 0.2, .roughness_y = 0.7};
    const double without = measure_fit(map, brushed, ViewStack(brushed, 5, 1), 48);
    const double with = measure_fit(map, brushed, ViewStack(brushed, 5, 8), 48);
    EXPECT_LT(with, 0.8 * without);
}

TEST(ViewStack, MapsPrefilteredByItsLobesShadeAlike) {
    const EnvironmentMap map = sampled(Projection::cube, 48, smooth_light);
    const Brdf brdf = parse_brdf("ggx:roughness=0.6");
    const ViewStack stack(brdf, 2);
    std::vector<PrefilterTarget> targets;
    for (const ViewLobe& lobe : stack.lobes()) targets.push_back({lobe.lobe, Projection::cube, 9});
    const auto maps = prefilter(map, targets);
    // the middle of +z's face is looked at along the axis itself
    for (std::size_t i = 0; i < maps.size(); ++i) {
        const ViewLobe& lobe = stack.lobes()[i];
        const FacePoint<double> middle{4, 0.5, 0.5};
        const Vec3d axis = maps[i].axes.to_world(Cube::direction(middle));
        // a frame in which that is the lobe's axis: z such that axis = frame * lobe.axis
        const Vec3d side = Vec3d(0, 1, 0);
        const Vec3d other = axis.cross(side);
        const double c = lobe.axis.z, s = lobe.axis.x;
        const Vec3d normal = axis * c + other * s, tangent = axis * s - other * c;
        const Axes frame{tangent, normal.cross(tangent), normal};
        ASSERT_LT(degrees_between(frame.to_world(lobe.axis), axis), 1e-6);
        const Vec3d expected = reflected_radiance(map, stack, frame, frame.to_world(lobe.view));
        const Vec3f found = maps[i].levels[0].faces[4].rgb(4, 4);
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(found[k] * lobe.albedo[k], expected[k], 3e-3 * expected[k]) << i;
    }
}

TEST(ViewStack, SameBitsOnAnyNumberOfThreads) {
    const Brdf brdf = parse_brdf("ggx:roughness=0.3");
    const ViewStack expected(brdf, 4);
    for (const int threads : {1, 2, 7}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const ViewStack found(brdf, 4);
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_EQ(found.lobes()[i].lobe, expected.lobes()[i].lobe);
            EXPECT_EQ(found.lobes()[i].axis, expected.lobes()[i].axis);
        }
    }
}

TEST(ViewStack, CountsOutOfRangeAreRefused) {
    expect_error([] { ViewStack(Brdf(Lambert{}), 0); }, Errc::usage, {"0 elevations"});
    expect_error([] { ViewStack(Brdf(Lambert{}), 65); }, Errc::usage, {"65 elevations"});
    expect_error([] { ViewStack(Brdf(Lambert{}), 2, 0); }, Errc::usage, {"0 azimuths"});
}

}  // namespace
}  // namespace mirrorball
