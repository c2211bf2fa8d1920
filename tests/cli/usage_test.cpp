// What the program refuses, with which exit code and in which words; and what it leaves: nothing.
#include <nlohmann/json.hpp>

#include <chrono>

#include "program.h"

namespace mirrorball {
namespace {

class Usage : public testing::Test {
  protected:
    void SetUp() override {
        sky_ = (folder_ / "sky.hdr").string();
        ASSERT_EQ(run({"sky", "sunset", "-o", sky_, "--size", "64", "--quiet"}).code, 0);
        out_ = (folder_ / "out.ktx2").string();
        before_ = files_in(folder_.path());
    }
    void TearDown() override { EXPECT_EQ(files_in(folder_.path()), before_); }

    std::string broken(const std::string& name, const std::string& bytes) {
        write_contents(folder_ / name, bytes);
        before_ = files_in(folder_.path());
        return (folder_ / name).string();
    }

    TemporaryFolder folder_;
    std::string sky_, out_;
    std::map<std::string, std::string> before_;
};

TEST_F(Usage, HelpAndVersionGoToStdout) {
    EXPECT_NE(run({"--help"}).out.find("bake"), std::string::npos);
    EXPECT_EQ(run({"--version"}).out.compare(0, 11, "mirrorball "), 0);
    for (const char* verb : {"info", "convert", "prefilter", "irradiance-sh", "bake", "compare",
                             "sky", "bump", "brdf", "fresnel", "view-stack", "completion"}) {
        const Outcome help = run({verb, "--help"});
        EXPECT_EQ(help.code, 0) << verb;
        EXPECT_NE(help.out.find("example"), std::string::npos) << verb;
        EXPECT_EQ(help.err, "") << verb;
    }
    EXPECT_EQ(run({}).code, 2);
}

TEST_F(Usage, WordsThatAreNearlyRightGetTheRightOnes) {
    expect_refused({"bkae"}, 2, "did you mean \"bake\"?");
    expect_refused({"convert", sky_, "-o", out_, "--sise", "4"}, 2, "did you mean --size?");
    expect_refused({"convert", sky_, "-o", out_, "--to", "spher"}, 2, "did you mean \"sphere\"?");
    expect_refused({"convert", sky_, "-o", out_, "--format", "rgba16"}, 2, "\"rgba16f\"");
    expect_refused({"convert", sky_, "-o", out_, "--axes", "blendr"}, 2, "\"blender\"");
    expect_refused({"info", "builtin:sunst"}, 2, "did you mean \"sunset\"?");
    expect_refused({"sky", "sunst", "-o", out_}, 2, "did you mean \"sunset\"?");
}

TEST_F(Usage, OptionsThatMakeNoSense) {
    const auto convert = [&](std::vector<std::string> more) {
        std::vector<std::string> all = {"convert", sky_, "-o", out_};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    for (const char* size : {"abc", "-5", "0", "12.5", "1e3", "", "99999999999999999999"}) {
        expect_refused(convert({"--size", size}), 2, "--size");
    }
    expect_refused(convert({"--to", "cube", "--size", "1000000"}), 2, "--memory allows");
    expect_refused(convert({"--size", "63"}), 2, "even");
    expect_refused(convert({"--rotate", "10,20"}), 2, "YAW,PITCH,ROLL");
    expect_refused(convert({"--crop", "1,2,-3"}), 2, "--crop");
    expect_refused(convert({"--memory", "lots"}), 2, "512M");
    expect_refused(convert({"--threads", "0"}), 2, "--threads");
    expect_refused(convert({"--levels", "some"}), 2, "--levels");
    expect_refused(convert({"--faces", "a,b"}), 2, "--faces");
    expect_refused(convert({"--size", "4", "--size", "8"}), 2, "twice");
    expect_refused({"convert", sky_}, 2, "--output FILE is missing");
    expect_refused({"convert", sky_, "-o", "--quiet"}, 2, "needs a value");
    expect_refused({"convert", sky_, sky_, "-o", out_}, 2, "unexpected argument");
    expect_refused({"prefilter", sky_, "-o", out_, "--lobe", "ggx:1.5"}, 2, "ggx");
    expect_refused({"prefilter", sky_, "-o", out_, "--lobe", "shiny"}, 2, "shiny");
    expect_refused({"prefilter", sky_, "-o", out_, "--lobe", "0.5,ggx:0.5"}, 2, "no lobe \"0.5\"");
    expect_refused({"prefilter", sky_, "-o", out_, "--lobe", "ggx:0.5,2"}, 2, "from 0 to 1");
    expect_refused({"prefilter", sky_, "-o", out_, "--lobe", "charlie:0"}, 2, "from 0.01 to 1");
    expect_refused({"prefilter", sky_, "-o", out_, "--lobe", "charlie", "--mapping", "playcanvas"},
                   2, "phong");
    const std::string missing = "table:" + (folder_ / "missing.txt").string();
    expect_refused({"prefilter", sky_, "-o", out_, "--lobe", missing}, 3, "missing.txt");
    expect_refused({"prefilter", sky_, "-o", (folder_ / "x.hdr").string(), "--lobe", "ggx"}, 2,
                   "levels");
    expect_refused(
        {"prefilter", sky_, "-o", out_, "--lobe", "ggx:0.1,ggx:0.2,ggx:0.3", "--size", "2"}, 2,
        "do not fit");
    expect_refused({"bake", sky_, "-o", (folder_ / "b").string(), "--phong", "ten"}, 2, "--phong");
}

TEST_F(Usage, TooLittleMemoryIsSaidAtOnce) {
    const auto start = std::chrono::steady_clock::now();
    expect_refused({"convert", sky_, "-o", out_, "--to", "cube", "--size", "512", "--memory", "1M"},
                   2, "--memory allows 1.0 MB");
    expect_refused({"bake", sky_, "-o", (folder_ / "b").string(), "--memory", "1M"}, 2, "--memory");
    expect_refused({"sky", "white", "-o", out_, "--size", "100000", "--memory", "1G"}, 2,
                   "--memory");
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(3));
}

TEST_F(Usage, FilesThatCannotBeRead) {
    expect_refused({"info", (folder_ / "none.hdr").string()}, 3, "none.hdr");
    expect_refused({"bake", (folder_ / "none.hdr").string(), "-o", (folder_ / "b").string()}, 3,
                   "none.hdr");
    expect_refused({"info", folder_.path().string()}, 3, folder_.path().string());
    expect_refused({"info", broken("empty.hdr", "")}, 3, "empty.hdr");
    expect_refused({"info", broken("noise.hdr", "certainly not a picture at all")}, 3, "noise.hdr");
    const std::string whole = contents(sky_);
    expect_refused({"info", broken("half.hdr", whole.substr(0, whole.size() / 2))}, 3, "half.hdr");
    const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    expect_refused({"info", broken("huge.hdr", head + "-Y 100000 +X 100000\n")}, 3, "huge.hdr");
    expect_refused({"info", broken("negative.hdr", head + "-Y -4 +X 8\n")}, 3, "negative.hdr");
    std::string odd = head + "-Y 4 +X 7\n" + std::string(4 * 7 * 4, '\x80');
    expect_refused({"info", broken("odd.hdr", odd)}, 3, "odd.hdr");
}

TEST_F(Usage, TruncatedCubeFiles) {
    for (const char* ending : {".dds", ".ktx2"}) {
        const std::string cube = (folder_ / ("cube" + std::string(ending))).string();
        ASSERT_EQ(run({"convert", sky_, "-o", cube, "--to", "cube", "--quiet"}).code, 0);
        const std::string whole = contents(cube);
        expect_refused(
            {"info", broken("half" + std::string(ending), whole.substr(0, whole.size() / 2))}, 3,
            "half");
    }
}

TEST_F(Usage, OutputsThatCannotBeWritten) {
    expect_refused({"convert", sky_, "-o", (folder_ / "none" / "out.hdr").string()}, 4, "none");
    expect_refused({"convert", sky_, "-o", (folder_ / "out.xyz").string()}, 2, ".xyz");
    expect_refused({"convert", sky_, "-o", (folder_ / "o.hdr").string(), "--format", "unorm8"}, 2,
                   "--format");
    expect_refused({"convert", sky_, "-o", "/dev/full"}, 2, "/dev/full");
    expect_refused({"bake", sky_, "-o", sky_}, 4, "is a file");
    expect_refused({"bake", sky_, "-o", (folder_ / "no" / "where").string()}, 4, "no");
}

TEST_F(Usage, FullStdoutIsAnErrorOfWriting) {
    for (const auto& arguments : std::vector<std::vector<std::string>>{
             {"--help"}, {"info", sky_}, {"sky", "--list"}, {"completion", "bash"}}) {
        const Outcome outcome = run(arguments, "/dev/full");
        EXPECT_EQ(outcome.code, 4) << arguments[0];
        EXPECT_NE(outcome.err.find("standard output"), std::string::npos) << outcome.err;
    }
}

// A limit on the size of files stands for a full disk: write() fails in the same way.
TEST_F(Usage, FullDiskLeavesTheOldFile) {
    const std::string old = broken("old.ktx2", "the old file");
    const std::string limited = "ulimit -f 1; exec \"$0\" \"$@\"";
    std::vector<std::string> words = {"/bin/bash", "-c", limited};
    for (const std::string& word :
         command({"convert", sky_, "-o", old, "--to", "cube", "--size", "64"})) {
        words.push_back(word);
    }
    const Outcome outcome = Program(words).wait();
    EXPECT_EQ(outcome.code, 4) << outcome.err;
    EXPECT_NE(outcome.err.find("old.ktx2"), std::string::npos) << outcome.err;
}

TEST_F(Usage, EveryVerbPrintsOneJsonObject) {
    const std::string cube = (folder_ / "cube.ktx2").string();
    const std::vector<std::vector<std::string>> lines = {
        {"info", sky_, "--json"},
        {"projections", "--size", "32", "--json"},
        {"sky", "--list", "--json"},
        {"convert", sky_, "-o", cube, "--to", "cube", "--size", "8", "--json"},
        {"compare", sky_, sky_, "--json"},
        {"completion", "bash", "--json"}};
    for (const auto& line : lines) {
        const Outcome outcome = run(line);
        EXPECT_EQ(outcome.code, 0) << line[0] << outcome.err;
        EXPECT_TRUE(nlohmann::json::parse(outcome.out, nullptr, false).is_object()) << outcome.out;
    }
    before_ = files_in(folder_.path());
}

}  // namespace
}  // namespace mirrorball
