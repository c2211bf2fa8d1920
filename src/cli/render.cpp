// mirrorball render: a picture of objects that reflect their environment.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/error.h>
#include <mirrorball/gl/context.h>
#include <mirrorball/gl/renderer.h>
#include <mirrorball/io.h>
#include <mirrorball/projections/cube.h>

#include "frames.h"
#include "output.h"
#include "progress.h"
#include "result_folder.h"
#include "scene_options.h"
#include "targets.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kUsualFps = 25;
constexpr double kLatest = 1e6;  // of Scene::time

struct Options {
    SceneInput input;
    std::string output;
    int samples = 8;
    bool es = false;
    std::optional<FrameRange> frames;  // else one picture
    std::optional<double> fps;
    bool overwrite = false;
};

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

double parse_fps(const std::string& text) {
    return parse_real_number(text, 1e-3, 1e4);
}

// A picture may have any ending that a picture has; maps' own formats are none.
void check_ending(const std::string& target) {
    check_format(target, {});
    if (target.ends_with(".ktx2") || target.ends_with(".dds"))
        throw Error(Errc::usage, fmt::format("{}: that is a format of textures; a picture is .png, "
                                             ".exr, .hdr, .tif or .pfm",
                                             target));
}

void check_picture_memory(const SceneInput& input, const Shared& shared) {
    // What one takes at its peak: the sum, one sample and what the driver keeps of both.
    constexpr std::uint64_t kBytesPerPixel = 80;
    check_memory(kBytesPerPixel * static_cast<std::uint64_t>(input.width) *
                     static_cast<std::uint64_t>(input.height),
                 "the picture", shared);
}

Json to_json(const gl::Driver& driver) {
    return {{"vendor", driver.vendor}, {"renderer", driver.renderer}, {"version", driver.version}};
}

struct Drawn {
    double seconds;  // without those of writing
    std::int64_t clipped_pixel_count;
};

// The scene and what draws it, made once for however many pictures.
class Drawer {
  public:
    Drawer(const Options& options, const Shared& shared)
        : options_(options),
          loaded_(load_scene(options.input, shared)),
          context_(options.es ? gl::Api::es : gl::Api::core),
          renderer_(loaded_.assets) {}

    [[nodiscard]] Scene& scene() { return loaded_.scene; }

    Drawn draw(const std::string& file, const Progress& progress) {
        const Clock::time_point start = Clock::now();
        const Image picture = renderer_.picture(loaded_.scene, {.width = options_.input.width,
                                                                .height = options_.input.height,
                                                                .sample_count = options_.samples,
                                                                .display = !holds_radiance(file),
                                                                .progress = progress});
        const double seconds = seconds_since(start);
        return {seconds, write_image(file, picture).clipped_texel_count};
    }

    // What all pictures have in common.
    [[nodiscard]] std::string facts_text() {
        return fmt::format("{} x {}, {} samples a pixel, method {}, maps {}", options_.input.width,
                           options_.input.height, options_.samples, name(scene().method),
                           bytes_text(renderer_.map_bytes(scene())));
    }
    [[nodiscard]] Json facts() {
        return {{"width", options_.input.width},
                {"height", options_.input.height},
                {"samples", options_.samples},
                {"method", name(scene().method)},
                {"map_bytes", renderer_.map_bytes(scene())},
                {"driver", to_json(gl::driver())}};
    }

  private:
    const Options& options_;
    LoadedScene loaded_;
    gl::Context context_;
    gl::Renderer renderer_;
};

int draw_picture(const Options& options, const Shared& shared) {
    const std::string& file = options.output;
    if (has_frame_number(file)) {
        throw Error(Errc::usage, fmt::format("{}: a frame's number goes into that name; --frames "
                                             "FIRST:LAST says which frames there are",
                                             file));
    }
    if (options.fps) throw Error(Errc::usage, "--fps: is of several pictures; see --frames");
    check_target(file, {});
    ProgressBar bar(shared);
    Drawer drawer(options, shared);
    const Drawn drawn = drawer.draw(file, bar.stage("Drawing"));
    bar.hide();
    if (shared.json) {
        Json json = {{"file", file},
                     {"seconds", drawn.seconds},
                     {"clipped_pixels", drawn.clipped_pixel_count}};
        json.update(drawer.facts());
        print_json(json);
    } else if (!shared.quiet) {
        print(fmt::format("{}: {}, {:.2f} s\n", file, drawer.facts_text(), drawn.seconds));
    }
    return 0;
}

struct Frame {
    int number;
    std::string file;
    bool skipped = false;  // it exists
    double time = 0;
    std::optional<Drawn> drawn = {};
};

std::vector<Frame> frames_of(const Options& options, const FramePattern& pattern) {
    std::vector<Frame> frames;
    for (const int number : numbers(*options.frames)) {
        Frame frame{.number = number, .file = pattern.file_of(number)};
        std::error_code ignored;
        if (std::filesystem::is_directory(frame.file, ignored)) {
            throw Error(Errc::cannot_write,
                        fmt::format("{}: is a folder; expected none, or a file", frame.file));
        }
        frame.skipped = !options.overwrite && std::filesystem::exists(frame.file, ignored);
        frames.push_back(std::move(frame));
    }
    return frames;
}

void set_times(std::vector<Frame>& frames, double start, double fps) {
    for (Frame& frame : frames) {
        frame.time = start + frame.number / fps;
        if (std::abs(frame.time) > kLatest) {
            throw Error(Errc::usage, fmt::format("--frames: frame {} at {} a second is at {:.0f} "
                                                 "seconds; time goes to {:.0f}",
                                                 frame.number, fps, frame.time, kLatest));
        }
    }
}

// No frame may depend on those drawn before it: what an interrupt left out would come out
// differently. So each has all faces of dynamic maps, as a picture drawn alone has.
void draw_all_faces(Scene& scene, const Shared& shared) {
    for (SceneObject& object : scene.objects) {
        if (!object.dynamic || object.dynamic->faces_per_frame == Cube::face_count) continue;
        tell(shared, fmt::format("faces_per_frame {} of object \"{}\" is for showing frames while "
                                 "they are drawn; here each frame has all faces",
                                 object.dynamic->faces_per_frame, object.name));
        object.dynamic->faces_per_frame = Cube::face_count;
    }
}

// After an interrupt or a failure.
void tell_how_far(const Options& options, const std::vector<Frame*>& queue, std::size_t done,
                  const Shared& shared) {
    if (done == 0) return;
    const std::string go_on =
        options.overwrite ? fmt::format("--frames {}:{}:{} --overwrite goes", queue[done]->number,
                                        options.frames->last, options.frames->step)
                          : "the same command goes";
    tell(shared, fmt::format("drew {} of {} frames, the last is {}; {} on from there", done,
                             queue.size(), queue[done - 1]->file, go_on));
}

void draw_frames(Drawer& drawer, const std::vector<Frame*>& queue, const Options& options,
                 const Shared& shared) {
    ProgressBar bar(shared);
    const double share = 1.0 / static_cast<double>(queue.size());
    for (std::size_t i = 0; i < queue.size(); ++i) {
        Frame& frame = *queue[i];
        try {
            drawer.scene().time = frame.time;
            const Progress progress =
                bar.stage(fmt::format("{}/{} Drawing", i + 1, queue.size()), share);
            frame.drawn = drawer.draw(frame.file, progress);
        } catch (...) {
            bar.hide();
            tell_how_far(options, queue, i, shared);
            throw;
        }
    }
}

Json to_json(const Frame& frame) {
    Json json = {{"frame", frame.number}, {"file", frame.file}, {"skipped", frame.skipped}};
    if (frame.drawn) {
        json["time"] = frame.time;
        json["seconds"] = frame.drawn->seconds;
        json["clipped_pixels"] = frame.drawn->clipped_pixel_count;
    }
    return json;
}

// "1 frame", "80 frames"
std::string count_text(std::size_t count) {
    return fmt::format("{} frame{}", count, count == 1 ? "" : "s");
}

int draw_animation(const Options& options, const Shared& shared) {
    const FramePattern pattern(options.output);
    check_result_folder(pattern.folder());
    std::vector<Frame> frames = frames_of(options, pattern);
    std::vector<Frame*> queue;
    for (Frame& frame : frames) {
        if (!frame.skipped) queue.push_back(&frame);
    }
    const std::size_t skipped = frames.size() - queue.size();
    Json json = {{"frames", Json::array()}, {"drawn", queue.size()}, {"skipped", skipped}};
    std::string text;
    if (!queue.empty()) {
        const Clock::time_point start = Clock::now();
        Drawer drawer(options, shared);
        set_times(frames, drawer.scene().time, options.fps.value_or(kUsualFps));
        draw_all_faces(drawer.scene(), shared);
        const ResultFolder folder(pattern.folder());
        draw_frames(drawer, queue, options, shared);
        const double seconds = seconds_since(start);
        json["seconds"] = seconds;
        json.update(drawer.facts());
        text = fmt::format("{}: {}, {}, {:.2f} s\n", options.output, count_text(queue.size()),
                           drawer.facts_text(), seconds);
    }
    if (skipped > 0) {
        text += fmt::format("{}: skipped {} that exist{}; --overwrite draws them again\n",
                            options.output, count_text(skipped), skipped == 1 ? "s" : "");
    }
    if (shared.json) {
        for (const Frame& frame : frames) json["frames"].push_back(to_json(frame));
        print_json(json);
    } else if (!shared.quiet) {
        print(text);
    }
    return 0;
}

int run(const Options& options, const Shared& shared) {
    check_ending(options.output);
    check_picture_memory(options.input, shared);
    return options.frames ? draw_animation(options, shared) : draw_picture(options, shared);
}

}  // namespace

Command render_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    Command command{.name = "render",
                    .summary =
                        "A picture of objects that reflect their environment, or an "
                        "animation."};
    add_scene_argument(command, options->input);
    command.options = {
        {"-o,--output", "FILE",
         "the picture: .png, or .exr, .hdr or .pfm for radiance; of frames as water/%04d.png",
         text(options->output), file_choices(), true},
        {"--samples", "N", "a pixel, for smooth edges [8]",
         whole_number(options->samples, 1, 1024)},
        {"--frames", "FIRST:LAST[:STEP]", "an animation, a picture for each frame",
         parsed(options->frames, parse_frame_range)},
        {"--fps", "N", "frames a second: frame n is of --time plus n / fps [25]",
         parsed(options->fps, parse_fps)},
        {"--overwrite", "", "draw frames that exist again, too", flag(options->overwrite)}};
    add_picture_size_options(command, options->input);
    add_scene_options(command, options->input);
    command.options.push_back(
        {"--es", "", "draw by OpenGL ES 3, as browsers do", flag(options->es)});
    add_shared_options(command, shared);
    command.notes = {
        "Draws by OpenGL without a window: on a graphics card where there is one, else by Mesa's "
        "llvmpipe on the processor.",
        "Options after a scene file change what it says of environment, method, camera and "
        "exposure. See docs/rendering.md for the methods.",
        "With --frames, %d in the output's name is a frame's number, %04d the same with zeros to "
        "four digits, %% a percent sign. The folder is made if there is none. Frames that exist "
        "are skipped, so that an animation that was interrupted is gone on with by the same "
        "command."};
    command.examples = {
        "mirrorball render -o teapot.png",
        "mirrorball render --mesh bunny.obj --material gold --env studio.hdr -o bunny.png",
        "mirrorball render --mesh torus --lobe phong:100 --method dual-paraboloid -o torus.exr",
        "mirrorball render docs/scenes/still-life.json -o still.png --width 1920 --height 1080",
        "mirrorball render water.json --frames 0:119 -o water/%04d.png"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
