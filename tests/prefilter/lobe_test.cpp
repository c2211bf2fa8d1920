#include <mirrorball/lobe.h>

#include <cmath>

#include <gtest/gtest.h>
#include <mirrorball/error.h>
#include <mirrorball/prefilter.h>
#include <mirrorball/vector.h>

namespace mirrorball {
namespace {

const char* const kLobes[] = {"diffuse",       "phong:0",         "phong:1",        "phong:10",
                              "phong:1000",    "phong:100000",    "ggx:0.05",       "ggx:0.125",
                              "ggx:0.5",       "ggx:0.9",         "ggx:0.999",      "ggx:1",
                              "blinn-phong:0", "blinn-phong:1.5", "blinn-phong:400"};

// The integral over the cap of a given angle, by the midpoint rule in a variable that spends its
// points near the axis: theta = angle x^4.
double integrate(const Lobe& lobe, double angle) {
    constexpr int count = 20000;
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        const double x = (i + 0.5) / count, theta = angle * x * x * x * x;
        sum +=
            lobe.value(std::cos(theta)) * 2 * kPi * std::sin(theta) * 4 * angle * x * x * x / count;
    }
    return sum;
}

TEST(Lobe, IntegratesToWhatItPromises) {
    for (const char* text : kLobes) {
        const Lobe lobe = parse_lobe(text);
        EXPECT_NEAR(integrate(lobe, kPi / 2) / lobe.integral(), 1, 2e-6) << text;
    }
}

TEST(Lobe, AngleHoldsItsShare) {
    for (const char* text : kLobes) {
        const Lobe lobe = parse_lobe(text);
        for (const double share : {0.1, 0.5, 0.9, 0.999}) {
            const double angle = lobe.angle_holding(share);
            EXPECT_NEAR(integrate(lobe, angle) / lobe.integral(), share, 3e-6)
                << text << " " << share;
        }
    }
    EXPECT_EQ(parse_lobe("mirror").angle_holding(0.999), 0);
}

// Values worked out by hand.
TEST(Lobe, Values) {
    EXPECT_DOUBLE_EQ(parse_lobe("diffuse").value(0.25), 0.25);
    EXPECT_DOUBLE_EQ(parse_lobe("diffuse").value(-0.25), 0);
    EXPECT_NEAR(parse_lobe("phong:3").value(0.5), 4 / (2 * kPi) * 0.125, 1e-15);
    // alpha = 1: D is constant, and what is left is the cosine
    EXPECT_NEAR(parse_lobe("ggx:1").value(0.5), 0.5 / kPi, 1e-12);
    // D(60 degrees / 2) / D(0) for alpha = 1/4, times the cosine
    const double a2 = 1.0 / 16, ratio = std::pow(a2 / ((a2 - 1) * 0.75 + 1), 2) * 0.5;
    EXPECT_NEAR(parse_lobe("ggx:0.5").value(0.5) / parse_lobe("ggx:0.5").value(1), ratio, 1e-12);
    EXPECT_NEAR(parse_lobe("blinn-phong:4").value(0.5) / parse_lobe("blinn-phong:4").value(1),
                0.75 * 0.75 * 0.5, 1e-12);
    EXPECT_TRUE(std::isinf(parse_lobe("ggx:0").value(1)));
}

TEST(Lobe, TextComesBack) {
    for (const char* text : kLobes) EXPECT_EQ(to_string(parse_lobe(text)), text);
    EXPECT_EQ(to_string(parse_lobe("mirror")), "mirror");
    EXPECT_EQ(to_string(parse_lobe("ggx:0.30000000000000004")), "ggx:0.30000000000000004");
}

TEST(Lobe, RefusesWhatIsNone) {
    for (const char* text :
         {"", "gloss", "ggx", "ggx:", "ggx:1.5", "ggx:-0.1", "ggx:nan", "ggx:inf", "phong:-1",
          "phong:ten", "phong:inf", "diffuse:1", "phong:10 "}) {
        try {
            (void)parse_lobe(text);
            ADD_FAILURE() << text;
        } catch (const Error& e) {
            EXPECT_EQ(e.code(), Errc::usage) << text;
        }
    }
}

double roughness(const char* mapping, int level, int count) {
    return level_lobes(mapping, count)[level].parameter;
}

// The table of docs/conventions.md, forwards: what level does the program give this roughness?
TEST(LevelLobes, FollowTheProgramsMappings) {
    EXPECT_DOUBLE_EQ(roughness("gltf", 3, 9), 0.375);
    for (int level = 0; level < 5; ++level) {
        const double r = roughness("filament", level, 5);
        EXPECT_NEAR(4 * r * (2 - r), level, 1e-12);
    }
    for (int level = 0; level < 7; ++level) {
        const double r = roughness("unity", level, 7);
        EXPECT_NEAR(6 * r * (1.7 - 0.7 * r), level, 1e-12);
    }
    for (int level = 2; level < 8; ++level) {
        const double r = roughness("unreal", level, 10);
        EXPECT_NEAR(10 - 1 - (1 - 1.2 * std::log2(r)), level, 1e-12);
    }
    EXPECT_EQ(to_string(level_lobes("playcanvas", 6)[0]), "mirror");
    EXPECT_EQ(to_string(level_lobes("playcanvas", 6)[3]), "phong:32");
    EXPECT_EQ(to_string(level_lobes("cmft", 11)[0]), "phong:2048");
    EXPECT_EQ(to_string(level_lobes("cmft", 11)[10]), "phong:2");
    for (const std::string& mapping : level_mappings()) {
        double widest = 0;
        for (const int count : {1, 2, 9})
            for (const Lobe& lobe : level_lobes(mapping, count)) {
                if (count < 9) continue;
                const double angle = lobe.angle_holding(0.5);
                EXPECT_GE(angle, widest) << mapping << ": a level is sharper than the one before";
                widest = angle;
            }
    }
    EXPECT_THROW((void)level_lobes("quake", 4), Error);
}

}  // namespace
}  // namespace mirrorball
