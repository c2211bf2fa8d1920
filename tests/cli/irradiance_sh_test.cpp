// The nine coefficients that the program prints.
#include <cmath>

#include <nlohmann/json.hpp>

#include "program.h"

namespace mirrorball {
namespace {

nlohmann::json printed(std::vector<std::string> more) {
    std::vector<std::string> all = {"irradiance-sh", "builtin:white", "--json", "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = run(all);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
}

// White light of radiance 1: L_00 = sqrt(4 pi), E = pi, and nothing else.
TEST(IrradianceSh, WhiteIsOneNumberInEveryScale) {
    const double pi = 3.14159265358979, y00 = std::sqrt(1 / (4 * pi));
    const std::pair<const char*, double> expected[] = {
        {"radiance", 1 / y00}, {"irradiance", pi / y00}, {"outgoing", 1 / y00}, {"polynomial", 1},
        {"filament", 1},       {"three.js", 1 / y00},    {"unity", 1}};
    for (const auto& [scale, first] : expected) {
        const nlohmann::json json = printed({"--scale", scale});
        EXPECT_EQ(json["scale"], scale);
        ASSERT_EQ(json["coefficients"].size(), 9u);
        for (int i = 0; i < 9; ++i) {
            for (const double value : json["coefficients"][i]["rgb"])
                EXPECT_NEAR(value, i == 0 ? first : 0, 1e-4) << scale << " " << i;
        }
    }
    EXPECT_EQ(printed({})["scale"], "irradiance");
}

TEST(IrradianceSh, WindowsLowerDegrees) {
    const TemporaryFolder folder;
    const std::string sky = (folder / "sky.hdr").string();
    ASSERT_EQ(run({"sky", "sunset", "-o", sky, "--size", "32", "--quiet"}).code, 0);
    const auto of = [&](const std::string& window) {
        const Outcome outcome = run({"irradiance-sh", sky, "--json", "--window", window});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return nlohmann::json::parse(outcome.out)["coefficients"];
    };
    const auto none = of("none"), hanning = of("hanning");
    EXPECT_EQ(none[0]["rgb"], hanning[0]["rgb"]);
    EXPECT_NEAR(hanning[1]["rgb"][2].get<double>() / none[1]["rgb"][2].get<double>(), 0.75, 1e-6);
    EXPECT_NEAR(hanning[4]["rgb"][2].get<double>() / none[4]["rgb"][2].get<double>(), 0.25, 1e-6);
}

TEST(IrradianceSh, TextHasALineForEach) {
    const Outcome outcome = run({"irradiance-sh", "builtin:white", "--scale", "filament"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.err, "");
    for (const char* part : {"IndirectLight", "3z^2 - 1", "x^2 - y^2", " -2  xy"})
        EXPECT_NE(outcome.out.find(part), std::string::npos) << part << "\n" << outcome.out;
}

TEST(IrradianceSh, RefusesWhatIsNotThere) {
    expect_refused({"irradiance-sh", "builtin:white", "--scale", "blender"}, 2, "three.js");
    expect_refused({"irradiance-sh", "builtin:white", "--window", "hann"}, 2, "hanning");
    expect_refused({"irradiance-sh"}, 2, "IN");
    expect_refused({"irradiance-sh", "nowhere.hdr"}, 3, "nowhere.hdr");
}

}  // namespace
}  // namespace mirrorball
