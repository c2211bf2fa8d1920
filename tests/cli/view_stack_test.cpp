// mirrorball view-stack, and prefilter by a BRDF seen from one side.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include <nlohmann/json.hpp>

#include "program.h"

namespace mirrorball {
namespace {

using Json = nlohmann::json;

TEST(ViewStackVerb, WritesAMapPerView) {
    const TemporaryFolder folder;
    const std::string target = (folder / "stack").string();
    const Outcome outcome =
        run({"view-stack", "builtin:noon", "-o", target, "--brdf", "ggx:roughness=0.5",
             "--elevations", "3", "--azimuths", "2", "--size", "8", "--checks", "4", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json json = Json::parse(outcome.out);
    std::ifstream file(folder / "stack" / "stack.json");
    EXPECT_EQ(Json::parse(file), json);
    ASSERT_EQ(json["layers"].size(), 6u);
    EXPECT_GT(json["fit_error"], 0);
    for (const Json& layer : json["layers"]) {
        const auto axis = layer["axis"].get<std::vector<double>>();
        EXPECT_NEAR(std::hypot(axis[0], axis[1], axis[2]), 1, 1e-9);
        EXPECT_GT(layer["albedo"][0], 0.5);
        EXPECT_LE(layer["albedo"][0], 1);
        const std::string name = layer["file"];
        const Json info =
            Json::parse(run({"info", (folder / "stack" / name).string(), "--json"}).out);
        EXPECT_EQ(info["projection"], "cube") << name;
    }
    EXPECT_NEAR(json["layers"][5]["view_to_normal_degrees"], 85, 1e-9);
    EXPECT_NEAR(json["layers"][5]["view_to_tangent_degrees"], 180, 1e-9);
}

TEST(ViewStackVerb, LeavesNothingBehindWhenItFails) {
    const TemporaryFolder folder;
    const std::string target = (folder / "stack").string();
    expect_refused({"view-stack", "missing.hdr", "-o", target, "--brdf", "lambert"}, 3,
                   "missing.hdr");
    EXPECT_FALSE(std::filesystem::exists(target));
    expect_refused({"view-stack", "builtin:noon", "-o", target, "--brdf", "velours"}, 2, "velours");
    expect_refused({"view-stack", "builtin:noon", "-o", target, "--brdf", "gone.binary"}, 3,
                   "gone.binary");
    expect_refused({"view-stack", "builtin:noon", "-o", target, "--brdf", "ggx:roughness=2"}, 2,
                   "roughness");
    expect_refused(
        {"view-stack", "builtin:noon", "-o", target, "--brdf", "lambert", "--elevations", "0"}, 2,
        "--elevations");
    expect_refused({"view-stack", "builtin:noon", "-o", "/nowhere/x", "--brdf", "lambert"}, 4,
                   "/nowhere");
}

// Values of a PFM, whose header is three lines.
std::vector<float> values_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::string line;
    for (int i = 0; i < 3; ++i) std::getline(file, line);
    std::vector<float> values;
    for (float value; file.read(reinterpret_cast<char*>(&value), sizeof value);)
        values.push_back(value);
    return values;
}

// A matte surface shows irradiance times its reflectance over pi, from everywhere.
TEST(PrefilterVerb, TakesABrdf) {
    const TemporaryFolder folder;
    const std::string matte = (folder / "matte.pfm").string(),
                      diffuse = (folder / "diffuse.pfm").string();
    const auto prefilter = [&](const std::string& target, std::vector<std::string> lobe) {
        std::vector<std::string> words = {"prefilter", "builtin:noon", "-o", target,  "--to",
                                          "equirect",  "--size",       "16", "--json"};
        words.insert(words.end(), lobe.begin(), lobe.end());
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return Json::parse(outcome.out);
    };
    const Json json = prefilter(matte, {"--lobe", "brdf:lambert:0.5", "--view", "70"});
    EXPECT_NEAR(json["brdf"]["albedo"][1], 0.5, 1e-3);
    EXPECT_NEAR(json["brdf"]["axis_degrees"], 0, 0.5);
    prefilter(diffuse, {"--lobe", "diffuse"});
    const std::vector<float> found = values_of(matte), irradiance = values_of(diffuse);
    ASSERT_EQ(found.size(), 16u * 8 * 3);
    ASSERT_EQ(irradiance.size(), found.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double expected = irradiance[i] * 0.5 / std::acos(-1.0);
        EXPECT_NEAR(found[i], expected, 0.02 * expected);
    }
}

TEST(PrefilterVerb, RefusesBrdfsThatAreNoLobes) {
    const TemporaryFolder folder;
    const std::string out = (folder / "a.exr").string();
    expect_refused({"prefilter", "builtin:noon", "-o", out, "--lobe", "brdf:mirror"}, 2,
                   "--lobe mirror");
    expect_refused({"prefilter", "builtin:noon", "-o", out, "--lobe", "brdf:phong:-1"}, 2,
                   "exponent");
    expect_refused({"prefilter", "builtin:noon", "-o", out, "--lobe", "brdf:ggx", "--view", "90"},
                   2, "--view");
    expect_refused({"prefilter", "builtin:noon", "-o", out, "--lobe", "diffuse", "--view", "10"}, 2,
                   "--view");
    EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace mirrorball
