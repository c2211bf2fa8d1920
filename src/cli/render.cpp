// mirrorball render: a picture of objects that reflect their environment.
#include <chrono>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/error.h>
#include <mirrorball/gl/context.h>
#include <mirrorball/gl/renderer.h>
#include <mirrorball/io.h>

#include "output.h"
#include "progress.h"
#include "scene_options.h"
#include "targets.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

struct Options {
    SceneInput input;
    std::string output;
    int samples = 8;
    bool es = false;
};

// What a picture takes at its peak: the sum, one sample and what the driver keeps of both.
constexpr std::uint64_t kBytesPerPixel = 80;

// A picture may have any ending that a picture has; maps' own formats are none.
void check_output(const std::string& target) {
    check_target(target, {});
    if (target.ends_with(".ktx2") || target.ends_with(".dds"))
        throw Error(Errc::usage, fmt::format("{}: that is a format of textures; a picture is .png, "
                                             ".exr, .hdr, .tif or .pfm",
                                             target));
}

Json to_json(const gl::Driver& driver) {
    return {{"vendor", driver.vendor}, {"renderer", driver.renderer}, {"version", driver.version}};
}

int run(const Options& options, const Shared& shared) {
    const SceneInput& input = options.input;
    check_output(options.output);
    check_memory(kBytesPerPixel * static_cast<std::uint64_t>(input.width) *
                     static_cast<std::uint64_t>(input.height),
                 "the picture", shared);
    ProgressBar bar(shared);
    const LoadedScene loaded = load_scene(input, shared);
    const gl::Context context(options.es ? gl::Api::es : gl::Api::core);
    gl::Renderer renderer(loaded.assets);
    const auto start = std::chrono::steady_clock::now();
    const Image picture =
        renderer.picture(loaded.scene, {.width = input.width,
                                        .height = input.height,
                                        .sample_count = options.samples,
                                        .display = !holds_radiance(options.output),
                                        .progress = bar.stage("Drawing")});
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    const WriteReport report = write_image(options.output, picture);
    bar.hide();
    const std::uint64_t map_bytes = renderer.map_bytes(loaded.scene);
    if (shared.json) {
        print_json({{"file", options.output},
                    {"width", input.width},
                    {"height", input.height},
                    {"samples", options.samples},
                    {"method", name(loaded.scene.method)},
                    {"seconds", seconds.count()},
                    {"map_bytes", map_bytes},
                    {"clipped_pixels", report.clipped_texel_count},
                    {"driver", to_json(gl::driver())}});
    } else if (!shared.quiet) {
        print(fmt::format("{}: {} x {}, {} samples a pixel, method {}, maps {}, {:.2f} s\n",
                          options.output, input.width, input.height, options.samples,
                          name(loaded.scene.method), bytes_text(map_bytes), seconds.count()));
    }
    return 0;
}

}  // namespace

Command render_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    Command command{.name = "render",
                    .summary = "A picture of objects that reflect their environment."};
    add_scene_argument(command, options->input);
    command.options = {
        {"-o,--output", "FILE", "the picture: .png, or .exr, .hdr or .pfm for radiance",
         text(options->output), file_choices(), true},
        {"--samples", "N", "a pixel, for smooth edges [8]",
         whole_number(options->samples, 1, 1024)}};
    add_picture_size_options(command, options->input);
    add_scene_options(command, options->input);
    command.options.push_back(
        {"--es", "", "draw by OpenGL ES 3, as browsers do", flag(options->es)});
    add_shared_options(command, shared);
    command.notes = {
        "Draws by OpenGL without a window: on a graphics card where there is one, else by Mesa's "
        "llvmpipe on the processor.",
        "Options after a scene file change what it says of environment, method, camera and "
        "exposure. See docs/rendering.md for the methods."};
    command.examples = {
        "mirrorball render -o teapot.png",
        "mirrorball render --mesh bunny.obj --material gold --env studio.hdr -o bunny.png",
        "mirrorball render --mesh torus --lobe phong:100 --method dual-paraboloid -o torus.exr",
        "mirrorball render docs/scenes/still-life.json -o still.png --width 1920 --height 1080"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
