// The viewer in a bake's report: there where the page for browsers is, and only there. How it looks
// and acts is tested in a browser (tests/web/report_test.mjs).
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include <mirrorball/io.h>

#include "program.h"

namespace mirrorball {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kScript = "function mirrorball_embed() {}\n";

// A program that is installed, with what is to be its page.
class ReportViewer : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(page_);
        fs::create_directory(folder_ / "bin");
        fs::copy_file(MIRRORBALL_PROGRAM, folder_ / "bin/mirrorball");
        write_contents(page_ / "embed.js", kScript);
        fs::create_directory(out_);
        Image sky(64, 32, 3);
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 64; ++x)
                sky.set_rgb(x, y, Vec3f(1, static_cast<float>(x) / 64, y < 4 && x < 8 ? 50.0f : 0.1f));
        sky_ = (folder_ / "sky.pfm").string();
        write_image(sky_, sky);
    }
    [[nodiscard]] std::vector<std::string> bake(std::vector<std::string> more) const {
        std::vector<std::string> words = {(folder_ / "bin/mirrorball").string(),
                                          "bake",
                                          "--size",
                                          "64",
                                          "--levels",
                                          "3",
                                          "--diffuse-size",
                                          "8",
                                          "--quiet"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    [[nodiscard]] std::string out(const std::string& name) const { return (out_ / name).string(); }
    void must(const std::vector<std::string>& more) const {
        const Outcome outcome = Program(bake(more)).wait();
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
    }
    /// Of everything that was baked, by path.
    [[nodiscard]] std::vector<std::string> names() const {
        std::vector<std::string> names;
        for (const auto& [name, bytes] : files_in(out_)) names.push_back(name);
        return names;
    }
    [[nodiscard]] bool is_there(const std::string& name) const { return fs::exists(out_ / name); }

    TemporaryFolder folder_;
    fs::path page_ = folder_ / "share/mirrorball/page", out_ = folder_ / "out";
    std::string sky_;
};

std::string from_base64(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned bits = 0;
    int count = 0;
    for (const char c : text) {
        if (c == '=') break;
        bits = bits << 6 | static_cast<unsigned>(digits.find(c));
        if (++count % 4 != 1) bytes += static_cast<char>(bits >> (6 - 2 * ((count - 1) % 4)) & 255);
    }
    return bytes;
}

// What the script sets, as JSON.
Json maps_in(const std::string& script) {
    const std::size_t start = script.find('{'), end = script.rfind('}');
    EXPECT_NE(script.find("var mirrorball_maps = {"), std::string::npos);
    return Json::parse(script.substr(start, end + 1 - start));
}

// The largest difference of two levels, in shares of the texel's brightest channel: shared
// exponents keep 9 bits of it.
double difference(const Level& a, const Level& b) {
    double most = 0;
    for (std::size_t face = 0; face < 6; ++face) {
        for (int y = 0; y < a.height(); ++y) {
            for (int x = 0; x < a.width(); ++x) {
                const Vec3f p = a.faces[face].rgb(x, y), q = b.faces[face].rgb(x, y);
                const float scale = std::max({p.x, p.y, p.z});
                for (int c = 0; c < 3; ++c)
                    most = std::max<double>(most, std::abs(p[c] - q[c]) / scale);
            }
        }
    }
    return most;
}

TEST_F(ReportViewer, HasTheMapsThatWereBaked) {
    must({sky_, "-o", out("one"), "--phong", "5,50"});
    EXPECT_EQ(contents(out_ / "one/viewer.js"), kScript);
    const Json maps = maps_in(contents(out_ / "one/maps.js"));
    EXPECT_GT(maps["exposure"], 0);
    EXPECT_EQ(maps["roughnesses"], Json({0, 0.5, 1}));
    // Level 0 of the chain is the mirror, which the environment is, too.
    const std::map<std::string, std::pair<std::string, int>> levels = {
        {"environment", {"environment.ktx2", 0}}, {"specular-1", {"specular.ktx2", 1}},
        {"specular-2", {"specular.ktx2", 2}},     {"phong-0", {"phong.ktx2", 0}},
        {"phong-1", {"phong.ktx2", 1}},           {"diffuse", {"diffuse.ktx2", 0}}};
    EXPECT_EQ(maps["files"].size(), levels.size() + 1);
    for (const auto& [name, level] : levels) {
        const fs::path file = folder_ / "map.ktx2";
        write_contents(file, from_base64(maps["files"][name].get<std::string>()));
        const EnvironmentMap map = read_map(file.string()).map;
        const EnvironmentMap baked = read_map((out_ / "one" / level.first).string()).map;
        ASSERT_EQ(map.width(), baked.width(level.second)) << name;
        EXPECT_EQ(map.levels[0].lobe, baked.levels[level.second].lobe) << name;
        EXPECT_LT(difference(baked.levels[level.second], map.levels[0]), 1.0 / 256) << name;
    }
    EXPECT_EQ(from_base64(maps["files"]["dfg"].get<std::string>()),
              contents(out_ / "one/dfg.ktx2"));
}

TEST_F(ReportViewer, IsInThePageWithItsControls) {
    must({sky_, "-o", out("one"), "--phong", "5,50"});
    const std::string page = contents(out_ / "one/index.html");
    for (const char* part : {"load('viewer.js')", "load('maps.js')", "pictures/viewer.png",
                             "<option>50</option><option>5</option>", "name=\"roughness\""})
        EXPECT_NE(page.find(part), std::string::npos) << part;
    EXPECT_EQ(page.find("http"), std::string::npos);
    const Image still = read_image(out_ / "one/pictures/viewer.png");
    EXPECT_EQ(still.width(), 2 * still.height());
}

TEST_F(ReportViewer, IsReducedToWhatAScreenShows) {
    must({sky_, "-o", out("one"), "--environment-size", "512", "--phong", "5"});
    const Json maps = maps_in(contents(out_ / "one/maps.js"));
    write_contents(folder_ / "map.ktx2",
                   from_base64(maps["files"]["environment"].get<std::string>()));
    EXPECT_EQ(read_map((folder_ / "map.ktx2").string()).map.width(), 256);
}

// Where there is no page, nothing that can be read, or it is not wanted, all is as it was before
// there was a viewer.
TEST_F(ReportViewer, IsNowhereElse) {
    must({sky_, "-o", out("a"), "--no-viewer"});
    fs::remove(page_ / "embed.js");
    must({sky_, "-o", out("b")});
    fs::create_directory(page_ / "embed.js");
    must({sky_, "-o", out("c")});
    fs::remove_all(folder_ / "share");
    must({sky_, "-o", out("d")});
    for (const std::string& name : names()) {
        EXPECT_FALSE(name.ends_with(".js")) << name;
        EXPECT_EQ(name.find("viewer"), std::string::npos) << name;
    }
    EXPECT_EQ(names().size() % 4, 0u);
    for (const char* name : {"a", "b", "c", "d"}) {
        const std::string page = contents(out_ / name / "index.html");
        EXPECT_EQ(page.find("<script"), std::string::npos) << name;
        EXPECT_EQ(page.find("class=\"live\""), std::string::npos) << name;
    }
}

TEST_F(ReportViewer, SeveralReportsShareAScript) {
    fs::copy_file(sky_, folder_ / "other.pfm");
    must({sky_, (folder_ / "other.pfm").string(), "-o", out("both")});
    EXPECT_EQ(contents(out_ / "both/viewer.js"), kScript);
    for (const std::string name : {"both/sky", "both/other"}) {
        EXPECT_TRUE(is_there(name + "/maps.js"));
        EXPECT_FALSE(is_there(name + "/viewer.js"));
        EXPECT_NE(contents(out_ / name / "index.html").find("load('../viewer.js')"),
                  std::string::npos);
    }
}

TEST_F(ReportViewer, WhatFailsLeavesNothing) {
    write_contents(folder_ / "bad.pfm", "certainly not a picture");
    write_contents(folder_ / "worse.pfm", "certainly not a picture");
    const Outcome none = Program(bake({(folder_ / "bad.pfm").string(),
                                       (folder_ / "worse.pfm").string(), "-o", out("both")}))
                             .wait();
    EXPECT_EQ(none.code, 3) << none.err;
    EXPECT_TRUE(names().empty());
    // Its maps are the first file that is larger than 600 blocks of a kilobyte.
    std::vector<std::string> words = {"/bin/bash", "-c", "ulimit -f 600; exec \"$0\" \"$@\""};
    for (const std::string& word :
         bake({sky_, "-o", out("one"), "--environment-size", "64", "--phong", "1"}))
        words.push_back(word);
    fs::resize_file(page_ / "embed.js", 1'000'000);
    const Outcome full = Program(words).wait();
    EXPECT_EQ(full.code, 4) << full.err;
    EXPECT_TRUE(names().empty());
}

}  // namespace
}  // namespace mirrorball
