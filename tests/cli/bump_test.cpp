// mirrorball bump: what files hold after it, and what it refuses.
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

#include <mirrorball/bump.h>
#include <mirrorball/io.h>

#include "program.h"

namespace mirrorball {
namespace {

using Json = nlohmann::json;

class BumpVerb : public testing::Test {
  protected:
    [[nodiscard]] std::string file(const std::string& name) const {
        return (folder_ / name).string();
    }
    static Outcome must(const std::vector<std::string>& arguments) {
        Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return outcome;
    }
    static Image read(const std::string& path) {
        return read_image(path, {.transfer = Transfer::linear});
    }
    // Grows to the right by 1 from edge to edge, and a third of that upwards.
    [[nodiscard]] std::string ramp(const std::string& name, float factor = 1) const {
        Image image(16, 8, 1);
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 16; ++x)
                *image.at(x, y) =
                    factor * (static_cast<float>(x) / 16 + static_cast<float>(7 - y) / 48);
        write_image(file(name), image,
                    {.format = TexelFormat::rgba32f, .transfer = Transfer::linear});
        return file(name);
    }
    TemporaryFolder folder_;
};

TEST_F(BumpVerb, RampTiltsTheNormalByItsAngle) {
    // 1/2 m over 2 m to the right; 1/6 m over 1 m upwards, of which 7/8 lie between the rows.
    const std::vector<std::string> line = {"bump",    ramp("r.exr"), "--scale", "0.5",
                                           "--width", "2",           "--wrap",  "clamp"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), line.begin(), line.end());
        return more;
    };
    const double du = 0.25, dv = 0.5 / 48 * 8;
    must(with({"--to", "dudv", "-o", file("d.exr")}));
    EXPECT_NEAR(read(file("d.exr")).rgb(7, 3).x, du, 1e-5);
    EXPECT_NEAR(read(file("d.exr")).rgb(0, 7).y, dv, 1e-5);
    must(with({"-o", file("n.png")}));
    const Vec3f n = read(file("n.png")).rgb(7, 3) * 2.0f - Vec3f(1);
    EXPECT_NEAR(-n.x / n.z, du, 1e-4);  // 16 bits
    EXPECT_NEAR(-n.y / n.z, dv, 1e-4);
    must(with({"-o", file("down.png"), "--green", "down", "--format", "unorm8"}));
    const Vec3f down = read(file("down.png")).rgb(7, 3) * 2.0f - Vec3f(1);
    EXPECT_NEAR(down.y / down.z, dv, 0.01);  // 8 bits
    EXPECT_NEAR(-down.x / down.z, du, 0.01);
}

TEST_F(BumpVerb, NormalMapsAreStoredWithoutACurve) {
    for (const char* name : {"flat.png", "flat.tif", "flat.exr"}) {
        must({"bump", "builtin:flat", "-o", file(name), "--size", "4"});
        EXPECT_NEAR(read(file(name)).rgb(2, 2).x, 0.5, 1e-5) << name;
        const Json json = Json::parse(must({"bump", file(name), "--from", "normal", "--to", "dudv",
                                            "-o", file("back.exr"), "--json"})
                                          .out);
        EXPECT_EQ(json["steepest_degrees"], 0) << name;
    }
    // A file that states no sRGB: a loader that follows such statements leaves the codes alone.
    EXPECT_EQ(contents(file("flat.png")).find("sRGB"), std::string::npos);
    EXPECT_EQ(contents(file("flat.png")).find("gAMA"), std::string::npos);
}

TEST_F(BumpVerb, KindsComeBack) {
    must({"bump", "builtin:hammered", "-o", file("n.exr"), "--size", "64"});
    must({"bump", file("n.exr"), "--from", "normal", "--to", "dudv", "-o", file("d.exr")});
    must({"bump", file("d.exr"), "--from", "dudv", "-o", file("m.exr")});
    must({"bump", file("n.exr"), "-o", file("d3d.exr"), "--green", "down"});
    must({"bump", file("d3d.exr"), "-o", file("gl.exr"), "--from-green", "down"});
    must({"bump", "builtin:hammered", "--to", "height", "-o", file("h.png"), "--size", "64"});
    const Image before = read(file("n.exr")), after = read(file("m.exr"));
    const Image down = read(file("d3d.exr")), up = read(file("gl.exr"));
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            EXPECT_NEAR((before.rgb(x, y) - after.rgb(x, y)).length(), 0, 5e-7);
            EXPECT_NEAR((before.rgb(x, y) - up.rgb(x, y)).length(), 0, 5e-7);
            EXPECT_NEAR(before.rgb(x, y).y + down.rgb(x, y).y, 1, 5e-7);
        }
}

// The note of a written height map is a command that reads it.
TEST_F(BumpVerb, HeightsOfIntegersComeBackByTheScaleThatIsTold) {
    const std::string note =
        must({"bump", "builtin:noise", "--to", "height", "-o", file("h.png"), "--size", "64"}).err;
    const auto at = note.find("--scale ");
    ASSERT_NE(at, std::string::npos) << note;
    const std::string scale = note.substr(at + 8, note.find(' ', at + 8) - at - 8);
    must({"bump", "builtin:noise", "--to", "dudv", "-o", file("a.exr"), "--size", "64"});
    must({"bump", file("h.png"), "--to", "dudv", "-o", file("b.exr"), "--scale", scale, "--width",
          "1"});
    const Image a = read(file("a.exr")), b = read(file("b.exr"));
    // Half a code of 0.05 m / 65535, over a texel, weights up to 18/12 together.
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) EXPECT_NEAR(a.rgb(x, y).x, b.rgb(x, y).x, 1e-4);
}

TEST_F(BumpVerb, SlopesOfIntegersReachAsFarAsTheRange) {
    must({"bump", "builtin:bark", "--to", "dudv", "-o", file("a.exr"), "--size", "64"});
    must({"bump", "builtin:bark", "--to", "dudv", "-o", file("a.png"), "--size", "64", "--range",
          "4"});
    must({"bump", file("a.png"), "--from", "dudv", "--to", "dudv", "--range", "4", "-o",
          file("b.exr")});
    const Image a = read(file("a.exr")), b = read(file("b.exr"));
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            EXPECT_NEAR((a.rgb(x, y) - b.rgb(x, y)).length(), 0, 2 * 8.0 / 65535);
    EXPECT_NE(must({"bump", "builtin:bark", "--to", "dudv", "-o", file("a.png"), "--size", "64",
                    "--range", "0.01"})
                  .err.find("--range widens it"),
              std::string::npos);
}

TEST_F(BumpVerb, TimeMovesWhatMoves) {
    must({"bump", "builtin:waves", "-o", file("0.png"), "--size", "64"});
    must({"bump", "builtin:waves", "-o", file("1.png"), "--size", "64", "--time", "0.5"});
    must({"bump", "builtin:waves", "-o", file("2.png"), "--size", "64", "--time", "0.5"});
    EXPECT_NE(contents(file("0.png")), contents(file("1.png")));
    EXPECT_EQ(contents(file("1.png")), contents(file("2.png")));
    expect_refused({"bump", "builtin:bark", "-o", file("b.png"), "--time", "1"}, 2,
                   "bark does not move");
}

TEST_F(BumpVerb, TellsFactsAsJson) {
    const Json sources = Json::parse(must({"bump", "--list", "--json"}).out)["sources"];
    EXPECT_EQ(sources.size(), bump_sources().size());
    EXPECT_NE(must({"bump", "--list"}).out.find("hammered"), std::string::npos);
    const Json json = Json::parse(
        must({"bump", "builtin:waves", "-o", file("w.png"), "--size", "50", "--json"}).out);
    EXPECT_EQ(json["metres"]["width"], 16.0);
    EXPECT_EQ(json["green"], "up");
    ASSERT_EQ(json["levels"].size(), 6u);
    EXPECT_EQ(json["levels"][0]["alpha"], 0);
    // All of the slopes have become roughness at the last, and both measures say about the same.
    EXPECT_GT(json["levels"][5]["alpha"], 0.05);
    EXPECT_NEAR(json["levels"][5]["alpha"], json["levels"][5]["alpha_toksvig"], 0.02);
}

TEST_F(BumpVerb, SaysWhatItGuessesAndWhatIsOdd) {
    EXPECT_NE(must({"bump", ramp("r.exr"), "-o", file("n.png")}).err.find("is no tile"),
              std::string::npos);
    EXPECT_EQ(
        must({"bump", ramp("r.exr"), "-o", file("n.png"), "--wrap", "clamp", "--from", "height"})
            .err,
        "");
    EXPECT_NE(must({"bump", file("n.png"), "-o", file("m.png")}).err.find("taken as a normal map"),
              std::string::npos);
    const Outcome flat = must({"bump", ramp("f.exr", 0), "-o", file("n.png")});
    EXPECT_NE(flat.err.find("all heights are 0 m: the result is flat"), std::string::npos);
    write_image(file("grey.png"), Image(4, 4, 3));
    EXPECT_NE(must({"bump", file("grey.png"), "--from", "normal", "-o", file("n.png")})
                  .err.find("point into the surface"),
              std::string::npos);
    for (const char* to : {"normal", "dudv", "height"}) {
        write_image(file("one.exr"), Image(1, 1, 1));
        must({"bump", file("one.exr"), "-o", file("one.png"), "--to", to});
        EXPECT_EQ(read(file("one.png")).width(), 1);
    }
}

TEST_F(BumpVerb, LevelsHoldWhatTheyLose) {
    must({"bump", "builtin:noise", "-o", file("n.ktx2"), "--levels", "--size", "48", "--format",
          "rgba32f"});
    const FileContents contents = read_file(file("n.ktx2"));
    const std::vector<BumpLevel> expected = bump_levels(slopes(make_bump("noise", 48, 48)));
    ASSERT_EQ(contents.levels.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const Image& level = contents.levels[i][0];
        ASSERT_EQ(level.width(), expected[i].mean.width());
        ASSERT_EQ(level.channels(), 4);
        const int x = level.width() / 2, y = level.height() / 3;
        const double alpha = std::sqrt(2 * covariance(expected[i], x, y).mean());
        EXPECT_NEAR(level.at(x, y)[3], alpha, 1e-6) << i;
        const Vec3f n = level.rgb(x, y) * 2.0f - Vec3f(1);
        EXPECT_NEAR(n.length(), 1, 1e-6) << i;
        EXPECT_NEAR(-n.x / n.z, expected[i].mean.at(x, y)[0], 1e-5) << i;
        EXPECT_NEAR(-n.y / n.z, expected[i].mean.at(x, y)[1], 1e-5) << i;
    }
    must({"bump", "builtin:noise", "-o", file("h.ktx2"), "--levels", "--size", "8", "--to",
          "height"});
    EXPECT_EQ(read_file(file("h.ktx2")).levels.size(), 4u);
    const Outcome png = run({"bump", "builtin:noise", "-o", file("n.png"), "--levels"});
    EXPECT_EQ(png.code, 2);
    EXPECT_NE(png.err.find("hold one level"), std::string::npos) << png.err;
}

TEST_F(BumpVerb, RefusesWhatItCannotDo) {
    const std::string out = file("out.png"), grey = ramp("r.exr");
    must({"bump", "builtin:noise", "-o", file("n.png"), "--size", "8"});
    Image bad(4, 4, 1);
    *bad.at(1, 2) = std::numeric_limits<float>::infinity();
    write_image(file("bad.pfm"), bad, {});
    const auto before = files_in(folder_.path());
    expect_refused({"bump", file("bad.pfm"), "-o", out}, 3, "column 1, row 2");
    expect_refused({"bump", grey, "--from", "normal", "-o", out}, 3, "no normal map");
    expect_refused({"bump", file("n.png"), "--to", "height", "-o", out}, 2, "do not follow");
    expect_refused({"bump", "-o", out}, 2, "IN is missing");
    expect_refused({"bump", grey}, 2, "--output FILE is missing");
    expect_refused({"bump", "builtin:wavs", "-o", out}, 2, "did you mean \"waves\"?");
    expect_refused({"bump", grey, "-o", out, "--to", "hight"}, 2, "did you mean \"height\"?");
    expect_refused({"bump", grey, "-o", out, "--wrap", "tile"}, 2, "repeat, clamp, mirror");
    expect_refused({"bump", grey, "-o", out, "--green", "left"}, 2, "there are: up, down");
    expect_refused({"bump", grey, "-o", out, "--size", "4"}, 2, "only built-in sources");
    expect_refused({"bump", grey, "-o", out, "--time", "4"}, 2, "only built-in sources");
    expect_refused({"bump", grey, "-o", out, "--scale", "nan"}, 2, "--scale");
    expect_refused({"bump", grey, "-o", out, "--width", "0"}, 2, "--width");
    expect_refused({"bump", "builtin:noise", "-o", out, "--from", "normal"}, 2, "are heights");
    expect_refused({"bump", "builtin:noise", "-o", file("out.xyz")}, 2, ".xyz");
    expect_refused({"bump", "builtin:noise", "-o", out, "--format", "rgba16f"}, 2, "--format");
    expect_refused({"bump", "builtin:noise", "-o", file("no/out.png")}, 4, "no folder");
    expect_refused({"bump", "builtin:noise", "-o", out, "--size", "8192", "--memory", "1M"}, 2,
                   "--memory");
    expect_refused({"bump", file("none.png"), "-o", out}, 3, "none.png");
    EXPECT_EQ(files_in(folder_.path()), before);
}

}  // namespace
}  // namespace mirrorball
