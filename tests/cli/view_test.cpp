// mirrorball view, on a screen that no one sees.
#include <unistd.h>

#include <nlohmann/json.hpp>

#include <mirrorball/io.h>

#include "program.h"

namespace mirrorball {
namespace {

using Json = nlohmann::json;

bool is_installed(const std::string& program) {
    return access(("/usr/bin/" + program).c_str(), X_OK) == 0;
}

bool has_window() {
    return run({"view", "--help"}).out.find("This build has no window") == std::string::npos;
}

class ViewVerb : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!has_window()) GTEST_SKIP() << "this build has no window";
        for (const char* program : {"xvfb-run", "xauth"}) {
            if (!is_installed(program)) GTEST_SKIP() << program << " is not installed";
        }
    }

    /// On a screen of 640 x 480.
    static Outcome on_screen(const std::vector<std::string>& command) {
        std::vector<std::string> words = {"/usr/bin/xvfb-run", "-a", "-s", "-screen 0 640x480x24"};
        words.insert(words.end(), command.begin(), command.end());
        return Program(words).wait();
    }
    /// Small pictures unless told otherwise, so that software draws them at once.
    static Outcome view(const std::vector<std::string>& more, int width = 96, int height = 72) {
        std::vector<std::string> words = {MIRRORBALL_PROGRAM,    "view",     "--width",
                                          std::to_string(width), "--height", std::to_string(height),
                                          "--map-size",          "64",       "--env",
                                          "builtin:axes"};
        words.insert(words.end(), more.begin(), more.end());
        return on_screen(words);
    }
    std::string target() const { return (folder_ / "shown.png").string(); }
    std::string script(const std::string& text) const {
        write_contents(folder_ / "steps.txt", text);
        return (folder_ / "steps.txt").string();
    }
    static int largest_difference(const Image& a, const Image& b) {
        EXPECT_EQ(a.width(), b.width());
        EXPECT_EQ(a.height(), b.height());
        const auto code = [](float linear) {
            return linear <= 0.0031308f ? 255 * 12.92 * linear
                                        : 255 * (1.055 * std::pow(linear, 1 / 2.4) - 0.055);
        };
        double largest = 0;
        for (std::size_t i = 0; i < std::min(a.values().size(), b.values().size()); ++i)
            largest = std::max(largest, std::abs(code(a.values()[i]) - code(b.values()[i])));
        return static_cast<int>(std::lround(largest));
    }

    const TemporaryFolder folder_;
};

// The window's picture goes through half floats, eight times rounded: two codes of 255.
TEST_F(ViewVerb, ScreenshotIsThePictureThatRenderDraws) {
    const Outcome outcome = view({"--frames", "9", "--screenshot", target(), "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json json = Json::parse(outcome.out);
    EXPECT_EQ(json["frames"], 9);
    EXPECT_GT(json["median_frame_seconds"], 0);
    const std::string rendered = (folder_ / "rendered.png").string();
    ASSERT_EQ(run({"render", "-o", rendered, "--width", "96", "--height", "72", "--map-size", "64",
                   "--env", "builtin:axes"})
                  .code,
              0);
    EXPECT_LE(largest_difference(read_image(target()), read_image(rendered)), 2);
}

TEST_F(ViewVerb, SurvivesOnePixelAndRubbish) {
    write_contents(folder_ / "rubbish.hdr", "rubbish");
    write_contents(folder_ / "rubbish.glb", "glTF");
    const Outcome outcome =
        view({"--panel", "--screenshot", target(), "--script",
              script("wait 2\nresize 1 1\nwait 2\ndrop " + (folder_ / "rubbish.hdr").string() +
                     "\ndrop " + (folder_ / "rubbish.glb").string() + "\ndrop " +
                     (folder_ / "none.json").string() +
                     "\nkey c\nkey x\nresize 640 400\nkey h\nkey m\nkey ArrowLeft\ndrag 30 10 2\n"
                     "resize 96 72\nkey f\nkey M\nkey x\nkey h\nwait 10\n")});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Image shown = read_image(target());
    EXPECT_EQ(shown.width(), 96);
    EXPECT_EQ(shown.height(), 72);
}

// Rubbish changes nothing: the picture is that of a window that nothing was dropped on.
TEST_F(ViewVerb, DropsOfRubbishLeaveThePicture) {
    write_contents(folder_ / "rubbish.hdr", "rubbish");
    const std::string other = (folder_ / "other.png").string();
    const std::string drop = "drop " + (folder_ / "rubbish.hdr").string() + "\n";
    ASSERT_EQ(view({"--frames", "9", "--screenshot", target()}).code, 0);
    ASSERT_EQ(view({"--frames", "9", "--screenshot", other, "--script", script(drop)}).code, 0);
    EXPECT_EQ(contents(target()), contents(other));
}

TEST_F(ViewVerb, DropsOfFilesAreShown) {
    const std::string light = (folder_ / "light.hdr").string();
    ASSERT_EQ(run({"sky", "white", "-o", light, "--size", "64"}).code, 0);
    ASSERT_EQ(view({"--samples", "1", "--screenshot", target(), "--script",
                    script("drop " + light + "\nwait 1\n")})
                  .code,
              0);
    const Image shown = read_image(target());
    for (const float value : shown.values()) ASSERT_NEAR(value, shown.values()[0], 0.01);
}

TEST_F(ViewVerb, ControlsAreInThePictureWhereAsked) {
    const std::string plain = (folder_ / "plain.png").string();
    constexpr int kWidth = 640, kHeight = 400;
    // Twice the panel's width is not there at the usual scale.
    ASSERT_EQ(view({"--samples", "1", "--frames", "3", "--screenshot", target(), "--panel",
                    "--scale", "0.75"},
                   kWidth, kHeight)
                  .code,
              0);
    ASSERT_EQ(
        view({"--samples", "1", "--frames", "3", "--screenshot", plain}, kWidth, kHeight).code, 0);
    EXPECT_GT(largest_difference(read_image(target()), read_image(plain)), 100);
}

// Keys that a hand presses on the window itself, and the picture that they take.
TEST_F(ViewVerb, ListensToTheKeyboard) {
    if (!is_installed("xdotool")) GTEST_SKIP() << "xdotool is not installed";
    const std::string shell =
        "cd '" + folder_.path().string() +
        "' && '" MIRRORBALL_PROGRAM
        "' view --width 320 --height 240 --map-size 32 --env builtin:axes & window=$! ; "
        "id=$(xdotool search --sync --onlyvisible --name mirrorball | head -n 1); "
        "xdotool windowfocus $id; "
        "for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do "
        "[ -f mirrorball-1.png ] && break; xdotool key p; sleep 0.3; done; "
        "xdotool key q; wait $window";
    const Outcome outcome = on_screen({"/bin/sh", "-c", shell});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "mirrorball-1.png")) << outcome.err;
}

// The sharp lobe sums over the whole source, more than a second of a processor's time. The words
// are in the window's title.
TEST_F(ViewVerb, SaysHowFarLongWorkIsAndEndsIt) {
    if (!is_installed("xdotool")) GTEST_SKIP() << "xdotool is not installed";
    const std::string shell =
        "'" MIRRORBALL_PROGRAM
        "' view --width 320 --height 240 --env builtin:studio --material satin-gold "
        "--lobe ggx:0.03 & window=$! ; seen=; "
        "for i in $(seq 500); do "
        "xdotool search --name '^Prefiltering: [0-9]+ %, [0-9]+ s left - mirrorball$' "
        ">/dev/null 2>&1 && { seen=yes; break; }; kill -0 $window || break; sleep 0.02; done; "
        "kill $window; wait $window; echo ${seen:-missed} $?";
    // xvfb-run has a code of its own where it cannot clean up.
    const Outcome outcome = on_screen({"/bin/sh", "-c", shell});
    if (outcome.out.find("missed") != std::string::npos)
        GTEST_SKIP() << "the work was done before it was seen";
    EXPECT_EQ(outcome.out, "yes 130\n") << outcome.err;
}

TEST_F(ViewVerb, SaysWhatWasTriedWithoutADisplay) {
    const Outcome outcome =
        Program({"/usr/bin/env", "-u", "DISPLAY", MIRRORBALL_PROGRAM, "view"}).wait();
    EXPECT_EQ(outcome.code, 5);
    EXPECT_NE(outcome.err.find("X11"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("DISPLAY is not set"), std::string::npos) << outcome.err;
    const Outcome wrong =
        Program({"/usr/bin/env", "DISPLAY=:999", MIRRORBALL_PROGRAM, "view"}).wait();
    EXPECT_EQ(wrong.code, 5);
    EXPECT_NE(wrong.err.find("DISPLAY=:999"), std::string::npos) << wrong.err;
}

TEST_F(ViewVerb, RefusesWhatItCannotDo) {
    expect_refused({"view", "--frames", "0"}, 2, "--frames");
    expect_refused({"view", "--show", "both"}, 2, "--show");
    expect_refused({"view", "--screenshot", "x.xyz"}, 2, "x.xyz");
    expect_refused({"view", "--script", "/none.txt"}, 3, "/none.txt");
    const auto wrong_step = [&](const std::string& text, const std::string& says) {
        expect_refused({"view", "--script", script(text)}, 2, says);
    };
    wrong_step("resize 0 10\n", "steps.txt:1");
    wrong_step("# a comment\n\njump\n", "steps.txt:3");
    wrong_step("drop\n", "steps.txt:1");
    wrong_step("drag 1\n", "steps.txt:1");
    wrong_step("wait 1 2\n", "steps.txt:1");
    wrong_step("lobe ggx 0.1 2\n", "steps.txt:1");
    wrong_step("lobe glue 0.1 0.2 3\n", "steps.txt:1");
}

}  // namespace
}  // namespace mirrorball
