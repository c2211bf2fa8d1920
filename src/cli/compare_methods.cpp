// mirrorball compare-methods: one scene by every method, with the error, bytes and time of each.
#include <algorithm>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/error.h>
#include <mirrorball/gl/context.h>
#include <mirrorball/io.h>

#include "false_color.h"
#include "interrupt.h"
#include "method_comparison.h"
#include "output.h"
#include "progress.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

struct Options {
    SceneInput input;
    std::string output;
    std::vector<Method> methods;  ///< none: all that can show the scene
    int samples = 8;
};

std::vector<Method> parse_methods(const std::string& text) {
    std::vector<Method> methods;
    for (const std::string& part : split(text, ',')) methods.push_back(parse_method(part));
    return methods;
}

std::vector<Method> methods_that_can_show(const Scene& scene) {
    std::vector<Method> methods;
    for (const Method method : all_methods()) {
        const auto can = [&](const SceneObject& object) {
            return can_show(method, object.material.bump);
        };
        if (std::all_of(scene.objects.begin(), scene.objects.end(), can)) methods.push_back(method);
    }
    return methods;
}

Image in_false_colors(const Image& error) {
    Image picture(error.width(), error.height(), 3);
    for (int y = 0; y < error.height(); ++y) {
        for (int x = 0; x < error.width(); ++x)
            picture.set_rgb(x, y, false_color(*error.at(x, y) / kErrorShownWhite));
    }
    return picture;
}

void write_pictures(const MethodComparison& comparison, const std::filesystem::path& folder) {
    const auto write = [&](const std::string& file, const Image& image) {
        write_image(folder / file, image, {.format = TexelFormat::unorm8});
    };
    write("truth.png", comparison.truth);
    for (const MethodResult& result : comparison.results) {
        write(fmt::format("{}.png", name(result.method)), result.picture);
        write(fmt::format("{}-error.png", name(result.method)), in_false_colors(result.error));
    }
}

Json to_json(const MethodComparison& comparison, const gl::Driver& driver) {
    Json methods = Json::array();
    for (const MethodResult& result : comparison.results) {
        methods.push_back({{"method", name(result.method)},
                           {"mean_error", result.mean_error},
                           {"error_percentile_99", result.percentile_99},
                           {"largest_error", result.largest_error},
                           {"map_bytes", result.map_bytes},
                           {"frame_seconds", result.frame_seconds}});
    }
    return {{"driver", driver.renderer},
            {"width", comparison.truth.width()},
            {"height", comparison.truth.height()},
            {"object_pixels", comparison.pixel_count},
            {"constant_color_seconds", comparison.constant_seconds},
            {"methods", methods}};
}

std::string to_text(const MethodComparison& comparison) {
    std::string text = fmt::format("{:<24}{:>8}{:>8}{:>8}{:>11}{:>10}{:>8}\n", "method", "mean",
                                   "99 %", "most", "maps", "frame", "ratio");
    for (const MethodResult& result : comparison.results) {
        text += fmt::format("{:<24}{:>8.2f}{:>8.1f}{:>8.0f}{:>11}{:>7.1f} ms{:>8.2f}\n",
                            name(result.method), result.mean_error, result.percentile_99,
                            result.largest_error, bytes_text(result.map_bytes),
                            result.frame_seconds * 1e3,
                            result.frame_seconds / comparison.constant_seconds);
    }
    return text;
}

int run(const Options& options, const Shared& shared) {
    const SceneInput& input = options.input;
    TemporaryFolder folder(options.output);
    ProgressBar bar(shared);
    const LoadedScene loaded = load_scene(input, shared);
    const gl::Context context;
    const std::vector<Method> methods =
        options.methods.empty() ? methods_that_can_show(loaded.scene) : options.methods;
    const MethodComparison comparison = compare_methods(
        loaded, input.width, input.height, options.samples, methods, bar.stage("Drawing"));
    const gl::Driver driver = gl::driver();
    write_pictures(comparison, folder.path());
    const Json json = to_json(comparison, driver);
    write_text(folder.path() / "methods.json", json.dump(2) + "\n");
    write_text(folder.path() / "index.html", methods_page(comparison, driver.renderer, input));
    stop_if_interrupted();
    folder.move_to(options.output);
    bar.hide();
    if (shared.json) {
        print_json(json);
    } else if (!shared.quiet) {
        print(to_text(comparison) +
              fmt::format("{}  open this to see it\n",
                          (std::filesystem::path(options.output) / "index.html").string()));
    }
    return 0;
}

}  // namespace

Command compare_methods_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    options->input.width = 640, options->input.height = 480;
    Command command{.name = "compare-methods",
                    .summary = "One object reflecting by every method, each next to the truth."};
    add_scene_argument(command, options->input);
    Choices methods{.values = {}, .closed = true};
    for (const Method method : all_methods()) methods.values.emplace_back(name(method));
    command.options = {
        {"-o,--output", "DIR", "folder for the pictures, methods.json and index.html",
         text(options->output), file_choices(), true},
        {"--methods", "METHOD,...", "to compare [all that can show the scene]",
         parsed(options->methods, parse_methods), methods},
        {"--samples", "N", "a pixel [8]", whole_number(options->samples, 1, 1024)}};
    add_picture_size_options(command, options->input);
    add_scene_options(command, options->input);
    add_shared_options(command, shared);
    command.notes = {
        "The truth is each pixel's surface evaluated by the equations, its reflection looked up in "
        "the environment itself. Errors are in steps of 255 of what a screen shows; `ratio` is a "
        "frame's time over that of the same objects in a constant colour."};
    command.examples = {
        "mirrorball compare-methods -o methods",
        "mirrorball compare-methods --mesh torus --env studio.hdr -o torus",
        "mirrorball compare-methods --methods cube,cube-vertex --map-size 64 -o two"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
