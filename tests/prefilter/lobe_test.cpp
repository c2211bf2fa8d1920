#include <mirrorball/lobe.h>

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <mirrorball/error.h>
#include <mirrorball/prefilter.h>
#include <mirrorball/vector.h>

#include "support.h"

namespace mirrorball {
namespace {

const char* const kLobes[] = {"diffuse",       "phong:0",         "phong:1",         "phong:10",
                              "phong:1000",    "phong:100000",    "ggx:0.05",        "ggx:0.125",
                              "ggx:0.5",       "ggx:0.9",         "ggx:0.999",       "ggx:1",
                              "blinn-phong:0", "blinn-phong:1.5", "blinn-phong:400", "charlie:0.3",
                              "charlie:0.5",   "charlie:1"};

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
    // sin(60 degrees / 2)^(1/alpha) for alpha = 1/4, times the cosine; and 40 degrees
    const Lobe charlie = parse_lobe("charlie:0.5");
    EXPECT_NEAR(charlie.value(0.5) / charlie.value(std::cos(2 * kPi / 9)),
                std::pow(0.5 / std::sin(kPi / 9), 4) * 0.5 / std::cos(2 * kPi / 9), 1e-12);
    EXPECT_EQ(charlie.value(1), 0);
    EXPECT_EQ(charlie.value(-0.1), 0);
}

TEST(Lobe, TablesAreLinesBetweenTheirPoints) {
    // a cone of 60 degrees and a skirt to 120: normalised by hand
    const Lobe lobe = tabulated_lobe("cone", {0, kPi / 3, 2 * kPi / 3}, {2, 2, 0});
    const double cap = 2 * kPi * 2 * 0.5;  // 2 pi 2 (1 - cos 60)
    // 2 pi times the integral of sin(a) (2 - (a - a0) 2 / a0) from a0 to 2 a0, by parts
    const double a0 = kPi / 3;
    const double skirt = 2 * kPi * (2 * 0.5 - 2 / a0 * (std::sin(2 * a0) - std::sin(a0)));
    EXPECT_NEAR(lobe.value(0.8), 2 / (cap + skirt), 1e-14);
    EXPECT_NEAR(lobe.value(0), 1 / (cap + skirt), 1e-14);
    EXPECT_EQ(lobe.value(-0.6), 0);
    EXPECT_EQ(lobe.integral(), 1);
    EXPECT_NEAR(lobe.angle_holding(cap / (cap + skirt)), a0, 1e-12);
    // one that repeats a known lobe is that lobe, to the square of its step
    std::vector<double> angles, weights;
    for (int i = 0; i <= 900; ++i) {
        angles.push_back(i * kPi / 1800);
        weights.push_back(7 * std::cos(angles.back()));
    }
    const Lobe cosine = tabulated_lobe("cosine", angles, weights);
    for (const double t : {0.01, 0.3, 0.99}) EXPECT_NEAR(cosine.value(t), t / kPi, 1e-6);
}

TEST(Lobe, TablesAreReadFromFiles) {
    const TemporaryFolder folder;
    std::ofstream(folder / "felt.txt") << "# measured\n0 3\n 30\t1.5e0  # falling\r\n\n180 0";
    const Lobe lobe = read_lobe_table(folder / "felt.txt");
    EXPECT_EQ(to_string(lobe), "table:felt.txt");
    EXPECT_EQ(lobe, tabulated_lobe("felt.txt", {0, kPi / 6, kPi}, {3, 1.5, 0}));
    EXPECT_NE(lobe, tabulated_lobe("felt.txt", {0, kPi / 6, kPi}, {3, 1.4, 0}));
    // metadata know it by name
    const Lobe known = parse_lobe(to_string(lobe));
    EXPECT_EQ(to_string(known), "table:felt.txt");
    EXPECT_NE(known, lobe);
    EXPECT_EQ(known, parse_lobe("table:felt.txt"));
    EXPECT_THROW((void)known.value(0.5), Error);
}

TEST(Lobe, RefusesBadTables) {
    const TemporaryFolder folder;
    std::string many;
    for (int i = 0; i <= 4096; ++i) many += std::to_string(i * 0.01) + " 1\n";
    const struct {
        std::string text, said;
    } cases[] = {
        {"", "found 0 points"},
        {"# nothing\n\n", "found 0 points"},
        {"0 1\n", "found 1 points"},
        {many, "4096"},
        {std::string(2 << 20, ' '), "bytes"},
        {"0 1\nten 1\n", "line 2: found \"ten 1\""},
        {"0 1\n10\n", "line 2"},
        {"0 1\n10 1 1\n", "line 2"},
        {"0 1\n10,1\n", "line 2"},
        {std::string("0 1\n10 1\0 7\n", 13), "line 2"},
        {"0 nan\n10 1\n", "point 1 is nan"},
        {"0 1\n10 inf\n", "point 2 is inf"},
        {"0 1\n10 -1\n", "point 2 is -1"},
        {"0 1\nnan 1\n", "angle of point 2"},
        {"-1 1\n10 1\n", "angle of point 1"},
        {"0 1\n181 1\n", "angle of point 2"},
        {"0 1\n10 1\n10 2\n", "not above"},
        {"0 1\n20 1\n10 2\n", "not above"},
        {"0 0\n20 0\n", "all weights are 0"},
        {"0 1e308\n1e-300 0\n", "too narrow"},
    };
    for (const auto& [text, said] : cases) {
        std::ofstream(folder / "bad.txt") << text;
        try {
            (void)read_lobe_table(folder / "bad.txt");
            ADD_FAILURE() << text.substr(0, 40);
        } catch (const Error& e) {
            EXPECT_EQ(e.code(), Errc::cannot_read);
            EXPECT_NE(std::string(e.what()).find("bad.txt"), std::string::npos) << e.what();
            EXPECT_NE(std::string(e.what()).find(said), std::string::npos) << e.what();
        }
    }
    EXPECT_THROW((void)read_lobe_table(folder / "missing.txt"), Error);
    EXPECT_THROW((void)read_lobe_table(folder.path()), Error);
    std::ofstream(folder / "a,b.txt") << "0 1\n9 0\n";
    EXPECT_THROW((void)read_lobe_table(folder / "a,b.txt"), Error);
    EXPECT_THROW((void)tabulated_lobe("x", {0, 1}, {1}), Error);
}

TEST(Lobe, TextComesBack) {
    for (const char* text : kLobes) EXPECT_EQ(to_string(parse_lobe(text)), text);
    EXPECT_EQ(to_string(parse_lobe("mirror")), "mirror");
    EXPECT_EQ(to_string(parse_lobe("ggx:0.30000000000000004")), "ggx:0.30000000000000004");
}

TEST(Lobe, RefusesWhatIsNone) {
    for (const char* text :
         {"",          "gloss",    "ggx",       "ggx:",          "ggx:1.5",     "ggx:-0.1",
          "ggx:nan",   "ggx:inf",  "phong:-1",  "phong:ten",     "phong:inf",   "diffuse:1",
          "phong:10 ", "charlie",  "charlie:0", "charlie:0.009", "charlie:1.1", "table",
          "table:",    "table:a,b"}) {
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
    EXPECT_EQ(to_string(level_lobes("cmft-phongbrdf", 11)[0]), "phong:2049");
    EXPECT_EQ(to_string(level_lobes("cmft-phongbrdf", 11)[10]), "phong:3");
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

TEST(LevelLobes, GoOnWithTheWidestWhereTheProgramStops) {
    EXPECT_NEAR(roughness("unity", 11, 12), 1, 1e-12);
    EXPECT_EQ(to_string(level_lobes("playcanvas", 12)[11]), "phong:1");
    EXPECT_EQ(to_string(level_lobes("unreal", 14)[13]), "ggx:1");
    for (const std::string& mapping : level_mappings()) {
        EXPECT_EQ(level_lobes(mapping, 21).size(), 21u) << mapping;
        for (const Lobe& lobe : level_lobes(mapping, 21))
            EXPECT_EQ(parse_lobe(to_string(lobe)), lobe) << mapping;
    }
}

}  // namespace
}  // namespace mirrorball
