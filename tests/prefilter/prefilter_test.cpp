// Prefiltering by harmonics against the sum over every texel in double, and both against closed
// forms. What was measured is in the XML report too: --gtest_output=xml, `<map> <lobe>`.
#include <mirrorball/prefilter.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mirrorball/compare.h>
#include <mirrorball/error.h>
#include <mirrorball/io.h>
#include <mirrorball/resample.h>
#include <tbb/global_control.h>

#include "support.h"
#include "synthetic.h"

namespace mirrorball {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// A ring about the axis with a soft middle, as no formula of ours would have it.
Lobe table() {
    return tabulated_lobe("soft ring", {0, 0.2, 0.5, 0.9, 1.4, 2.2}, {0.6, 1, 0.7, 0.3, 0.1, 0});
}

Lobe lobe_of(const std::string& text) {
    return text == "table" ? table() : parse_lobe(text);
}

PrefilterTarget target(const Lobe& lobe, int size = 8, Projection projection = Projection::cube) {
    return {lobe, projection, size, default_axes(projection)};
}

PrefilterTarget target(const char* lobe, int size = 8, Projection projection = Projection::cube) {
    return target(lobe_of(lobe), size, projection);
}

Prefiltered run(const EnvironmentMap& source, const std::vector<PrefilterTarget>& targets,
                const PrefilterOptions& options = {}) {
    return PrefilterPlan(shape_of(source), targets, options)(source);
}

EnvironmentMap fast(const EnvironmentMap& source, const PrefilterTarget& target) {
    return std::move(run(source, {target}).maps[0]);
}

bool same_bits(const EnvironmentMap& a, const EnvironmentMap& b) {
    if (shape_of(a) != shape_of(b)) return false;
    for (std::size_t face = 0; face < a.levels[0].faces.size(); ++face) {
        if (!std::ranges::equal(a.levels[0].faces[face].values(), b.levels[0].faces[face].values()))
            return false;
    }
    return true;
}

// ---- Sources ----

// Next to +X, which is the middle of a texel of every odd cube: a result of few texels has to see
// a lobe's peak, or its rms has nothing to do with that of the light around.
EnvironmentMap one_lit_texel(int width) {
    EnvironmentMap map = make_environment_map(Projection::equirect, width);
    map.levels[0].faces[0].set_rgb(width * 3 / 4, width / 4, {1e5f, 5e4f, 1.0f});
    return map;
}

// 10^5 : 1, as wide as some texels, next to +X too.
EnvironmentMap sun_over_dim_sky(int width) {
    const Vec3d sun = Vec3d(1, 0.011, -0.007).normalized();
    return sampled(Projection::equirect, width, [&](const Vec3d& d) {
        if (d.dot(sun) > std::cos(0.03)) return Vec3d(5e4, 4e4, 3e4);
        return Vec3d(0.2, 0.3, 0.5) * (1 + d.y) + Vec3d(0.05);
    });
}

// Windows and lamps of a room: 15 % of the sphere at 30 to 300 times the walls.
EnvironmentMap area_lights(int width) {
    return sampled(Projection::equirect, width, [](const Vec3d& d) {
        if (d.y > 0.9) return Vec3d(30, 28, 25);
        if (std::abs(d.x - 0.8) < 0.1 && std::abs(d.y) < 0.4) return Vec3d(60, 80, 120);
        if (d.dot(Vec3d(-0.6, 0.0, 0.8)) > 0.99) return Vec3d(300, 200, 90);
        return Vec3d(0.9, 0.8, 1.0) * (1 + 0.5 * d.z);
    });
}

EnvironmentMap sparse_lights(int width) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform;
    return sampled(Projection::equirect, width, [&](const Vec3d&) {
        return uniform(random) < 0.05 ? Vec3d(20, 18, 15) : Vec3d(1, 1, 1);
    });
}

EnvironmentMap noise(Projection projection, int size) {
    std::mt19937 random(23);
    std::uniform_real_distribution<double> uniform;
    return sampled(projection, size, [&](const Vec3d&) {
        return Vec3d(uniform(random), uniform(random), uniform(random));
    });
}

const Vec3d kSlope(0.3, -0.5, 0.4);

EnvironmentMap ramp(int width) {
    return sampled(Projection::equirect, width,
                   [](const Vec3d& d) { return Vec3d(1 + kSlope.dot(d)); });
}

EnvironmentMap constant(int width) {
    return sampled(Projection::equirect, width, [](const Vec3d&) { return Vec3d(0.5, 1, 3e4); });
}

struct NamedSource {
    const char* name;
    EnvironmentMap (*make)(int width);
};

const NamedSource kSources[] = {
    {"one_lit_texel", one_lit_texel},
    {"sun_over_dim_sky", sun_over_dim_sky},
    {"area_lights", area_lights},
    {"sparse_lights", sparse_lights},
    {"noise", [](int width) { return noise(Projection::equirect, width); }},
    {"ramp", ramp},
    {"constant", constant},
};

const char* const kWideLobes[] = {"diffuse", "phong:1",     "phong:10", "phong:100",
                                  "ggx:0.5", "ggx:0.75",    "ggx:1",    "blinn-phong:400",
                                  "table",   "charlie:0.3", "charlie:1"};
// These need a finer source: on one of 256 texels they are a texel wide.
const char* const kNarrowLobes[] = {"phong:1000", "ggx:0.05", "ggx:0.1", "ggx:0.125", "ggx:0.25"};

// ---- Against the truth ----

struct Measured {
    Difference difference;
    double estimate;
};

void record(const std::string& what, const Measured& m) {
    testing::Test::RecordProperty(
        what, fmt::format("rmse {:.2e} local {:.2e} estimate {:.2e}", m.difference.relative_rmse,
                          m.difference.maximum_relative, m.estimate));
}

std::vector<Measured> measure(const EnvironmentMap& source,
                              const std::vector<PrefilterTarget>& targets,
                              const PrefilterOptions& options = {}) {
    const Prefiltered result = run(source, targets, options);
    std::vector<Measured> measured;
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const EnvironmentMap truth = prefilter_reference(source, targets[i]);
        measured.push_back({compare(result.maps[i], truth), result.errors[i]});
    }
    return measured;
}

// What prefilter.h promises, and what more is known to be so of some lobes; with the largest
// figures measured.
struct Limits {
    double rmse = 1e-4;   // 9e-5
    double local = 2e-3;  // 1.5e-3: an octave above the promise where a sun stands over a dim sky
    double too_low = 1;   // of estimates: they may be below what is measured by this
};

Limits limits_of(const std::string& lobe) {
    // the ring's inner edge is a crease that its bands carry to this: 2.2e-4, 9.6e-3, 3.4
    if (lobe.starts_with("charlie")) return {3e-4, 1.2e-2, 4};
    // of a light's peak, single precision leaves 2e-9 everywhere: 3.9e-4, 6.2e-2
    if (lobe == "ggx:0.05") return {5e-4, 8e-2, 1};
    // 1.3e-4 over sparse lights, 3.5e-3
    if (lobe == "ggx:0.1" || lobe == "ggx:0.125" || lobe == "phong:1000") return {2e-4, 5e-3, 1};
    return {};
}

void expect_near_truth(const EnvironmentMap& source, const std::string& name,
                       std::span<const char* const> lobes, int size) {
    std::vector<PrefilterTarget> targets;
    for (const char* text : lobes) targets.push_back(target(text, size));
    const std::vector<Measured> measured = measure(source, targets);
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const std::string what = name + " " + lobes[i];
        const Limits limits = limits_of(lobes[i]);
        const auto& [difference, estimate] = measured[i];
        record(what, measured[i]);
        EXPECT_LE(difference.relative_rmse, limits.rmse) << what;
        EXPECT_LE(difference.maximum_relative, limits.local) << what;
        EXPECT_GE(estimate * limits.too_low, difference.relative_rmse) << what;
    }
}

class PrefilterTruth : public testing::TestWithParam<NamedSource> {};

TEST_P(PrefilterTruth, WideLobes) {
    expect_near_truth(GetParam().make(256), GetParam().name, kWideLobes, 9);
}

TEST_P(PrefilterTruth, NarrowLobes) {
    expect_near_truth(GetParam().make(512), GetParam().name, kNarrowLobes, 5);
}

TEST_P(PrefilterTruth, LobesAsNarrowAsATexel) {
    const char* const lobes[] = {"phong:1000", "ggx:0.05", "ggx:0.1", "ggx:0.125"};
    expect_near_truth(GetParam().make(128), GetParam().name, lobes, 13);
}

INSTANTIATE_TEST_SUITE_P(Sources, PrefilterTruth, testing::ValuesIn(kSources),
                         [](const auto& i) { return std::string(i.param.name); });

class PrefilterPanorama : public testing::TestWithParam<const char*> {};

TEST_P(PrefilterPanorama, IsNearTheTruth) {
    const std::string name = GetParam();
    const auto path = shared_file("hdri/" + name + ".hdr");
    if (!path) GTEST_SKIP() << "shared/hdri/" << name << ".hdr is not beside the repository";
    const EnvironmentMap source = read_map(path->string()).map;
    const char* const lobes[] = {"diffuse", "phong:1000", "ggx:0.05", "ggx:0.125", "ggx:0.5"};
    expect_near_truth(source, name, lobes, 5);
}

INSTANTIATE_TEST_SUITE_P(Files, PrefilterPanorama, testing::Values("venice", "studio", "forest"),
                         [](const auto& i) { return std::string(i.param); });

TEST(Prefilter, ATighterToleranceGivesASmallerError) {
    const EnvironmentMap source = area_lights(256);
    for (const char* text : {"ggx:0.25", "phong:100", "diffuse"}) {
        double last = 1;
        for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
            const Measured m = measure(source, {target(text, 9)}, {.tolerance = tolerance})[0];
            record(fmt::format("{} {}", text, tolerance), m);
            // single precision ends at 1e-6, and the crease of diffuse at 7.4e-6
            EXPECT_LE(m.difference.relative_rmse, std::max(tolerance, 1e-5)) << text;
            EXPECT_LE(m.difference.relative_rmse, last) << text << " " << tolerance;
            EXPECT_GE(m.estimate, m.difference.relative_rmse) << text << " " << tolerance;
            last = m.difference.relative_rmse;
        }
    }
}

// ---- Closed forms ----

// lambda_1 / lambda_0: how much of a linear ramp a lobe lets through. By quadrature where there is
// no closed form.
double first_order(const Lobe& lobe) {
    if (lobe.kind == Lobe::Kind::diffuse) return 2.0 / 3;
    if (lobe.kind == Lobe::Kind::phong) return (lobe.parameter + 1) / (lobe.parameter + 2);
    double sum = 0;
    constexpr int count = 200000;
    for (int i = 0; i < count; ++i) {
        const double x = (i + 0.5) / count, theta = kPi * x * x;
        sum += lobe.value(std::cos(theta)) * std::cos(theta) * 2 * kPi * std::sin(theta) * 2 * kPi *
               x / count;
    }
    return sum;
}

// So many that it is cheaper to take more bands than to put each right.
TEST(Prefilter, ThousandsOfLightsAreNearTheTruth) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform;
    const EnvironmentMap source = sampled(Projection::equirect, 256, [&](const Vec3d& d) {
        return d.y > 0.3 && uniform(random) < 0.2 ? Vec3d(300, 280, 250) : Vec3d(0.1, 0.2, 0.3);
    });
    const std::vector<PrefilterTarget> targets = {target("ggx:0.3", 21), target("diffuse", 20)};
    const std::vector<Measured> measured = measure(source, targets);
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const auto& [difference, estimate] = measured[i];
        record("thousands " + to_string(targets[i].lobe), measured[i]);
        EXPECT_LE(difference.relative_rmse, 1e-4) << i;
        EXPECT_GE(estimate, difference.relative_rmse) << i;
    }
    const PrefilterPlan plan(shape_of(source), targets);
    const Prefiltered first = plan(source), second = plan(source);
    for (std::size_t i = 0; i < targets.size(); ++i)
        EXPECT_TRUE(same_bits(first.maps[i], second.maps[i])) << i;
}

TEST(Prefilter, LinearRampsComeOutByFunkHecke) {
    const EnvironmentMap source = averaged(Projection::equirect, 256,
                                           [](const Vec3d& d) { return Vec3d(1 + kSlope.dot(d)); });
    for (const char* text : kWideLobes) {
        const Lobe lobe = lobe_of(text);
        const double through = first_order(lobe);
        const EnvironmentMap expected = sampled(Projection::cube, 8, [&](const Vec3d& r) {
            return Vec3d(lobe.integral() * (1 + through * kSlope.dot(r)));
        });
        // the sum over 256 x 128 texels, against the integral: 2.8e-4 measured, for the narrowest
        EXPECT_LT(compare(prefilter_reference(source, target(text)), expected).maximum_relative,
                  5e-4)
            << text;
        EXPECT_LT(compare(fast(source, target(text)), expected).maximum_relative, 5e-4) << text;
    }
}

TEST(Prefilter, OneLitTexelBecomesTheLobe) {
    const EnvironmentMap source = one_lit_texel(256);
    const Vec3d light = Equirect::direction(FacePoint<double>{0, 192.5 / 256, 64.5 / 128});
    const double solid_angle = solid_angle_table(Projection::equirect, 256, 128)[64 * 256 + 192];
    for (const char* text : kWideLobes) {
        const Lobe lobe = lobe_of(text);
        const EnvironmentMap expected = sampled(Projection::cube, 9, [&](const Vec3d& r) {
            return Vec3d(1e5, 5e4, 1) * (lobe.value(r.dot(light)) * solid_angle);
        });
        // dividing by the weights' sum instead of the integral is all the difference there is
        EXPECT_LT(compare(prefilter_reference(source, target(text, 9)), expected).maximum_relative,
                  2e-3)
            << text;
        EXPECT_LT(compare(fast(source, target(text, 9)), expected).maximum_relative,
                  std::max(2e-3, limits_of(text).local))
            << text;
    }
}

TEST(Prefilter, ConstantsStayToTheBit) {
    for (const Projection from : {Projection::equirect, Projection::cube, Projection::sphere}) {
        const EnvironmentMap source =
            sampled(from, 32, [](const Vec3d&) { return Vec3d(0.5, 1, 3e4); });
        for (const char* text : {"diffuse", "phong:20", "phong:10000000", "ggx:0.001", "ggx:0.02",
                                 "ggx:0.1", "ggx:0.6", "table", "charlie:0.4"}) {
            const auto scale = static_cast<float>(lobe_of(text).integral());
            const EnvironmentMap map = fast(source, target(text, 5));
            const LevelStatistics s = statistics(map);
            EXPECT_EQ(s.minimum, Vec3f(0.5f, 1, 3e4f) * scale) << name(from) << " " << text;
            EXPECT_EQ(s.maximum, Vec3f(0.5f, 1, 3e4f) * scale) << name(from) << " " << text;
            EXPECT_EQ(map.levels[0].lobe, lobe_of(text));
        }
        const LevelStatistics s = statistics(prefilter_reference(source, target("ggx:0.6", 4)));
        EXPECT_NEAR(s.minimum.z / 3e4, 1, 1e-7);
        EXPECT_NEAR(s.maximum.x / 0.5, 1, 1e-7);
    }
}

TEST(Prefilter, DarknessStaysDark) {
    const EnvironmentMap source = make_environment_map(Projection::equirect, 64);
    const Prefiltered result = run(source, {target("diffuse"), target("ggx:0.02")});
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(statistics(result.maps[i]).rms, 0);
        EXPECT_EQ(statistics(result.maps[i]).non_finite_count, 0);
        EXPECT_LE(result.errors[i], 1e-3);
    }
}

TEST(Prefilter, ResultsStayWithinTheSourcesRange) {
    for (const NamedSource& from : kSources) {
        const EnvironmentMap source = from.make(128);
        const LevelStatistics range = statistics(source);
        for (const char* text : {"phong:100", "phong:1000", "ggx:0.05", "ggx:0.25", "diffuse"}) {
            const auto scale = static_cast<float>(lobe_of(text).integral());
            const LevelStatistics s = statistics(fast(source, target(text, 16)));
            for (int c = 0; c < 3; ++c) {
                EXPECT_GE(s.minimum[c], range.minimum[c] * scale) << from.name << " " << text;
                EXPECT_LE(s.maximum[c], range.maximum[c] * scale) << from.name << " " << text;
            }
        }
    }
}

TEST(Prefilter, LightIsKept) {
    for (const NamedSource& from : kSources) {
        const EnvironmentMap source = from.make(256);
        for (const char* text : {"diffuse", "phong:10", "ggx:0.5", "ggx:0.75", "table"}) {
            const Vec3d in = flux(source) * lobe_of(text).integral();
            const Vec3d out = flux(fast(source, target(text, 64)));
            // texels of the result are points: a sum over 64^2 x 6 of them is this near
            EXPECT_NEAR((out - in).length() / in.length(), 0, 1e-3) << from.name << " " << text;
        }
    }
}

// ---- Rotation ----

Axes turned(const Axes& axes, double yaw, double pitch = 0, double roll = 0) {
    return rotated(axes, yaw, pitch, roll);
}

TEST(Prefilter, AQuarterTurnExchangesFaces) {
    const EnvironmentMap source = area_lights(256);
    for (const char* text : {"diffuse", "ggx:0.25", "ggx:0.05"}) {
        PrefilterTarget straight = target(text, 9), quarter = straight;
        quarter.axes = turned(straight.axes, kPi / 2);
        const std::vector<EnvironmentMap> maps = run(source, {straight, quarter}).maps;
        // each texel of the turned cube looks where one of the straight cube does
        EnvironmentMap permuted = maps[1];
        for (int face = 0; face < 6; ++face)
            for (int y = 0; y < 9; ++y)
                for (int x = 0; x < 9; ++x) {
                    const FacePoint<double> at{face, (x + 0.5) / 9, (y + 0.5) / 9};
                    const Vec3d d = quarter.axes.to_world(Cube::direction(at));
                    const auto from = Cube::project(straight.axes.to_map(d));
                    const int s = static_cast<int>(from.s * 9), t = static_cast<int>(from.t * 9);
                    permuted.levels[0].faces[face].set_rgb(
                        x, y, maps[0].levels[0].faces[from.face].rgb(s, t));
                }
        const Difference d = compare(maps[1], permuted);
        // interpolated at other phases of the same grid
        EXPECT_LT(d.relative_rmse, 5e-5) << text;
        EXPECT_LT(d.maximum_relative, 1e-3) << text;
        EXPECT_GT(compare(maps[0], maps[1]).relative_rmse, 2e-3) << text;
    }
}

TEST(Prefilter, TurningBothSourceAndResultChangesNothing) {
    const EnvironmentMap source = area_lights(256);
    EnvironmentMap turned_source = source;
    turned_source.axes = turned(source.axes, 0.7, 0.4, -1.1);
    for (const char* text : {"diffuse", "phong:100", "ggx:0.25", "ggx:0.05"}) {
        const PrefilterTarget straight = target(text, 9);
        PrefilterTarget askew = straight;
        askew.axes = turned(straight.axes, 0.7, 0.4, -1.1);
        EnvironmentMap result = fast(turned_source, askew);
        EXPECT_EQ(result.axes, askew.axes);
        result.axes = straight.axes;
        const Difference d = compare(result, fast(source, straight));
        // the one through rings of latitude, the other through eight taps each way, which for a
        // panorama that does not stand upright are this far off: 3.2e-4, 3.5e-3
        EXPECT_LT(d.relative_rmse, 5e-4) << text;
        EXPECT_LT(d.maximum_relative, 5e-3) << text;
    }
}

TEST(Prefilter, AxesOfAnyKindAgreeWithTheTruth) {
    const EnvironmentMap level = area_lights(128);
    const Axes frames[] = {turned(level.axes, 1.2), turned(level.axes, 0.3, 0.5, 0.2),
                           mirrored(level.axes), parse_axes("blender", Projection::equirect)};
    for (const Axes& axes : frames) {
        EnvironmentMap source = level;
        source.axes = axes;
        for (const Axes& to : frames) {
            PrefilterTarget t = target("ggx:0.4", 7);
            t.axes = to;
            const Measured m = measure(source, {t})[0];
            // 3.6e-4 measured where the panorama does not stand upright
            const bool upright = axes.y == Vec3d(0, 1, 0);
            EXPECT_LE(m.difference.relative_rmse, upright ? 1e-4 : 5e-4) << to_string(axes);
            if (!upright) continue;
            EXPECT_GE(m.estimate, m.difference.relative_rmse) << to_string(axes) << to_string(to);
        }
    }
}

// ---- Shapes ----

TEST(Prefilter, SeamsAreThoseOfTheTruth) {
    const EnvironmentMap source = area_lights(256);
    for (const char* text : {"diffuse", "phong:100", "ggx:0.25"}) {
        const double expected = seam_ratio(prefilter_reference(source, target(text, 16)));
        EXPECT_NEAR(seam_ratio(fast(source, target(text, 16))) / expected, 1, 1e-3) << text;
    }
}

struct Shape {
    Projection projection;
    int size;
};

TEST(Prefilter, EveryProjectionAsSource) {
    std::vector<EnvironmentMap> sources;
    for (std::size_t i = 0; i < kProjectionCount; ++i) {
        const auto projection = static_cast<Projection>(i);
        sources.push_back(noise(projection, size_for(projection, 128)));
        EnvironmentMap odd = noise(projection, projection == Projection::equirect ? 106 : 37);
        odd.axes = turned(odd.axes, 0.4, -0.2, 0.9);
        sources.push_back(std::move(odd));
    }
    for (const EnvironmentMap& source : sources) {
        const std::vector<PrefilterTarget> targets = {target("diffuse", 5), target("phong:100", 5),
                                                      target("ggx:0.5", 5), target("ggx:0.1", 5)};
        const std::vector<Measured> measured = measure(source, targets);
        for (std::size_t i = 0; i < targets.size(); ++i) {
            const std::string what = fmt::format("{} {} {}", name(source.projection),
                                                 source.width(), to_string(targets[i].lobe));
            record(what, measured[i]);
            EXPECT_LE(measured[i].difference.relative_rmse, 1e-4) << what;
            EXPECT_LE(measured[i].difference.maximum_relative, 1e-3) << what;
            EXPECT_GE(measured[i].estimate, measured[i].difference.relative_rmse) << what;
        }
    }
}

TEST(Prefilter, EveryProjectionAsTarget) {
    const EnvironmentMap source = area_lights(256);
    std::vector<PrefilterTarget> targets;
    for (std::size_t i = 0; i < kProjectionCount; ++i) {
        const auto projection = static_cast<Projection>(i);
        for (const char* text : {"diffuse", "ggx:0.4", "ggx:0.07"}) {
            targets.push_back(
                target(text, projection == Projection::equirect ? 26 : 13, projection));
            PrefilterTarget askew = targets.back();
            askew.axes = turned(askew.axes, 0.4, -0.2, 0.9);
            targets.push_back(askew);
        }
    }
    const std::vector<Measured> measured = measure(source, targets);
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const std::string what =
            fmt::format("{} {} {}", name(targets[i].projection), to_string(targets[i].lobe), i);
        record(what, measured[i]);
        EXPECT_LE(measured[i].difference.relative_rmse, 1e-4) << what;
        EXPECT_LE(measured[i].difference.maximum_relative, 1e-3) << what;
        EXPECT_GE(measured[i].estimate, measured[i].difference.relative_rmse) << what;
    }
}

TEST(Prefilter, SourcesOfAnySize) {
    const Shape shapes[] = {
        {Projection::equirect, 2},
        {Projection::equirect, 6},
        {Projection::equirect, 58},
        {Projection::equirect, 134},
        {Projection::equirect, 1000},
        {Projection::cube, 1},
        {Projection::cube, 2},
        {Projection::cube, 3},
        {Projection::cube, 50},
        {Projection::octahedral, 1},
        {Projection::octahedral, 3},
        {Projection::sphere, 1},
        {Projection::sphere, 5},
        {Projection::dual_paraboloid, 1},
        {Projection::dual_paraboloid, 3},
    };
    for (const Shape& shape : shapes) {
        const EnvironmentMap source = noise(shape.projection, shape.size);
        std::vector<PrefilterTarget> targets;
        for (const char* text : {"diffuse", "phong:10", "ggx:0.4", "ggx:0.05"})
            targets.push_back(target(text, shape.size > 500 ? 3 : 7));
        const std::vector<Measured> measured = measure(source, targets);
        for (std::size_t i = 0; i < targets.size(); ++i) {
            const std::string what = fmt::format("{} {} {}", name(shape.projection), shape.size,
                                                 to_string(targets[i].lobe));
            record(what, measured[i]);
            EXPECT_LE(measured[i].difference.relative_rmse, 1e-4) << what;
            EXPECT_GE(measured[i].estimate, measured[i].difference.relative_rmse) << what;
        }
    }
}

TEST(Prefilter, TargetsOfAnySize) {
    const EnvironmentMap source = area_lights(128);
    std::vector<PrefilterTarget> targets;
    for (const int size : {5, 6, 13, 23})
        for (const char* text : {"diffuse", "ggx:0.3"}) targets.push_back(target(text, size));
    const std::vector<Measured> measured = measure(source, targets);
    for (std::size_t i = 0; i < targets.size(); ++i) {
        EXPECT_LE(measured[i].difference.relative_rmse, 1e-4) << targets[i].size;
        EXPECT_GE(measured[i].estimate, measured[i].difference.relative_rmse) << targets[i].size;
    }
}

// ---- Plans ----

std::vector<PrefilterTarget> one_of_each() {
    return {target("mirror", 12),       target("ggx:0.1", 9),
            target("ggx:0.5", 7),       target("diffuse", 8),
            target("phong:1000000", 5), target("ggx:0.3", 20, Projection::octahedral)};
}

TEST(PrefilterPlan, ASecondMapComesOutAsByAFreshPlan) {
    const EnvironmentMap first = sun_over_dim_sky(128), second = area_lights(128);
    const std::vector<PrefilterTarget> targets = one_of_each();
    const PrefilterPlan plan(shape_of(first), targets);
    EXPECT_EQ(plan.source(), shape_of(first));
    ASSERT_EQ(plan.targets().size(), targets.size());
    Prefiltered reused = plan(first);
    const Prefiltered apart = plan(second), fresh = run(second, targets);
    plan(second, reused);
    for (std::size_t i = 0; i < targets.size(); ++i) {
        EXPECT_TRUE(same_bits(apart.maps[i], fresh.maps[i])) << i;
        EXPECT_TRUE(same_bits(reused.maps[i], fresh.maps[i])) << i;
        EXPECT_EQ(apart.errors[i], fresh.errors[i]);
        EXPECT_EQ(reused.errors[i], fresh.errors[i]);
        EXPECT_EQ(reused.maps[i].levels[0].lobe, targets[i].lobe);
    }
    EXPECT_EQ(fresh.errors[0], 0);
}

TEST(PrefilterPlan, WritesWhereItWasToldTo) {
    const EnvironmentMap source = area_lights(64);
    const PrefilterPlan plan(shape_of(source), one_of_each());
    Prefiltered result = plan(source);
    const float* const where = result.maps[1].levels[0].faces[0].values().data();
    plan(source, result);
    EXPECT_EQ(result.maps[1].levels[0].faces[0].values().data(), where);
}

TEST(PrefilterPlan, AResultOfAnotherPlanIsMadeAnew) {
    const EnvironmentMap source = area_lights(64);
    Prefiltered result = run(source, {target("ggx:0.5", 3)});
    const PrefilterPlan plan(shape_of(source), std::vector{target("ggx:0.4", 16)});
    plan(source, result);
    EXPECT_TRUE(same_bits(result.maps[0], plan(source).maps[0]));
    EXPECT_EQ(result.maps[0].levels[0].lobe, parse_lobe("ggx:0.4"));
}

TEST(PrefilterPlan, NoTargetsGiveNoMaps) {
    EXPECT_TRUE(run(area_lights(32), {}).maps.empty());
}

TEST(PrefilterPlan, SameBitsOnAnyNumberOfThreads) {
    const EnvironmentMap sources[] = {area_lights(128), noise(Projection::cube, 48),
                                      noise(Projection::octahedral, 33)};
    for (const EnvironmentMap& source : sources) {
        const Prefiltered expected = run(source, one_of_each());
        for (const int threads : {1, 2, 7}) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            const Prefiltered result = run(source, one_of_each());
            EXPECT_EQ(result.errors, expected.errors) << threads;
            for (std::size_t i = 0; i < result.maps.size(); ++i)
                EXPECT_TRUE(same_bits(result.maps[i], expected.maps[i])) << threads << " " << i;
        }
    }
}

TEST(PrefilterReference, SameBitsOnAnyNumberOfThreads) {
    const EnvironmentMap source = noise(Projection::cube, 24);
    const EnvironmentMap expected = prefilter_reference(source, target("ggx:0.4", 6));
    for (const int threads : {1, 2, 7}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        EXPECT_TRUE(same_bits(prefilter_reference(source, target("ggx:0.4", 6)), expected));
    }
}

// ---- What is refused ----

template <class F>
std::string refusal(const F& f) {
    try {
        f();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::usage);
        return error.what();
    }
    ADD_FAILURE() << "nothing was thrown";
    return {};
}

TEST(PrefilterPlan, ValuesThatAreNotFiniteAreRefused) {
    for (const Projection projection : {Projection::equirect, Projection::cube}) {
        const int size = projection == Projection::equirect ? 70 : 35;
        for (const float bad : {kNan, kInfinity, -kInfinity}) {
            EnvironmentMap source = make_environment_map(projection, size);
            const PrefilterPlan plan(shape_of(source), std::vector{target("ggx:0.5", 4)});
            // in a vector's middle, and in a row's last values
            for (const int x : {3, source.width() - 1}) {
                source.levels[0].faces.back().set_rgb(x, 7, {1, bad, 1});
                const std::string message = refusal([&] { (void)plan(source); });
                EXPECT_NE(message.find("row 7"), std::string::npos) << message;
                EXPECT_NE(message.find("not finite"), std::string::npos) << message;
                source.levels[0].faces.back().set_rgb(x, 7, {1, 1, 1});
            }
            EXPECT_NO_THROW((void)plan(source));
        }
    }
}

TEST(PrefilterPlan, HugeButFiniteValuesAreNot) {
    EnvironmentMap source = make_environment_map(Projection::equirect, 64);
    source.levels[0].faces[0].set_rgb(20, 10, {1e30f, 1e30f, 1e30f});
    const EnvironmentMap map = fast(source, target("ggx:0.5", 7));
    EXPECT_EQ(statistics(map).non_finite_count, 0);
    EXPECT_LE(compare(map, prefilter_reference(source, target("ggx:0.5", 7))).relative_rmse, 1e-4);
}

TEST(PrefilterPlan, OtherShapesAreRefused) {
    const EnvironmentMap planned = area_lights(64);
    const PrefilterPlan plan(shape_of(planned), std::vector{target("diffuse", 4)});
    EnvironmentMap turned_map = planned;
    turned_map.axes = turned(planned.axes, 0.1);
    for (const EnvironmentMap& source : {area_lights(32), noise(Projection::cube, 64), turned_map})
        EXPECT_NE(refusal([&] { (void)plan(source); }).find("shape"), std::string::npos);
}

TEST(PrefilterPlan, TolerancesOutOfRangeAreRefused) {
    const MapShape shape = shape_of(area_lights(32));
    for (const double tolerance :
         {0.0, -1e-4, 0.11, static_cast<double>(kNan), static_cast<double>(kInfinity)}) {
        const std::string message = refusal([&] {
            (void)PrefilterPlan(shape, std::vector{target("diffuse", 4)}, {.tolerance = tolerance});
        });
        EXPECT_NE(message.find("tolerance"), std::string::npos) << message;
    }
}

TEST(PrefilterPlan, SizesOutOfRangeAreRefused) {
    const std::vector ok{target("diffuse", 4)};
    (void)refusal([&] { (void)PrefilterPlan({Projection::equirect, 7, {}}, ok); });
    (void)refusal([&] { (void)PrefilterPlan({Projection::cube, 0, {}}, ok); });
    const MapShape shape = shape_of(area_lights(32));
    (void)refusal([&] { (void)PrefilterPlan(shape, std::vector{target("diffuse", 0)}); });
    (void)refusal([&] { (void)PrefilterPlan(shape, std::vector{target("mirror", -3)}); });
    (void)refusal([&] { (void)PrefilterPlan(shape, std::vector{target("table:unread", 4)}); });
}

}  // namespace
}  // namespace mirrorball
