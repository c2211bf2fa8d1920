// mirrorball render and compare-methods.
#include <filesystem>

#include <nlohmann/json.hpp>

#include <mirrorball/io.h>
#include <mirrorball/scene.h>

#include "program.h"

namespace mirrorball {
namespace {

using Json = nlohmann::json;

// Small, so that software draws it at once.
std::vector<std::string> render(const std::string& output, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"render",   "-o", output,      "--width", "64",
                                          "--height", "48", "--samples", "2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

TEST(RenderVerb, DrawsAPictureOfTheSizeAskedFor) {
    const TemporaryFolder folder;
    const std::string target = (folder / "teapot.png").string();
    const Outcome outcome =
        run(render(target, {"--env", "builtin:axes", "--map-size", "32", "--json"}));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json json = Json::parse(outcome.out);
    EXPECT_EQ(json["method"], "cube");
    EXPECT_GT(json["map_bytes"], 6 * 32 * 32 * 8);
    EXPECT_FALSE(json["driver"]["renderer"].get<std::string>().empty());
    const Image picture = read_image(target);
    EXPECT_EQ(picture.width(), 64);
    EXPECT_EQ(picture.height(), 48);
}

// The environment of white is 1 everywhere, and a mirror in it cannot be seen.
TEST(RenderVerb, WritesRadianceWhereTheFormatHoldsIt) {
    const TemporaryFolder folder;
    const std::string target = (folder / "white.exr").string();
    ASSERT_EQ(run(render(target, {"--env", "builtin:white"})).code, 0);
    const Image picture = read_image(target);
    for (const float value : picture.values()) ASSERT_NEAR(value, 1, 1e-3);
}

TEST(RenderVerb, EveryMethodAndMaterialDraws) {
    const TemporaryFolder folder;
    const std::string target = (folder / "x.png").string();
    for (const Method method : all_methods()) {
        const Outcome outcome = run(render(target, {"--mesh", "sphere", "--env", "builtin:axes",
                                                    "--method", std::string(name(method))}));
        EXPECT_EQ(outcome.code, 0) << name(method) << ": " << outcome.err;
    }
    for (const char* material : {"gold", "satin-plastic", "glass", "matte", "phong-100"}) {
        const Outcome outcome =
            run(render(target, {"--material", material, "--env", "builtin:white"}));
        EXPECT_EQ(outcome.code, 0) << material << ": " << outcome.err;
    }
}

TEST(RenderVerb, DrawsASceneFileAndTakesWhatOptionsChange) {
    const TemporaryFolder folder;
    const std::string scene = (folder / "scene.json").string();
    const std::string target = (folder / "scene.exr").string();
    write_contents(scene, R"({"objects": [{"mesh": "sphere"}],
                              "environment": {"source": "builtin:white", "intensity": 2}})");
    ASSERT_EQ(run(render(target, {scene})).code, 0);
    EXPECT_NEAR(read_image(target).rgb(32, 24).x, 2, 1e-2);
    ASSERT_EQ(run(render(target, {scene, "--plain-background", "0.5"})).code, 0);
    EXPECT_NEAR(read_image(target).rgb(0, 0).x, 0.5, 1e-6);
    EXPECT_NEAR(read_image(target).rgb(32, 24).x, 2, 1e-2);
}

// What a scene file names is beside it; what the command line names is where the program runs.
TEST(RenderVerb, FindsTheEnvironmentOfTheCommandLineFromHere) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "scenes");
    write_contents(folder / "scenes" / "empty.json", "{}");
    ASSERT_EQ(run({"sky", "white", "-o", (folder / "w.hdr").string(), "--size", "16"}).code, 0);
    const std::string here =
        std::filesystem::relative(folder / "w.hdr", std::filesystem::current_path()).string();
    const std::string target = (folder / "p.exr").string();
    const Outcome outcome =
        run(render(target, {(folder / "scenes" / "empty.json").string(), "--env", here}));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NEAR(read_image(target).rgb(5, 5).x, 1, 1e-3);
}

// No light at all is black, not NaN.
TEST(RenderVerb, DarkEnvironmentsAreDark) {
    const TemporaryFolder folder;
    const std::string scene = (folder / "dark.json").string();
    const std::string target = (folder / "dark.png").string();
    write_contents(scene, R"({"objects": [{"mesh": "sphere", "material": "plastic"}],
                              "environment": {"source": "builtin:white", "intensity": 0}})");
    const Outcome outcome = run(render(target, {scene}));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Image picture = read_image(target);
    for (const float value : picture.values()) ASSERT_EQ(value, 0);
}

TEST(RenderVerb, RefusesWhatCannotBeDrawn) {
    const TemporaryFolder folder;
    const std::string target = (folder / "x.png").string();
    const std::string scene = (folder / "scene.json").string();
    write_contents(scene, R"({"materials": {"a": {"like": "b"}, "b": {"like": "a"}},
                              "objects": [{"material": "a"}]})");
    expect_refused(render(target, {scene}), 3, "scene.json:1:");
    write_contents(scene, "{\"objects\": [{\"mesh\": \"gone.obj\"}]}");
    expect_refused(render(target, {scene}), 3, "gone.obj");
    write_contents(scene, "{\"objects\": [");
    expect_refused(render(target, {scene}), 3, "scene.json:1:");
    expect_refused(render(target, {scene, "--material", "gold"}), 2, "objects of its own");
    expect_refused(render(target, {"--method", "cubic"}), 2, "did you mean \"cube\"");
    expect_refused(render(target, {"--mesh", "teapod"}), 2, "teapod");
    expect_refused(render(target, {"--camera", "20", "--env", "builtin:white"}), 2,
                   "not yaw, pitch");
    expect_refused(render(target, {"--base-color", "2"}), 2, "--base-color");
    expect_refused(render(target, {"--env", "gone.hdr"}), 3, "gone.hdr");
    expect_refused(render(target, {"--map-size", "16384", "--memory", "1G"}), 2, "--memory");
    expect_refused(render((folder / "x.ktx2").string()), 2, "textures");
    expect_refused(render("/nowhere/x.png"), 4, "/nowhere");
    EXPECT_FALSE(std::filesystem::exists(target));
}

// A machine without a driver: where EGL looks for one there is none.
TEST(RenderVerb, SaysWhatIsMissingWhereThereIsNoOpenGl) {
    const TemporaryFolder folder;
    const std::string target = (folder / "x.png").string();
    ASSERT_EQ(setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent", 1), 0);
    const Outcome outcome = run(render(target, {"--env", "builtin:white"}));
    unsetenv("__EGL_VENDOR_LIBRARY_DIRS");
    EXPECT_EQ(outcome.code, 5);
    EXPECT_NE(outcome.err.find("OpenGL 4.5"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("libgl1-mesa-dri"), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(target));
}

TEST(CompareMethodsVerb, WritesAPageWithFiguresThatMakeSense) {
    const TemporaryFolder folder;
    const std::string target = (folder / "methods").string();
    const Outcome outcome =
        run({"compare-methods", "--mesh", "sphere", "--env", "builtin:axes", "--width", "96",
             "--height", "72", "--samples", "2", "-o", target, "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json json = Json::parse(outcome.out);
    ASSERT_EQ(json["methods"].size(), all_methods().size());
    double error[16] = {};
    for (const Json& method : json["methods"]) {
        const std::string name = method["method"];
        EXPECT_TRUE(std::filesystem::exists(folder / "methods" / (name + ".png"))) << name;
        EXPECT_TRUE(std::filesystem::exists(folder / "methods" / (name + "-error.png"))) << name;
        EXPECT_GT(method["frame_seconds"], 0);
        error[static_cast<int>(parse_method(name))] = method["mean_error"];
    }
    // A map left as made for another view is wrong all over; per pixel is better than per vertex.
    EXPECT_GT(error[static_cast<int>(Method::sphere_stale)], 10);
    EXPECT_LT(error[static_cast<int>(Method::cube)], error[static_cast<int>(Method::cube_vertex)]);
    EXPECT_TRUE(std::filesystem::exists(folder / "methods" / "index.html"));
}

TEST(CompareMethodsVerb, LeavesNothingBehindWhenItFails) {
    const TemporaryFolder folder;
    const std::string target = (folder / "methods").string();
    expect_refused({"compare-methods", "-o", target, "--methods", "cube,ball"}, 2, "ball");
    expect_refused({"compare-methods", "-o", target, "--env", "gone.hdr"}, 3, "gone.hdr");
    EXPECT_FALSE(std::filesystem::exists(target));
    EXPECT_TRUE(files_in(folder.path()).empty());
}

}  // namespace
}  // namespace mirrorball
