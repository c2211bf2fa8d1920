// mirrorball view: a scene live in a window.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/error.h>
#include <mirrorball/io.h>
#include <mirrorball/viewer.h>

#include "interrupt.h"
#include "output.h"
#include "scene_options.h"
#include "targets.h"
#include "verbs.h"
#ifdef MIRRORBALL_HAS_WINDOW
#include "window/view_window.h"
#endif

namespace mirrorball::cli {
namespace {

struct Options {
    SceneInput input;
    std::string file;
    Comparison comparison;
    int samples = 8, frames = 0;
    double scale = 0;
    std::string screenshot, script;
    bool panel = false;
};

#ifdef MIRRORBALL_HAS_WINDOW

// FILE is what `render` calls by three names.
SceneInput with_file(SceneInput input, const std::string& file) {
    const std::string ending = std::filesystem::path(file).extension().string();
    if (ending == ".json") {
        input.file = file;
    } else if (ending == ".obj" || ending == ".gltf" || ending == ".glb") {
        input.mesh = file;
    } else if (!file.empty()) {
        input.environment = file;
    }
    return input;
}

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    if (!(text << file.rdbuf()))
        throw Error(Errc::cannot_read, fmt::format("{}: cannot be read", path));
    return text.str();
}

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::nth_element(values.begin(),
                     values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

Viewer make_viewer(const Options& options, const Shared& shared, const Progress& reading,
                   const Progress& prefiltering) {
    const SceneInput input = with_file(options.input, options.file);
    Viewer viewer(scene_of(input), folder_of(input),
                  {.memory_limit = shared.memory_limit,
                   .sample_count = options.samples,
                   .reading = reading,
                   .prefiltering = prefiltering});
    Scene scene = viewer.scene();
    place_camera_as_asked(scene, viewer.assets(), input);
    viewer.set_scene(scene);
    viewer.set_comparison(options.comparison);
    return viewer;
}

int run(const Options& options, const Shared& shared) {
    if (!options.screenshot.empty()) check_target(options.screenshot, {});
    window::Options window_options;
    window_options.width = options.input.width;
    window_options.height = options.input.height;
    window_options.scale = options.scale;
    // A script without a number of frames ends when it is done.
    window_options.frames = options.frames == 0 && !options.script.empty() ? 1 : options.frames;
    window_options.screenshot = options.screenshot;
    window_options.panel = options.panel || window_options.frames == 0;
    if (!options.script.empty())
        window_options.script = window::parse_script(contents(options.script), options.script);
    window_options.stop = interrupted;

    const window::Report report = window::show(
        [&](const Progress& reading, const Progress& prefiltering) {
            return make_viewer(options, shared, reading, prefiltering);
        },
        window_options);
    const double seconds = median(report.seconds);
    if (shared.json) {
        print_json({{"frames", report.seconds.size()},
                    {"median_frame_seconds", seconds},
                    {"seconds", report.seconds},
                    {"driver",
                     {{"vendor", report.driver.vendor},
                      {"renderer", report.driver.renderer},
                      {"version", report.driver.version}}}});
    } else if (!shared.quiet && window_options.frames > 0) {
        print(fmt::format("{} frames, median {:.1f} ms\n", report.seconds.size(), seconds * 1000));
    }
    return 0;
}

std::string keys_text() {
    std::string text = "Keys:";
    for (const KeyHelp& key : Viewer::keys()) text += fmt::format(" {}: {};", key.keys, key.what);
    for (const KeyHelp& key : window::window_keys())
        text += fmt::format(" {}: {};", key.keys, key.what);
    text.back() = '.';
    return text;
}

#else

int run(const Options&, const Shared&) {
    throw Error(Errc::unsupported,
                "this build has no window: it was made without GLFW and Dear ImGui (on Debian "
                "libglfw3-dev and libimgui-dev); \"mirrorball render\" draws pictures");
}

std::string keys_text() {
    return "This build has no window.";
}

#endif

}  // namespace

Command view_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    Command command{.name = "view", .summary = "A scene live in a window."};
    command.arguments = {{"FILE", "an environment, a mesh (.obj, .gltf, .glb) or a scene (.json)",
                          text(options->file), input_choices(), false}};
    Choices methods{.values = {}, .closed = true};
    for (const Method method : all_methods()) methods.values.emplace_back(name(method));
    command.options = {
        {"--show",
         "HOW",
         "one method, two with a wipe, or their difference [one]",
         parsed(options->comparison.showing, parse_showing),
         {.values = {"one", "wipe", "difference"}, .closed = true}},
        {"--other", "METHOD", "the second method [sphere-vertex]",
         parsed(options->comparison.other, parse_method), methods},
        {"--wipe", "X", "share of the width that the first method has [0.5]",
         real_number(options->comparison.wipe, 0, 1)},
        {"--samples", "N", "a pixel, taken while nothing moves [8]",
         whole_number(options->samples, 1, 1024)},
        {"--frames", "N", "ends after so many, and has no controls unless --panel [none]",
         whole_number(options->frames, 1, 1000000)},
        {"--screenshot", "FILE", "what is shown at the end, as a picture",
         text(options->screenshot), file_choices()},
        {"--panel", "", "controls and maps, too, where --frames or --script is given",
         flag(options->panel)},
        {"--script", "FILE",
         "steps, one before each frame: resize W H, drop FILE, key KEY, drag DX DY [FRAMES], "
         "lobe KIND FROM TO FRAMES, wait FRAMES",
         text(options->script), file_choices()},
        {"--scale", "S", "of text and controls [as the screen says]",
         real_number(options->scale, 0.5, 4)}};
    add_picture_size_options(command, options->input);
    add_scene_options(command, options->input);
    add_shared_options(command, shared);
    command.notes = {
        "Environments, meshes and scenes can be dropped on the window. It remembers "
        "nothing; scenes are saved where you say. docs/viewer.md shows it.",
        keys_text()};
    command.examples = {
        "mirrorball view", "mirrorball view studio.hdr",
        "mirrorball view bunny.obj --material gold --env builtin:studio",
        "mirrorball view docs/scenes/still-life.json --show wipe --other dual-paraboloid",
        "mirrorball view --frames 9 --screenshot teapot.png"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
