// mirrorball brdf and mirrorball fresnel: figures, files, plots, and what they refuse.
#include <nlohmann/json.hpp>

#include "program.h"

namespace mirrorball {
namespace {

using Json = nlohmann::json;

TEST(BrdfVerb, ChecksLaws) {
    const Outcome outcome = run({"brdf", "phong-lewis:50", "--check", "--json", "--quiet"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json json = Json::parse(outcome.out);
    EXPECT_EQ(json["brdf"], "phong-lewis:exponent=50,reflectance=1");
    EXPECT_FALSE(json["laws"]["reciprocal"]);
    EXPECT_FALSE(json["laws"]["conserves_energy"]);
    EXPECT_TRUE(json["laws"]["isotropic"]);
    EXPECT_TRUE(json["laws"]["positive"]);
    EXPECT_GT(json["reciprocity"]["largest"], 0.9);
    EXPECT_NEAR(json["albedo"][0]["albedo"]["value"][0], 51.0 / 52, 1e-4);
    EXPECT_NEAR(json["albedo"][0]["uniform_light"]["value"][1], 1, 1e-6);
    EXPECT_GT(json["mean_albedo"]["error"], 0);
}

TEST(BrdfVerb, SaysItInWordsToo) {
    const Outcome outcome = run({"brdf", "brushed gold", "--check", "--quiet"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    for (const char* part :
         {"ggx:roughness-x=0.25,roughness-y=0.6,metal=gold", "reciprocal   yes", "energy kept  yes",
          "isotropic    NO", "positive     yes", "albedo", "89.5°"})
        EXPECT_NE(outcome.out.find(part), std::string::npos) << part << outcome.out;
    // the same at any number of threads
    EXPECT_EQ(run({"brdf", "brushed gold", "--check", "--threads", "1"}).out, outcome.out);
    EXPECT_EQ(run({"brdf", "brushed gold", "--check", "--threads", "3"}).out, outcome.out);
}

TEST(BrdfVerb, Lists) {
    const std::string text = run({"brdf", "--list"}).out;
    for (const char* name : {"oren-nayar", "lafortune", "merl", "table", "brushed-gold", "velvet"})
        EXPECT_NE(text.find(name), std::string::npos) << name;
    const Json json = Json::parse(run({"brdf", "--list", "--json"}).out);
    EXPECT_GT(json["models"].size(), 15u);
    EXPECT_GT(json["presets"].size(), 40u);
}

TEST(BrdfVerb, DrawsPlots) {
    const TemporaryFolder folder;
    const std::string polar = (folder / "polar.svg").string(),
                      lobe = (folder / "lobe.svg").string(),
                      albedo = (folder / "albedo.svg").string();
    const Outcome outcome = run({"brdf", "0.5*lambert + 0.5*phong:20 + <&", "--plot", polar});
    EXPECT_EQ(outcome.code, 2);
    ASSERT_EQ(run({"brdf", "0.5*lambert + 0.3*ggx:0.3,metal=gold + 0.1*mirror", "--plot", polar,
                   "--hemisphere", lobe, "--albedo", albedo, "--angles", "10,70.5"})
                  .out,
              polar + "\n" + lobe + "\n" + albedo + "\n");
    for (const std::string& file : {polar, lobe, albedo}) {
        const std::string svg = contents(file);
        EXPECT_EQ(svg.compare(0, 5, "<svg "), 0) << file;
        EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n") << file;
        EXPECT_EQ(svg.find("nan"), std::string::npos) << file;
        EXPECT_EQ(svg.find("inf"), std::string::npos) << file;
        EXPECT_NE(svg.find("ggx:0.3,metal=gold"), std::string::npos) << file;  // the title
    }
    EXPECT_NE(contents(polar).find("light from 70.5°"), std::string::npos);
    EXPECT_NE(contents(lobe).find("mirror 0.1"), std::string::npos);
    // black and a bare mirror have no lobe, and are drawn all the same
    for (const char* name : {"lambert:0", "mirror"}) {
        EXPECT_EQ(
            run({"brdf", name, "--plot", polar, "--hemisphere", lobe, "--albedo", albedo}).code, 0);
        EXPECT_EQ(contents(polar).find("nan"), std::string::npos) << name;
        EXPECT_EQ(contents(lobe).find("nan"), std::string::npos) << name;
    }
}

TEST(BrdfVerb, RefusesInWords) {
    const TemporaryFolder folder;
    const std::string short_file = (folder / "short.binary").string();
    write_contents(short_file, std::string("\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0", 12));
    expect_refused({"brdf"}, 2, "NAME is missing");
    expect_refused({"brdf", "gloss"}, 2, "no BRDF \"gloss\"; there are lambert");
    expect_refused({"brdf", "ggx:index=-1"}, 2, "index is -1; expected a number from 0.01 to 100");
    expect_refused({"brdf", "ggx:roughness=1.5"}, 2,
                   "roughness is 1.5; expected a number from 0 to 1");
    expect_refused({"brdf", "phong:-2"}, 2, "exponent is -2");
    expect_refused({"brdf", "phong:nan"}, 2, "exponent is nan");
    expect_refused({"brdf", "merl:" + (folder / "absent").string()}, 3, "absent");
    expect_refused({"brdf", "merl:" + short_file}, 3, "truncated: 12 bytes");
    expect_refused({"brdf", "table:" + short_file}, 3, "line 1");
    expect_refused({"brdf", "gold", "--angles", "90"}, 2, "--angles");
    expect_refused({"brdf", "gold", "--angles", "1,2,3,4,5,6,7,8,9"}, 2, "room for 8");
    expect_refused({"brdf", "gold", "--plot", (folder / "a.png").string()}, 2, "plots are .svg");
    expect_refused({"brdf", "gold", "--plot", "/nowhere/a.svg"}, 4, "/nowhere/a.svg");
    EXPECT_EQ(files_in(folder.path()).size(), 1u);
}

TEST(FresnelVerb, WritesTheMap) {
    const TemporaryFolder folder;
    const std::string csv = (folder / "f.csv").string(), exr = (folder / "f.exr").string(),
                      png = (folder / "f.png").string(), svg = (folder / "f.svg").string();
    const Outcome outcome =
        run({"fresnel", "index=1.5", "-o", csv, "--samples", "3", "--plot", svg, "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    // float32, in nine digits; at 60 degrees 0.0892
    EXPECT_EQ(contents(csv),
              "cos_theta,r,g,b\n0,1,1,1\n0.5,0.0891867131,0.0891867131,0.0891867131\n"
              "1,0.0399999991,0.0399999991,0.0399999991\n");
    const Json json = Json::parse(outcome.out);
    EXPECT_NEAR(json["normal"][0], 0.04, 1e-12);
    EXPECT_NEAR(json["mean"][0], 0.0918, 1e-4);
    EXPECT_GT(json["interpolation_error"]["largest"], 0.1);
    EXPECT_EQ(contents(svg).compare(0, 5, "<svg "), 0);

    for (const std::string& file : {exr, png})
        ASSERT_EQ(run({"fresnel", "metal=gold,coat=1.5", "-o", file, "--samples", "64"}).code, 0);
    EXPECT_EQ(contents(exr).substr(0, 4), "\x76\x2f\x31\x01");
    EXPECT_EQ(contents(png).substr(16, 8), std::string("\0\0\0\x40\0\0\0\x01", 8));  // 64 x 1
    EXPECT_EQ(contents(png)[24], 16);                                                // bits
}

TEST(FresnelVerb, RefusesInWords) {
    const TemporaryFolder folder;
    expect_refused({"fresnel"}, 2, "SURFACE is missing");
    expect_refused({"fresnel", "index=0"}, 2, "index is 0; expected a number from 0.01 to 100");
    expect_refused({"fresnel", "metal=brass"}, 2, "there are gold");
    expect_refused({"fresnel", "glass"}, 2, "Fresnel \"glass\"");
    expect_refused({"fresnel", "index=1.5", "--samples", "1"}, 2, "--samples");
    expect_refused({"fresnel", "index=1.5", "-o", (folder / "a.doc").string()}, 2, "a.doc");
    expect_refused({"fresnel", "index=1.5", "-o", "/nowhere/a.csv"}, 4, "/nowhere/a.csv");
    EXPECT_TRUE(files_in(folder.path()).empty());
}

}  // namespace
}  // namespace mirrorball
