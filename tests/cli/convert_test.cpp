// Conversions by the real program: there and back, orientation, levels, files over themselves.
#include <mirrorball/io.h>

#include <nlohmann/json.hpp>

#include "program.h"

namespace mirrorball {
namespace {

using Json = nlohmann::json;

class Convert : public testing::Test {
  protected:
    std::string file(const std::string& name) { return (folder_ / name).string(); }
    void must(const std::vector<std::string>& arguments) {
        const Outcome outcome = run(arguments);
        ASSERT_EQ(outcome.code, 0) << arguments[0] << ": " << outcome.err;
    }
    Json json(std::vector<std::string> arguments) {
        arguments.emplace_back("--json");
        return Json::parse(run(arguments).out);
    }

    TemporaryFolder folder_;
};

// The lines of `grid` are a few texels wide, and two conversions blur them: hence the tolerance on
// the RMSE, and the tighter one on the flux, which blurring keeps.
TEST_F(Convert, ThereAndBackByEveryProjection) {
    must({"sky", "grid", "-o", file("in.exr"), "--size", "256", "--format", "rgba32f"});
    for (const char* projection : {"equirect", "cube", "sphere", "dual-paraboloid", "angular",
                                   "octahedral", "equal-area-octahedral"}) {
        must({"convert", file("in.exr"), "-o", file("there.ktx2"), "--to", projection, "--size",
              "256", "--format", "rgba32f"});
        must({"convert", file("there.ktx2"), "-o", file("back.exr"), "--to", "equirect", "--size",
              "256", "--format", "rgba32f"});
        const Json difference =
            json({"compare", file("back.exr"), file("in.exr"), "--tolerance", "1"});
        for (const double ratio : difference["levels"][0]["flux_ratio"]) {
            EXPECT_NEAR(ratio, 1, 2e-3) << projection;
        }
        EXPECT_LT(difference["levels"][0]["relative_rmse"], 0.3) << projection;
    }
}

TEST_F(Convert, NothingChangedIsTheSameBytes) {
    must({"sky", "sunset", "-o", file("a.exr"), "--size", "64", "--format", "rgba32f"});
    must({"convert", file("a.exr"), "-o", file("b.exr"), "--format", "rgba32f"});
    EXPECT_EQ(run({"compare", file("a.exr"), file("b.exr"), "--tolerance", "0"}).code, 0);
}

TEST_F(Convert, LobesComeInListsAndFromTables) {
    must({"sky", "sunset", "-o", file("sky.hdr"), "--size", "32"});
    write_contents(folder_ / "felt.txt", "# degrees weight\n0 2\n45 1\n80 0\n");
    must({"prefilter", file("sky.hdr"), "-o", file("a.ktx2"), "--size", "8", "--lobe",
          "ggx:0.25,0.5,table:" + file("felt.txt") + ",charlie:1"});
    const auto levels = json({"info", file("a.ktx2")})["levels"];
    const char* const expected[] = {"ggx:0.25", "ggx:0.5", "table:felt.txt", "charlie:1"};
    for (int level = 0; level < 4; ++level) EXPECT_EQ(levels[level]["lobe"], expected[level]);
    // known by name, a table goes from file to file without its own
    std::filesystem::remove(folder_ / "felt.txt");
    must({"convert", file("a.ktx2"), "-o", file("b.dds")});
    must({"prefilter", file("sky.hdr"), "-o", file("c.ktx2"), "--size", "32", "--lobe", "charlie",
          "--levels", "3"});
    EXPECT_EQ(json({"info", file("c.ktx2")})["levels"][0]["lobe"], "charlie:0.01");
}

// 4096 x 2048 texels take 96 MiB; their flux is that of the means made of them, to the rounding of
// the texels of a .hdr, whose 8 bits may be off by 1/512 each.
TEST_F(Convert, AMapLargerThanMemoryIsReduced) {
    must({"sky", "grid", "-o", file("large.hdr"), "--size", "4096"});
    const Json whole = json({"info", file("large.hdr")});
    const Json by_rows = json({"info", file("large.hdr"), "--memory", "20M"});
    EXPECT_TRUE(by_rows["levels"][0]["seam_ratio"].is_null());
    EXPECT_EQ(by_rows["levels"][0]["maximum"], whole["levels"][0]["maximum"]);

    const Outcome outcome =
        run({"convert", file("large.hdr"), "-o", file("small.hdr"), "--memory", "40M"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("4096 x 2048 texels were averaged to 1024 x 512"), std::string::npos)
        << outcome.err;
    const Json small = json({"info", file("small.hdr")});
    EXPECT_EQ(small["width"], 1024);
    for (int c = 0; c < 3; ++c) {
        const double flux = whole["levels"][0]["flux"][c];
        EXPECT_NEAR(by_rows["levels"][0]["flux"][c], flux, 1e-12 * flux);
        EXPECT_NEAR(small["levels"][0]["flux"][c], flux, flux / 512);
    }

    const Outcome refused =
        run({"convert", file("large.hdr"), "-o", file("none.hdr"), "--memory", "1M"});
    EXPECT_EQ(refused.code, 3) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(file("none.hdr")));
}

TEST_F(Convert, AnOutputMayBeTheInput) {
    must({"sky", "sunset", "-o", file("a.hdr"), "--size", "64"});
    must({"convert", file("a.hdr"), "-o", file("a.hdr"), "--rotate", "90,0,0"});
    EXPECT_EQ(json({"info", file("a.hdr")})["width"], 64);
    EXPECT_EQ(files_in(folder_.path()).size(), 1u);
}

// Each conversion takes means over texels and so blurs a little, by 3e-3 on this map; turning and
// mirroring move whole texels here, so both blur alike and agree to the rounding of floats.
TEST_F(Convert, TurnsAndMirrorsUndoThemselves) {
    must({"sky", "sunset", "-o", file("sky.hdr"), "--size", "64"});
    must({"prefilter", file("sky.hdr"), "-o", file("a.pfm"), "--lobe", "phong:4", "--to",
          "equirect", "--size", "128"});
    must({"convert", file("a.pfm"), "-o", file("b.pfm"), "--rotate", "90,0,0"});
    EXPECT_EQ(run({"compare", file("b.pfm"), file("a.pfm"), "--tolerance", "0.1"}).code, 1);
    must({"convert", file("b.pfm"), "-o", file("turned.pfm"), "--rotate", "-90,0,0"});
    must({"convert", file("a.pfm"), "-o", file("b.pfm"), "--mirror"});
    EXPECT_EQ(run({"compare", file("b.pfm"), file("a.pfm"), "--tolerance", "0.1"}).code, 1);
    must({"convert", file("b.pfm"), "-o", file("mirrored.pfm"), "--mirror"});
    for (const char* name : {"turned.pfm", "mirrored.pfm"}) {
        EXPECT_EQ(run({"compare", file(name), file("a.pfm"), "--tolerance", "5e-3"}).code, 0)
            << name;
    }
    EXPECT_EQ(
        run({"compare", file("turned.pfm"), file("mirrored.pfm"), "--tolerance", "1e-6"}).code, 0);
}

TEST_F(Convert, LevelsAreMadeWhenAskedForAndKeptWhenThere) {
    must({"sky", "noon", "-o", file("a.hdr"), "--size", "64"});
    must({"convert", file("a.hdr"), "-o", file("plain.ktx2"), "--to", "cube"});
    EXPECT_EQ(json({"info", file("plain.ktx2")})["levels"].size(), 1u);
    must({"convert", file("a.hdr"), "-o", file("mips.ktx2"), "--to", "cube", "--levels", "all"});
    EXPECT_EQ(json({"info", file("mips.ktx2")})["levels"].size(), 5u);  // 16 8 4 2 1
    must({"convert", file("mips.ktx2"), "-o", file("mips.dds")});
    EXPECT_EQ(json({"info", file("mips.dds")})["levels"].size(), 5u);
    const Outcome one = run({"convert", file("mips.ktx2"), "-o", file("one.hdr")});
    EXPECT_EQ(one.code, 0);
    EXPECT_NE(one.err.find("left out"), std::string::npos) << one.err;
}

TEST_F(Convert, SixFilesAreOneCube) {
    must({"sky", "axes", "-o", file("cube.ktx2"), "--to", "cube", "--size", "32", "--format",
          "rgba32f"});
    must({"convert", file("cube.ktx2"), "-o", file("f-%s.pfm")});
    std::string faces;
    for (const char* face : {"px", "nx", "py", "ny", "pz", "nz"}) {
        faces += (faces.empty() ? "" : ",") + file("f-" + std::string(face) + ".pfm");
    }
    must({"convert", "--faces", faces, "-o", file("back.ktx2"), "--format", "rgba32f"});
    EXPECT_EQ(run({"compare", file("back.ktx2"), file("cube.ktx2"), "--tolerance", "0"}).code, 0);
}

TEST_F(Convert, ComparesWithPictureAndExitCode) {
    must({"sky", "sunset", "-o", file("a.hdr"), "--size", "64"});
    must({"sky", "noon", "-o", file("b.hdr"), "--size", "64"});
    const Outcome outcome =
        run({"compare", file("a.hdr"), file("b.hdr"), "--picture", file("d.png")});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(outcome.err.find("mirrorball:"), std::string::npos) << outcome.err;
    EXPECT_EQ(contents(file("d.png")).compare(1, 3, "PNG"), 0);
    EXPECT_EQ(run({"compare", file("a.hdr"), file("a.hdr"), "--level", "3"}).code, 2);
}

// A grey card stays as it is on film, at the exposure that is asked for; and half of the light of
// white, by `none`, reads back as half.
TEST_F(Convert, PicturesAreExposedAndToneMapped) {
    ASSERT_EQ(run({"sky", "white", "-o", file("w.hdr"), "--size", "16"}).code, 0);
    const auto shown = [&](const std::vector<std::string>& more) {
        std::vector<std::string> line = {"convert", file("w.hdr"), "-o", file("p.png")};
        line.insert(line.end(), more.begin(), more.end());
        const Outcome outcome = run(line);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        return read_image(file("p.png")).rgb(3, 3).x;
    };
    constexpr double kStep = 0.5 / 255 * 1.2;  // of 8 bits, in linear light at mid grey
    EXPECT_NEAR(shown({"--exposure", "0.18", "--tone-map", "film"}), 0.18, kStep);
    EXPECT_NEAR(shown({"--exposure", "0.5", "--tone-map", "none"}), 0.5, 1.5 * kStep);
    EXPECT_NEAR(shown({"--exposure", "0.5"}), 0.5, 1.5 * kStep);
    EXPECT_NEAR(shown({"--exposure", "9", "--tone-map", "reinhard"}), 0.9, 2 * kStep);
    expect_refused({"convert", file("w.hdr"), "-o", file("p.png"), "--tone-map", "filmic"}, 2,
                   "--tone-map");
}

// The figures that the survey's section 3 gives, as measured.
TEST_F(Convert, ProjectionsAreTheSurveys) {
    std::map<std::string, Json> facts;
    const Json table = json({"projections", "--size", "256"});
    for (const Json& row : table["projections"]) facts[row["projection"].get<std::string>()] = row;
    EXPECT_EQ(facts.size(), 7u);
    EXPECT_NEAR(facts["dual-paraboloid"]["used_share"], 0.785398, 1e-3);
    EXPECT_NEAR(facts["dual-paraboloid"]["solid_angle_ratio"], 4, 0.1);
    EXPECT_NEAR(facts["cube"]["solid_angle_ratio"], 5.196, 0.1);
    EXPECT_NEAR(facts["sphere"]["solid_angle_ratio"], 1, 1e-2);
    EXPECT_EQ(facts["cube"]["pixels_relative_to_cube"], 1.0);
}

}  // namespace
}  // namespace mirrorball
