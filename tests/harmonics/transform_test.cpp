// The transforms against their definition, and by laws where that would take forever.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <functional>
#include <limits>

#include <fmt/format.h>
#include <mirrorball/error.h>
#include <mirrorball/zonal.h>

#include "brute_force.h"
#include "synthetic.h"

namespace mirrorball {
namespace {

// Next to sums in long double: float's rounding where texels are rings themselves, else what eight
// taps make of a flat spectrum (harmonics.h states 1e-5 for many bands, few have finer grids).
constexpr double kOnRings = 1e-6, kThroughTaps = 2e-5;

const Axes kTilted = rotated(Axes{}, 0.7, 0.4, -0.2);

std::string described(const MapShape& shape, int band_count) {
    return fmt::format("{} {}, axes {}, {} bands", name(shape.projection), shape.size,
                       to_string(shape.axes), band_count);
}

void expect_analysis(const MapShape& shape, int band_count, double tolerance) {
    const EnvironmentMap map = noise_map(shape);
    const Harmonics found = analyse(map, band_count);
    const double error = relative_difference(found, analysed_by_sums(map, band_count));
    EXPECT_LT(error, tolerance) << described(shape, band_count);
}

void expect_synthesis(const MapShape& shape, int band_count, double tolerance) {
    const Harmonics light = noise_harmonics(band_count);
    const EnvironmentMap map = synthesise(light, shape);
    double sum = 0, area = 0;
    for_each_used_texel(shape, [&](const Vec3d& d, double solid_angle, int face, int x, int y) {
        const Vec3d found(map.levels[0].faces[face].rgb(x, y));
        sum += (found - evaluated_by_sums(light, d)).length2() * solid_angle;
        area += solid_angle;
    });
    EXPECT_LT(std::sqrt(sum / area) / light_rms(light), tolerance) << described(shape, band_count);
}

TEST(Transform, AgreesWithSumsInEveryProjection) {
    for (std::size_t i = 0; i < kProjectionCount; ++i) {
        const auto projection = static_cast<Projection>(i);
        for (const Axes& axes : {default_axes(projection), kTilted, mirrored(kTilted)}) {
            const MapShape shape{projection, 16, axes};
            for (const int band_count : {1, 2, 3, 10}) {
                expect_analysis(shape, band_count, kThroughTaps);
                expect_synthesis(shape, band_count, kThroughTaps);
            }
        }
    }
}

TEST(Transform, AgreesWithSumsOnUprightPanoramas) {
    for (const Axes& axes : {Axes{}, rotated(Axes{}, 1.1, 0, 0), mirrored(Axes{}),
                             mirrored(rotated(Axes{}, -2.5, 0, 0))}) {
        for (const int width : {2, 6, 14, 38, 50, 64}) {
            for (const int band_count : {1, 2, 3, 10})
                expect_analysis({Projection::equirect, width, axes}, band_count, kOnRings);
        }
    }
}

// 134 = 2 * 67: a length that the Fourier transform is not asked for.
TEST(Transform, AgreesWithSumsOnOtherPanoramas) {
    const Axes upside_down = rotated(Axes{}, 0, 0, kPi);
    for (const MapShape& shape :
         {MapShape{Projection::equirect, 134, Axes{}}, MapShape{Projection::equirect, 50, kTilted},
          MapShape{Projection::equirect, 6, kTilted},
          MapShape{Projection::equirect, 20, upside_down}}) {
        expect_analysis(shape, 8, kThroughTaps);
        expect_synthesis(shape, 8, kThroughTaps);
    }
}

TEST(Transform, AgreesWithSumsOnCubesOfAnySize) {
    for (const int size : {1, 2, 3, 33}) {
        for (const Axes& axes :
             {default_axes(Projection::cube), Axes{}, parse_axes("-z+y-x", {})}) {
            expect_analysis({Projection::cube, size, axes}, 8, kThroughTaps);
            expect_synthesis({Projection::cube, size, axes}, 8, kThroughTaps);
        }
    }
}

// One lit texel: every coefficient is known, and the addition theorem sums them up.
TEST(Transform, OneLitTexelIsADeltaAtAnyBandCount) {
    for (const MapShape& shape :
         {MapShape{Projection::equirect, 1000, Axes{}},
          MapShape{Projection::equirect, 1022, Axes{}},
          MapShape{Projection::cube, 128, default_axes(Projection::cube)}}) {
        for (const int band_count : {200, 1024}) {
            if (shape.projection == Projection::cube && band_count == 1024) continue;
            EnvironmentMap map = make_environment_map(shape.projection, shape.size);
            map.axes = shape.axes;
            const int lit_x = shape.size / 3, lit_y = shape.size / 9;
            map.levels[0].faces[0].set_rgb(lit_x, lit_y, Vec3f(1, 0, 0));
            Vec3d light;
            double area = 0;
            for_each_used_texel(shape,
                                [&](const Vec3d& d, double solid_angle, int face, int x, int y) {
                                    if (face == 0 && x == lit_x && y == lit_y)
                                        light = d, area = solid_angle;
                                });
            const Harmonics found = analyse(map, band_count);
            // Parseval: degree l of a delta holds area^2 (2l+1) / (4 pi)
            const std::vector<double> power = power_spectrum(found);
            double worst = 0;
            for (int l = 0; l < band_count; ++l) {
                const double expected = area * area * (2 * l + 1) / (4 * kPi);
                worst = std::max(worst, std::abs(power[l] / expected - 1));
            }
            EXPECT_LT(worst, 2e-4) << described(shape, band_count);
            // sum over l of area (2l+1) / (4 pi) P_l(cos), by Legendre's own recurrence
            const double peak = area * band_count * band_count / (4 * kPi);
            for (const Vec3d& d : random_directions(8)) {
                double sum = 0, before = 0, now = 1;
                const double x = d.dot(light);
                for (int l = 0; l < band_count; ++l) {
                    sum += area * (2 * l + 1) / (4 * kPi) * now;
                    const double next = ((2 * l + 1) * x * now - l * before) / (l + 1);
                    before = now, now = next;
                }
                EXPECT_NEAR(evaluate(found, d).x, sum, 1e-6 * peak) << described(shape, band_count);
            }
            EXPECT_NEAR(evaluate(found, light).x, peak, 2e-5 * peak)
                << described(shape, band_count);
        }
    }
}

// evaluate() shares neither recurrence nor precision with the synthesis. A lobe's grid is smaller.
TEST(Transform, ThousandsOfBandsAreSynthesised) {
    const auto expect_synthesised = [](const HarmonicSynthesis& synthesis, const Harmonics& light,
                                       const std::vector<double>& factors) {
        const MapShape& shape = synthesis.shape();
        EnvironmentMap map = noise_map(shape);
        synthesis(light, factors, map);
        const Harmonics filtered = convolved(light, factors);
        double sum = 0;
        int count = 0, index = 0;
        for_each_used_texel(shape, [&](const Vec3d& d, double, int face, int x, int y) {
            if (index++ % 23 != 0) return;
            const Vec3d found(map.levels[0].faces[face].rgb(x, y));
            sum += (found - evaluate(filtered, d)).length2(), ++count;
        });
        EXPECT_LT(std::sqrt(sum / count) / light_rms(filtered), kThroughTaps)
            << described(shape, synthesis.band_count());
    };
    const MapShape panorama{Projection::equirect, 16, Axes{}};
    const MapShape cube{Projection::cube, 9, default_axes(Projection::cube)};
    const Harmonics light = noise_harmonics(1500);
    expect_synthesised(HarmonicSynthesis(cube, 1024), light, std::vector<double>(1024, 1.0));
    const Lobe lobe = parse_lobe("ggx:0.08");
    for (const MapShape& shape : {panorama, cube})
        expect_synthesised(HarmonicSynthesis(shape, 1500, lobe), light,
                           zonal_coefficients(lobe, 1500));
}

// Sums over texels are a quadrature: (l texel)^2 / 24 of what is there.
TEST(Transform, AnalysisGivesBackWhatWasSynthesised) {
    struct Case {
        MapShape shape;
        double texel;
    };
    for (const auto& [shape, texel] :
         {Case{{Projection::equirect, 512, Axes{}}, 2 * kPi / 512},
          Case{{Projection::equirect, 512, kTilted}, 2 * kPi / 512},
          Case{{Projection::cube, 256, default_axes(Projection::cube)}, 2.0 / 256},
          Case{{Projection::octahedral, 512, Axes{}}, 2.0 / 256}}) {
        const int band_count = 24;
        const Harmonics light = noise_harmonics(band_count);
        const Harmonics found = analyse(synthesise(light, shape), band_count);
        const double l = band_count;
        EXPECT_LT(relative_difference(found, light), l * l * texel * texel / 24 + kThroughTaps)
            << described(shape, band_count);
    }
}

TEST(Transform, ALitTexelFilteredIsTheLobe) {
    const Lobe lobe = parse_lobe("ggx:0.4");
    const int band_count = 96;
    EnvironmentMap map = make_environment_map(Projection::equirect, 512);
    map.levels[0].faces[0].set_rgb(100, 60, Vec3f(1, 2, 3));
    const MapShape shape{Projection::cube, 32, default_axes(Projection::cube)};
    const EnvironmentMap found = synthesise(convolved(analyse(map, band_count), lobe), shape);
    Vec3d light;
    double area = 0;
    for_each_used_texel(shape_of(map), [&](const Vec3d& d, double solid_angle, int, int x, int y) {
        if (x == 100 && y == 60) light = d, area = solid_angle;
    });
    double worst = 0;
    for_each_used_texel(shape, [&](const Vec3d& d, double, int face, int x, int y) {
        const double value = found.levels[0].faces[face].rgb(x, y).z;
        worst = std::max(worst, std::abs(value - 3 * area * lobe.value(d.dot(light))));
    });
    // what the bands from 96 up hold of the lobe, at its crease
    EXPECT_LT(worst / (3 * area * lobe.value(1)), 1e-4);
}

TEST(Transform, PowerIsTheIntegralOfTheSquare) {
    const Harmonics light = noise_harmonics(20);
    const EnvironmentMap map = synthesise(light, {Projection::equirect, 512, Axes{}});
    const LevelStatistics s = statistics(map);
    EXPECT_NEAR(s.rms * std::sqrt(3.0) / light_rms(light), 1, 1e-3);  // quadrature, as above
}

// Plans ------------------------------------------------------------------------------------------

TEST(Transform, FactorsFilterAndFewerAreFewerBands) {
    const MapShape shape{Projection::cube, 16, default_axes(Projection::cube)};
    const Harmonics light = noise_harmonics(40);
    const HarmonicSynthesis synthesis(shape, 64);  // more than there are
    const std::vector<double> factors = window_coefficients(Window::lanczos, 25);
    EnvironmentMap found = make_environment_map(Projection::cube, 16);
    synthesis(light, factors, found);
    const Harmonics filtered = convolved(light, factors);
    double worst = 0;
    for_each_used_texel(shape, [&](const Vec3d& d, double, int face, int x, int y) {
        const Vec3d difference =
            Vec3d(found.levels[0].faces[face].rgb(x, y)) - evaluate(filtered, d);
        worst = std::max(worst, difference.length());
    });
    EXPECT_LT(worst / light_rms(filtered), 1e-4);
    synthesis(light, {}, found);
    EXPECT_EQ(statistics(found).rms, 0);
    synthesis(Harmonics(), factors, found);
    EXPECT_EQ(statistics(found).rms, 0);
}

TEST(Transform, APlanForLobesIsExactForThemAndWiderOnes) {
    const MapShape shape{Projection::cube, 16, default_axes(Projection::cube)};
    const Harmonics light = noise_harmonics(205);
    EnvironmentMap found = make_environment_map(Projection::cube, 16);
    for (const char* narrowest : {"ggx:0.17", "phong:800", "mirror", "ggx:0.05"}) {
        const HarmonicSynthesis synthesis(shape, 205, parse_lobe(narrowest));
        for (const char* name : {"ggx:0.17", "ggx:0.3", "diffuse"}) {
            const std::vector<double> factors = zonal_coefficients(parse_lobe(name), 205);
            synthesis(light, factors, found);
            const Harmonics filtered = convolved(light, factors);
            double sum = 0;
            int count = 0, index = 0;
            for_each_used_texel(shape, [&](const Vec3d& d, double, int face, int x, int y) {
                if (index++ % 7 != 0) return;
                const Vec3d value(found.levels[0].faces[face].rgb(x, y));
                sum += (value - evaluate(filtered, d)).length2(), ++count;
            });
            EXPECT_LT(std::sqrt(sum / count) / light_rms(filtered), kThroughTaps)
                << narrowest << " " << name;
        }
    }
}

TEST(Transform, TexelsAreClampedToTheRange) {
    const MapShape shape{Projection::cube, 8, default_axes(Projection::cube)};
    const HarmonicSynthesis synthesis(shape, 16);
    const Harmonics light = noise_harmonics(16);
    const EnvironmentMap whole = synthesis(light);
    EnvironmentMap clamped = whole;
    const TexelRange range{{-1, -2, 0}, {1, 0.5, 3}};
    synthesis(light, std::vector<double>(16, 1.0), clamped, range);
    for (int face = 0; face < 6; ++face) {
        for (int i = 0; i < 64; ++i) {
            const Vec3f a = whole.levels[0].faces[face].rgb(i % 8, i / 8);
            const Vec3f b = clamped.levels[0].faces[face].rgb(i % 8, i / 8);
            for (int c = 0; c < 3; ++c)
                EXPECT_EQ(b[c], std::clamp(a[c], range.lowest[c], range.highest[c]));
        }
    }
}

TEST(Transform, SameBitsOnAnyNumberOfThreads) {
    const auto all = [] {
        std::vector<float> bits;
        for (const MapShape& shape :
             {MapShape{Projection::equirect, 100, Axes{}},
              MapShape{Projection::equirect, 100, kTilted},
              MapShape{Projection::cube, 40, default_axes(Projection::cube)}}) {
            const Harmonics light = rotated(analyse(noise_map(shape), 64), kTilted);
            for (int m = 0; m < 64; ++m)
                bits.insert(bits.end(), light.order(m).begin(), light.order(m).end());
            const EnvironmentMap map = synthesise(light, shape);
            for (const Image& face : map.levels[0].faces)
                bits.insert(bits.end(), face.values().begin(), face.values().end());
        }
        return bits;
    };
    std::vector<float> expected;
    for (const int threads : {1, 2, 7}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        tbb::task_arena arena(threads);
        const std::vector<float> found = arena.execute(all);
        if (expected.empty()) expected = found;
        EXPECT_TRUE(found == expected) << threads;
    }
}

void expect_error(Errc code, const std::string& part, const std::function<void()>& f) {
    try {
        f();
        ADD_FAILURE() << "no error; expected: " << part;
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

TEST(Transform, TexelsThatAreNoNumbersAreRefused) {
    for (const MapShape& shape :
         {MapShape{Projection::equirect, 64, Axes{}}, MapShape{Projection::equirect, 64, kTilted},
          MapShape{Projection::cube, 16, default_axes(Projection::cube)},
          MapShape{Projection::cube, 17, kTilted}}) {
        for (const float bad :
             {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
              -std::numeric_limits<float>::infinity()}) {
            for (const int at : {0, 5}) {
                EnvironmentMap map = noise_map(shape);
                map.levels[0].faces.back().set_rgb(at, at, Vec3f(0, bad, 0));
                expect_error(Errc::cannot_read, "NaN", [&] { (void)analyse(map, 20); });
            }
        }
    }
}

TEST(Transform, RequestsThatMakeNoSenseAreRefused) {
    const MapShape shape{Projection::equirect, 64, Axes{}};
    expect_error(Errc::usage, "1 to 4096", [&] { HarmonicAnalysis(shape, 0); });
    expect_error(Errc::usage, "1 to 4096", [&] { HarmonicSynthesis(shape, 4097); });
    expect_error(Errc::usage, "size 0", [] { HarmonicAnalysis({Projection::cube, 0, {}}, 3); });
    expect_error(Errc::usage, "size 63", [] {
        HarmonicSynthesis({Projection::equirect, 63, {}}, 3);
    });
    const HarmonicAnalysis analysis(shape, 3);
    EXPECT_EQ(analysis.shape(), shape);
    EXPECT_EQ(analysis.band_count(), 3);
    expect_error(Errc::usage, "of size 32, the plan is for equirect of size 64",
                 [&] { (void)analysis(make_environment_map(Projection::equirect, 32)); });
    expect_error(Errc::usage, "axes", [&] {
        (void)analysis(noise_map({Projection::equirect, 64, kTilted}));
    });
}

}  // namespace
}  // namespace mirrorball
