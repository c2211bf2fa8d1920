// The main job: everything is there and opens, any thread count gives the same, nothing half done.
#include <nlohmann/json.hpp>

#include <mirrorball/io.h>

#include <chrono>
#include <thread>

#include "program.h"

namespace mirrorball {
namespace {

using Json = nlohmann::json;
using namespace std::chrono_literals;

class Bake : public testing::Test {
  protected:
    void SetUp() override {
        sky_ = (folder_ / "sky.hdr").string();
        ASSERT_EQ(run({"sky", "sunset", "-o", sky_, "--size", "64"}).code, 0);
    }
    std::vector<std::string> bake(const std::string& name, std::vector<std::string> more = {}) {
        std::vector<std::string> all = {
            "bake",           sky_, "-o",     (folder_ / name).string(), "--size", "32",
            "--diffuse-size", "8",  "--quiet"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    Json info(const std::string& name) {
        return Json::parse(run({"info", (folder_ / name).string(), "--json"}).out);
    }
    Json json(const std::string& name) { return Json::parse(contents(folder_ / name)); }

    TemporaryFolder folder_;
    std::string sky_;
};

// Every file that the page names is there, and every picture says what it shows.
void expect_whole_page(const std::filesystem::path& folder) {
    const std::string page = contents(folder / "index.html");
    int count = 0;
    for (const std::string attribute : {"src=\"", "href=\""}) {
        for (std::size_t at = page.find(attribute); at != std::string::npos;
             at = page.find(attribute, at + 1)) {
            const std::size_t start = at + attribute.size();
            const std::string file = page.substr(start, page.find('"', start) - start);
            EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
            ++count;
        }
    }
    EXPECT_GT(count, 25);
    EXPECT_EQ(page.find("http"), std::string::npos) << "the page needs no network";
    EXPECT_EQ(page.find("alt=\"\""), std::string::npos);
}

TEST_F(Bake, LeavesAllThatIsPromised) {
    const Outcome outcome = run(bake("out", {"--mapping", "gltf", "--levels", "3", "--phong",
                                             "50,5", "--fresnel", "metal=gold"}));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "");

    EXPECT_EQ(info("out/environment.ktx2")["levels"].size(), 5u);  // 16 8 4 2 1
    const Json specular = info("out/specular.ktx2")["levels"];
    ASSERT_EQ(specular.size(), 3u);
    EXPECT_EQ(specular[1]["lobe"], "ggx:0.5");
    EXPECT_EQ(specular[2]["width"], 8);
    const Json phong = info("out/phong.ktx2")["levels"];
    EXPECT_EQ(phong[0]["lobe"], "phong:50");
    EXPECT_EQ(phong[1]["lobe"], "phong:5");
    EXPECT_EQ(info("out/diffuse.ktx2")["levels"][0]["lobe"], "diffuse");

    const Json facts = json("out/bake.json");
    EXPECT_EQ(facts["maps"].size(), 4u);
    for (const Json& map : facts["maps"]) {
        EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / map["file"].get<std::string>()));
        for (const Json& level : map["level_facts"]) {
            // What a level of 8 x 8 faces can lose of a sun by interpolation between its texels.
            for (const double ratio : level["flux_ratio"])
                EXPECT_NEAR(ratio, 1, 0.02) << map["file"];
        }
    }
    ASSERT_EQ(facts["tables"].size(), 2u);
    EXPECT_EQ(facts["tables"][0]["channels"], "scale,bias,charlie");
    EXPECT_EQ(facts["tables"][1]["surface"], "metal=gold");
    EXPECT_EQ(facts["options"]["fresnel"], "metal=gold");
    for (const Json& table : facts["tables"])
        EXPECT_EQ(std::filesystem::file_size(folder_ / "out" / table["file"].get<std::string>()),
                  table["bytes"]);
    EXPECT_LT(facts["harmonics"]["relative_rmse"], 0.2);
    EXPECT_EQ(json("out/irradiance-sh.json")["irradiance"]["coefficients"].size(), 9u);
    expect_whole_page(folder_ / "out");
}

// Where the brightest pixels lie, from 0 to 1 to the right and down.
std::pair<double, double> place_of_highlight(const std::filesystem::path& picture) {
    const Image image = read_image(picture);
    float most = 0;
    for (const float value : image.values()) most = std::max(most, value);
    double x_sum = 0, y_sum = 0, count = 0;
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            if (image.rgb(x, y).x < 0.9f * most) continue;
            x_sum += x + 0.5, y_sum += y + 0.5, ++count;
        }
    }
    return {x_sum / count / image.width(), y_sum / count / image.height()};
}

// A lamp to the right, 30 degrees up, is seen where the ball faces half way between it and us.
TEST_F(Bake, BallsShowALampOnItsSide) {
    Image lamp(64, 32, 3);
    for (float& value : lamp.values()) value = 0.02f;
    for (const int y : {10, 11})
        for (const int x : {47, 48}) lamp.set_rgb(x, y, Vec3f(40, 40, 40));
    sky_ = (folder_ / "lamp.exr").string();
    write_image(sky_, lamp);
    ASSERT_EQ(run(bake("out", {"--environment-size", "64"})).code, 0);
    const double h = 1 / std::sqrt(2.0), elevation = 28.1 * kPi / 180;  // the patch's middle
    const double right = (1 + h * std::cos(elevation)) / 2,
                 down = (1 - h * std::sin(elevation)) / 2;
    for (const char* name : {"mirror", "phong-0", "fresnel-2.4", "gold-0.1", "plastic"}) {
        const auto [x, y] = place_of_highlight(folder_ / "out" / "pictures" /
                                               (std::string("material-") + name + ".png"));
        EXPECT_NEAR(x, right, 0.04) << name;
        EXPECT_NEAR(y, down, 0.04) << name;
    }
}

// bake.json and the page tell times, so they differ from run to run; nothing else does.
TEST_F(Bake, AnyNumberOfThreadsGivesTheSameBytes) {
    std::map<std::string, std::string> first;
    for (const char* threads : {"1", "2", "3"}) {
        ASSERT_EQ(run(bake("out", {"--threads", threads})).code, 0);
        auto files = files_in(folder_ / "out");
        files.erase("bake.json");
        files.erase("index.html");
        if (first.empty()) first = files;
        EXPECT_EQ(files.size(), first.size());
        for (const auto& [name, bytes] : files) EXPECT_TRUE(bytes == first[name]) << name;
    }
}

TEST_F(Bake, ReplacesAnOlderOneAndLeavesOtherFiles) {
    std::filesystem::create_directory(folder_ / "out");
    write_contents(folder_ / "out/notes.txt", "mine");
    write_contents(folder_ / "out/specular.ktx2", "old");
    ASSERT_EQ(run(bake("out")).code, 0);
    EXPECT_EQ(contents(folder_ / "out/notes.txt"), "mine");
    EXPECT_EQ(info("out/specular.ktx2")["projection"], "cube");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 2);
}

TEST_F(Bake, AFailureLeavesTheOlderOne) {
    std::filesystem::create_directory(folder_ / "out");
    write_contents(folder_ / "out/specular.ktx2", "old");
    const auto before = files_in(folder_.path());
    std::vector<std::string> words = {"/bin/bash", "-c", "ulimit -f 4; exec \"$0\" \"$@\""};
    for (const std::string& word : command(bake("out"))) words.push_back(word);
    const Outcome outcome = Program(words).wait();
    EXPECT_EQ(outcome.code, 4) << outcome.err;
    EXPECT_EQ(files_in(folder_.path()), before);
}

// Waits until the hidden folder shows that the work has begun.
void wait_until_begun(const Program& program, const std::filesystem::path& folder) {
    while (program.running()) {
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            if (entry.path().filename().string().starts_with(".out.")) return;
        }
        std::this_thread::sleep_for(2ms);
    }
}

TEST_F(Bake, AnInterruptLeavesNothing) {
    std::filesystem::create_directory(folder_ / "out");
    write_contents(folder_ / "out/specular.ktx2", "old");
    const auto before = files_in(folder_.path());
    for (const int signal : {SIGINT, SIGTERM}) {
        // Large enough to be still at work when the signal comes.
        Program program(command(bake("out", {"--environment-size", "1024"})));
        wait_until_begun(program, folder_.path());
        std::this_thread::sleep_for(50ms);
        program.send(signal);
        const Outcome outcome = program.wait();
        EXPECT_EQ(outcome.code, 130) << outcome.err;
        EXPECT_NE(outcome.err.find("interrupted"), std::string::npos) << outcome.err;
        EXPECT_EQ(files_in(folder_.path()), before);
    }
}

TEST_F(Bake, ASecondInterruptEndsItAtOnce) {
    const auto before = files_in(folder_.path());
    Program program(command(bake("out", {"--environment-size", "2048"})));
    wait_until_begun(program, folder_.path());
    program.send(SIGINT);
    program.send(SIGTERM);
    EXPECT_EQ(program.wait().code, 130);
    EXPECT_EQ(files_in(folder_.path()), before);
}

}  // namespace
}  // namespace mirrorball
