// mirrorball render --frames: animations.
#include <chrono>
#include <filesystem>
#include <thread>

#include <nlohmann/json.hpp>

#include <mirrorball/image.h>
#include <mirrorball/io.h>

#include "program.h"

namespace mirrorball {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Json = nlohmann::json;

// All that moves, bumps and lights, and what reflects it.
constexpr const char* kMoving = R"({
    "objects": [
        {"name": "water", "mesh": "plane", "transform": {"scale": 3},
         "material": {"fresnel": "index=1.33", "bump": {"source": "waves", "size": 32}}},
        {"name": "glossy", "dynamic": {"size": 16, "faces_per_frame": 2},
         "material": {"mirror": 0.5, "glossy": 0.5, "lobe": "ggx:0.5"},
         "transform": {"position": [0, 0.7, 0]}}],
    "environment": {"source": "builtin:axes"}, "map_size": 16,
    "lights": [{"directional": {"direction": [1, 1, 1], "turn_degrees": 90}},
               {"point": {"position": [2, 1, 2], "turn_degrees": -400}}]})";
// A lit ball, which is enough where only files matter.
constexpr const char* kLit = R"({
    "objects": [{"material": {"mirror": 0, "diffuse": 1, "fresnel": "index=1.5"}}],
    "environment": {"source": "builtin:white", "intensity": 0.2}, "map_size": 16,
    "lights": [{"directional": {"direction": [1, 0, 0], "turn_degrees": 90}}]})";

class Frames : public testing::Test {
  protected:
    Frames() {
        write_contents(folder_ / "moving.json", kMoving);
        write_contents(folder_ / "lit.json", kLit);
    }

    [[nodiscard]] std::string file(const std::string& name) const {
        return (folder_ / name).string();
    }

    [[nodiscard]] std::vector<std::string> arguments(const std::string& scene,
                                                     const std::string& output,
                                                     std::vector<std::string> more) const {
        std::vector<std::string> all = {"render", file(scene), "-o", file(output), "--width",
                                        "32",     "--height",  "24", "--samples",  "2"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    Outcome must(const std::string& scene, const std::string& output,
                 std::vector<std::string> more) {
        const Outcome outcome = run(arguments(scene, output, std::move(more)));
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return outcome;
    }
    /// Refused, and no file or folder made.
    void expect_nothing(const std::string& output, std::vector<std::string> more, int code,
                        const std::string& message) {
        const auto before = files_in(folder_.path());
        expect_refused(arguments("lit.json", output, std::move(more)), code, message);
        EXPECT_EQ(files_in(folder_.path()), before);
    }

    TemporaryFolder folder_;
};

TEST_F(Frames, AreMadeUnderTheirNumbersAndMove) {
    const Json json = Json::parse(
        must("lit.json", "a/f%03d%%.exr", {"--frames", "2:6:2", "--fps", "2", "--json"}).out);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "a"), {}), 3);
    ASSERT_EQ(json["frames"].size(), 3u);
    EXPECT_EQ(json["drawn"], 3);
    EXPECT_EQ(json["skipped"], 0);
    EXPECT_EQ(json["width"], 32);
    EXPECT_FALSE(json["driver"]["renderer"].get<std::string>().empty());
    for (std::size_t i = 0; i < 3; ++i) {
        const Json& frame = json["frames"][i];
        EXPECT_EQ(frame["frame"], 2 + 2 * i);
        EXPECT_EQ(frame["time"], 1.0 + static_cast<double>(i));
        EXPECT_EQ(frame["file"], file("a/f00" + std::to_string(2 + 2 * i) + "%.exr"));
        EXPECT_GT(frame["seconds"], 0);
    }
    // By 90 degrees a second the light, which shone from +x at 0 s, turns as yaw does, by way of
    // -z at 1 s to -x at 2 s, and is ahead of the camera at 3 s.
    const auto light = [&](int frame, int x) {
        return read_image(file("a/f00" + std::to_string(frame) + "%.exr")).rgb(x, 12).x;
    };
    constexpr int kLeft = 12, kMiddle = 16, kRight = 20;
    EXPECT_NEAR(light(2, kLeft), light(2, kRight), 0.01);
    EXPECT_GT(light(4, kLeft), 1.2 * light(4, kRight));
    EXPECT_GT(light(6, kMiddle), 1.2 * light(2, kMiddle));
}

// The moment of frame n is that of a single picture at --time plus n / fps.
TEST_F(Frames, AreThePicturesOfTheirMoments) {
    must("moving.json", "%d.exr", {"--frames", "3:3", "--fps", "4", "--time", "0.5"});
    must("moving.json", "one.exr", {"--time", "1.25"});
    EXPECT_TRUE(contents(file("3.exr")) == contents(file("one.exr")));
}

// Or else what an interrupt left out would not fit in. Maps that show only some of their faces
// anew would not, and get all, which is told.
TEST_F(Frames, HaveTheSameBitsAloneAndInTheRun) {
    const Outcome all = must("moving.json", "all%d.exr", {"--frames", "0:3"});
    EXPECT_NE(all.err.find("faces_per_frame 2 of object \"glossy\""), std::string::npos) << all.err;
    must("moving.json", "alone%02d.exr", {"--frames", "3:3"});
    EXPECT_TRUE(contents(file("all3.exr")) == contents(file("alone03.exr")));
    for (int i = 1; i < 4; ++i) {
        EXPECT_FALSE(contents(file("all" + std::to_string(i) + ".exr")) ==
                     contents(file("all" + std::to_string(i - 1) + ".exr")))
            << i;
    }
}

TEST_F(Frames, ThatExistAreSkippedUnlessOverwritten) {
    const auto draw = [&](std::vector<std::string> more) {
        more.insert(more.end(), {"--frames", "0:4"});
        return must("lit.json", "a/%d.png", more).out;
    };
    const std::string first = draw({});
    EXPECT_NE(first.find("5 frames"), std::string::npos) << first;
    EXPECT_EQ(first.find("skipped"), std::string::npos) << first;
    const auto whole = files_in(folder_ / "a");
    fs::remove(file("a/1.png"));
    fs::remove(file("a/4.png"));
    write_contents(folder_ / "a/2.png", "mine");
    const auto time = fs::last_write_time(file("a/0.png"));
    const std::string second = draw({});
    EXPECT_NE(second.find("2 frames"), std::string::npos) << second;
    EXPECT_NE(second.find("skipped 3 frames that exist; --overwrite"), std::string::npos) << second;
    EXPECT_EQ(fs::last_write_time(file("a/0.png")), time);
    auto expected = whole;
    expected["2.png"] = "mine";
    EXPECT_EQ(files_in(folder_ / "a"), expected);
    const Json json = Json::parse(draw({"--json"}));
    EXPECT_EQ(json["drawn"], 0);
    EXPECT_EQ(json["skipped"], 5);
    EXPECT_EQ(json["frames"][2]["skipped"], true);
    EXPECT_EQ(draw({}).find("5 frames,"), std::string::npos);
    EXPECT_EQ(draw({"--overwrite"}).find("skipped"), std::string::npos);
    EXPECT_EQ(files_in(folder_ / "a"), whole);
    EXPECT_GT(fs::last_write_time(file("a/0.png")), time);
}

// As ever, a picture that is not of an animation is drawn over what is there.
TEST_F(Frames, ASinglePictureIsOverwritten) {
    write_contents(folder_ / "one.png", "old");
    must("lit.json", "one.png", {});
    EXPECT_EQ(read_image(file("one.png")).width(), 32);
    must("lit.json", "100%.png", {"--overwrite"});
    EXPECT_TRUE(fs::exists(file("100%.png")));
}

TEST_F(Frames, WidthsPadAndNeverCut) {
    must("lit.json", "%02d.png", {"--frames", "8:101:93"});
    must("lit.json", "s%3d.png", {"--frames", "7:7"});
    must("lit.json", "z%0d.png", {"--frames", "7:7"});
    for (const char* name : {"08.png", "101.png", "s  7.png", "z7.png"})
        EXPECT_TRUE(fs::exists(file(name))) << name;
}

TEST_F(Frames, PatternsThatAreNoneAreRefused) {
    const std::vector<std::string> frames = {"--frames", "0:3"};
    expect_nothing("a.png", frames, 2, "a.png: found none; expected one %d");
    expect_nothing("%%d.png", frames, 2, "found none");
    expect_nothing("%d-%04d.png", frames, 2, "found %d and %04d");
    expect_nothing("%s.png", frames, 2, "found \"%s\"");
    expect_nothing("%-4d.png", frames, 2, "found \"%-4d\"");
    expect_nothing("%d%x.png", frames, 2, "found \"%x\"");
    expect_nothing("%d%.png", frames, 2, "found \"%.p\"");
    expect_nothing("%d%n.png", frames, 2, "found \"%n\"");
    expect_nothing("%ld.png", frames, 2, "found \"%l\"");
    expect_nothing("{%d.png%", frames, 2, "");
    expect_nothing("%021d.png", frames, 2, "wider than 20");
    expect_nothing("%099999999999d.png", frames, 2, "wider than 20");
    expect_nothing("f%d/a.png", frames, 2, "%d in a folder's name");
    expect_nothing("%d.ktx2", frames, 2, "textures");
    expect_nothing("%d.gif", frames, 2, ".gif");
    expect_nothing("%04d.png", {}, 2, "--frames");
    // Braces mean nothing, and a plain percent sign is two.
    must("lit.json", "{%%%d}.png", {"--frames", "5:5"});
    EXPECT_TRUE(fs::exists(file("{%5}.png")));
}

TEST_F(Frames, RangesThatAreNoneAreRefused) {
    expect_nothing("%d.png", {"--frames", "5:2"}, 2, "the first frame, 5, comes after the last, 2");
    for (const char* range : {"5", "", ":", "1:", ":1", "a:b", "0:1:0", "0:1:-1", "0:1:2:3",
                              "0:9999999", "0:1.5", "0-5", "99999999999999999999:1", "0: 1"}) {
        expect_nothing("%d.png", {"--frames", range}, 2, "--frames");
    }
    for (const char* fps : {"0", "-1", "nan", "inf", "", "25fps", "1e9"})
        expect_nothing("%d.png", {"--frames", "0:1", "--fps", fps}, 2, "--fps");
    expect_nothing("a.png", {"--fps", "25"}, 2, "see --frames");
    expect_nothing("a/%d.png", {"--frames", "0:20000", "--fps", "0.01"}, 2, "frame 10001");
    expect_nothing("a/%d.png", {"--frames", "0:1", "--time", "1e6"}, 2, "time goes to 1000000");
}

TEST_F(Frames, PlacesThatCannotHoldThemAreRefused) {
    const std::vector<std::string> frames = {"--frames", "0:3"};
    expect_nothing("no/where/%d.png", frames, 4, "no: ");
    expect_nothing("lit.json/%d.png", frames, 4, "is a file");
    fs::create_directory(folder_ / "2.png");
    expect_nothing("%d.png", frames, 4, "2.png: is a folder");
    expect_nothing("new/%d.png", {"--frames", "0:3", "--env", "gone.hdr"}, 3, "gone.hdr");
    if (geteuid() == 0) GTEST_SKIP() << "root writes to any folder";
    fs::create_directory(folder_ / "shut");
    fs::permissions(folder_ / "shut", fs::perms::owner_read | fs::perms::owner_exec);
    expect_nothing("shut/%d.png", frames, 4, "shut");
    expect_nothing("shut/new/%d.png", frames, 4, "shut");
}

// A limit on the size of files stands for a full disk; a .pfm is not packed and larger.
TEST_F(Frames, AFullDiskLeavesWholeFramesOnly) {
    const auto before = files_in(folder_.path());
    std::vector<std::string> words = {"/bin/bash", "-c", "ulimit -f 1; exec \"$0\" \"$@\""};
    for (const std::string& word : command(arguments("lit.json", "a/%d.pfm", {"--frames", "0:3"})))
        words.push_back(word);
    const Outcome outcome = Program(words).wait();
    EXPECT_EQ(outcome.code, 4) << outcome.err;
    EXPECT_NE(outcome.err.find("0.pfm"), std::string::npos) << outcome.err;
    EXPECT_EQ(files_in(folder_.path()), before);
}

TEST_F(Frames, AnInterruptLeavesWholeFramesAndSaysHowFarItGot) {
    for (const bool overwrite : {false, true}) {
        std::vector<std::string> more = {"--frames", "0:9999"};
        if (overwrite) more.emplace_back("--overwrite");
        const std::string folder = overwrite ? "b" : "a";
        Program program(command(arguments("lit.json", folder + "/%d.png", more)));
        while (program.running() && !fs::exists(file(folder + "/1.png")))
            std::this_thread::sleep_for(2ms);
        program.send(SIGINT);
        const Outcome outcome = program.wait();
        EXPECT_EQ(outcome.code, 130) << outcome.err;
        EXPECT_NE(outcome.err.find("mirrorball: interrupted"), std::string::npos) << outcome.err;
        EXPECT_EQ(outcome.out, "");
        const auto files = files_in(folder_ / folder);
        const std::size_t count = files.size();
        ASSERT_GE(count, 2u);
        EXPECT_NE(outcome.err.find("drew " + std::to_string(count) + " of 10000 frames"),
                  std::string::npos)
            << outcome.err;
        const std::string go_on = overwrite
                                      ? "--frames " + std::to_string(count) + ":9999:1 --overwrite"
                                      : "same command";
        EXPECT_NE(outcome.err.find(go_on), std::string::npos) << outcome.err;
        for (std::size_t i = 0; i < count; ++i)
            EXPECT_EQ(read_image(file(folder + "/" + std::to_string(i) + ".png")).height(), 24);
    }
}

}  // namespace
}  // namespace mirrorball
