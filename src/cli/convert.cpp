// mirrorball convert: any parameterisation, size and orientation to any other.
#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/tone_map.h>

#include "output.h"
#include "progress.h"
#include "targets.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

constexpr int kAllLevels = 0;

struct Options {
    Input input;
    std::string output, to_axes;
    std::optional<Projection> projection;
    std::optional<int> levels;
    int size = 0;
    Rotation rotation;
    bool mirror = false;
    Interpolation interpolation = Interpolation::bicubic;
    double exposure = 0;  // 0: none, or the usual one for a picture
    std::optional<ToneMap> tone_map;
    MapWriteOptions write;
};

struct Target {
    Projection projection;
    int size;
    Axes axes;
};

Target target_of(const Options& options, const EnvironmentMap& source) {
    const Projection projection = options.projection.value_or(source.projection);
    return {projection,
            options.size > 0 ? options.size : size_that_keeps_resolution(source, projection),
            options.to_axes.empty() ? default_axes(projection)
                                    : parse_axes(options.to_axes, projection)};
}

// The content moves by moving the frame that it is seen in.
Axes moved(const Axes& axes, const Options& options) {
    const Rotation& r = options.rotation;
    return rotated(options.mirror ? mirrored(axes) : axes, r.yaw, r.pitch, r.roll);
}

EnvironmentMap one_level(const EnvironmentMap& map, int level) {
    return {map.projection, map.axes, {map.levels[level]}};
}

// How many levels of the source are converted, each by itself. A chain of levels stays a chain;
// plain mips that were asked for are made anew from level 0.
int levels_to_convert(const Options& options, const EnvironmentMap& source, const Shared& shared) {
    const bool filtered = source.level_count() > 1 && source.levels.back().lobe.has_value();
    if (options.levels && !filtered) return 1;
    if (options.levels && *options.levels > source.level_count()) {
        throw Error(Errc::usage,
                    fmt::format("--levels: the input is a chain of {} levels, found {}",
                                source.level_count(), *options.levels));
    }
    if (options.levels && *options.levels != kAllLevels) return *options.levels;
    if (holds_levels(options.output)) return source.level_count();
    if (source.level_count() > 1) {
        tell(shared, fmt::format("{} holds one level; levels 1 to {} of the input are left out",
                                 options.output, source.level_count() - 1));
    }
    return 1;
}

EnvironmentMap converted(const EnvironmentMap& source, const Target& target, int level_count,
                         const Options& options, ProgressBar& bar) {
    EnvironmentMap result{target.projection, target.axes, {}};
    const int least = target.projection == Projection::equirect ? 2 : 1;
    double share = 0.75;  // each level is a quarter of the one before
    for (int i = 0; i < level_count; ++i, share /= 4) {
        const int size = std::max(least, target.size >> i);
        EnvironmentMap level = resample(one_level(source, i), target.projection, size, target.axes,
                                        {options.interpolation, bar.stage("Converting", share)});
        result.levels.push_back(std::move(level.levels.front()));
        result.levels.back().lobe = source.levels[i].lobe;
    }
    return result;
}

// From radiance to what is to be shown, where that was asked for.
void expose(EnvironmentMap& map, double usual_exposure, const Options& options) {
    const double exposure = options.exposure > 0 ? options.exposure : usual_exposure;
    for (Level& level : map.levels) {
        for (Image& face : level.faces) {
            if (options.tone_map) {
                face = tone_mapped(face, exposure, *options.tone_map);
            } else {
                for (float& value : face.values()) value *= static_cast<float>(exposure);
            }
        }
    }
}

// Room for the result, to be left by what is read; half of all where its size follows from that.
std::uint64_t result_bytes(const Options& options, const Shared& shared) {
    if (!options.projection || options.size == 0) return shared.memory_limit / 2;
    return bytes_needed(*options.projection, options.size, options.levels.has_value());
}

int run(const Options& options, const Shared& shared) {
    check_target(options.output, options.write);
    LoadedMap loaded = load(options.input, shared, result_bytes(options, shared));
    EnvironmentMap& source = loaded.map;
    const Target target = target_of(options, source);
    check_size(target.projection, target.size);
    check_memory(bytes_held(source) +
                     bytes_needed(target.projection, target.size, options.levels.has_value()),
                 fmt::format("projection {} at size {}", name(target.projection), target.size),
                 shared);
    const int level_count = levels_to_convert(options, source, shared);
    source.axes = moved(source.axes, options);

    EnvironmentMap result;
    {
        ProgressBar bar(shared);
        result = converted(source, target, level_count, options, bar);
        if (options.levels && level_count == 1 && *options.levels != 1) {
            append_mip_levels(result, *options.levels);
        }
    }
    if (options.tone_map || options.exposure > 0) expose(result, usual_exposure(source), options);
    print_written(options.output, result, write_map(options.output, result, options.write), shared);
    return 0;
}

void add_options(Command& command, Options& options) {
    const auto set_levels = [&options](const std::string& text) {
        options.levels = text == "all" ? kAllLevels : parse_whole_number(text, 1, 32);
    };
    const auto set_projection = [&options](const std::string& text) {
        options.projection = parse_projection(text);
    };
    const auto set_faces = [&options](const std::string& text) {
        options.input.faces = split(text, ',');
        if (options.input.faces.size() != 6 && options.input.faces.size() != 2) {
            throw Error(Errc::usage,
                        fmt::format("found {} files; expected six in the order +X -X +Y "
                                    "-Y +Z -Z, or two paraboloids",
                                    options.input.faces.size()));
        }
    };
    const auto set_axes = [&options](const std::string& text) {
        (void)parse_axes(text, Projection::equirect);
        options.to_axes = text;
    };
    command.options = {
        {"-o,--output", "FILE", output_help(), text(options.output), file_choices(), true},
        {"--to", "PROJECTION", "of the result [the input's]", set_projection, projection_choices()},
        {"--size", "N",
         "edge of a face in texels, an equirect's width [what keeps the input's resolution]",
         whole_number(options.size, 1, kLargestSize)},
        {"--to-axes", "PRESET", "axes of the result: a program, or as +x+y-z [ours]", set_axes,
         axes_choices()},
        {"--rotate", "YAW,PITCH,ROLL",
         "turn the environment, in degrees: left, up, clockwise [0,0,0]",
         parsed(options.rotation, parse_rotation)},
        {"--mirror", "", "exchange left and right, before it is turned", flag(options.mirror)},
        {"--faces", "A,B,C,D,E,F", "the input as six files in the order +X -X +Y -Y +Z -Z",
         set_faces, file_choices()},
        {"--levels", "N|all", "box-filtered mip levels in the result [1; a chain stays a chain]",
         set_levels},
        {"--interpolation",
         "HOW",
         "where the result is finer [bicubic]",
         parsed(options.interpolation, parse_interpolation),
         {{"bilinear", "bicubic"}, true}},
        {"--exposure", "E",
         "what radiance is multiplied by [1; with --tone-map by the environment]",
         real_number(options.exposure, 1e-12, 1e12)},
        {"--tone-map", "CURVE", "from light to what a screen shows, for pictures to look at",
         [&options](const std::string& text) { options.tone_map = parse_tone_map(text); },
         tone_map_choices()}};
}

}  // namespace

Command convert_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    Command command{.name = "convert",
                    .summary = "Any projection, size and orientation to any other."};
    add_input_argument(command, options->input, false);
    add_options(command, *options);
    add_input_options(command, options->input);
    add_write_options(command, options->write);
    add_shared_options(command, shared);
    command.notes = {
        "Every texel of the result is the mean of the input over its solid angle.",
        "The size that keeps the resolution has as many texels around a great circle: an equirect "
        "W, "
        "a cube W/4, an octahedral map or a pair of paraboloids W/2, a sphere or angular map W."};
    command.examples = {
        "mirrorball convert studio.hdr -o studio.ktx2 --to cube --levels all",
        "mirrorball convert ball.jpg -o room.exr --from sphere --crop 812,604,540 --to equirect",
        "mirrorball convert faces/%s.hdr -o turned.hdr --to equirect --rotate 90,0,0",
        "mirrorball convert builtin:sunset -o ball.png --to sphere --tone-map film",
        "mirrorball convert blender.exr -o unity.exr --axes blender --to-axes unity"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
