// mirrorball bump: height, normal and du/dv maps, made and converted.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/bump.h>
#include <mirrorball/error.h>

#include "bump/levels.h"
#include "io/codec.h"
#include "output.h"
#include "targets.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

struct Options {
    std::string source, output;
    BumpReadOptions read;
    BumpKind to = BumpKind::normal;
    double width = 0, time = 0;
    int size = 512;
    bool has_size = false, has_time = false, list = false;
    bool all_levels = false;
    Green green = Green::up;
    TexelFormat format = TexelFormat::automatic;
};

int print_list(const Shared& shared) {
    Json json = Json::array();
    std::string text;
    for (const BumpSource& source : bump_sources()) {
        json.push_back({{"name", source.name},
                        {"description", source.description},
                        {"width", source.width},
                        {"moves", source.moves}});
        text += fmt::format("{:<10} {} ({:g} m{})\n", source.name, source.description, source.width,
                            source.moves ? ", moves" : "");
    }
    shared.json ? print_json(Json{{"sources", json}}) : print(text);
    return 0;
}

bool is_integer(TexelFormat format) {
    return format == TexelFormat::unorm8 || format == TexelFormat::unorm16;
}

BumpPicture read_picture(const Options& options, const Shared& shared) {
    BumpReadOptions read = options.read;
    if (options.width > 0) read.width = options.width;
    read.memory_limit = shared.memory_limit;
    BumpPicture bump = read_bump(options.source, read);
    if (!read.kind)
        tell(shared, fmt::format("{}: taken as a {} map; --from says otherwise", options.source,
                                 name(bump.kind)));
    for (const std::string& remark : bump.remarks)
        tell(shared, fmt::format("{}: {}", options.source, remark));
    return bump;
}

BumpPicture draw_bump(const std::string& builtin, const Options& options) {
    std::vector<std::string> names;
    bool moves = false;
    for (const BumpSource& source : bump_sources()) {
        names.push_back(source.name);
        if (source.name == builtin) moves = source.moves;
    }
    if (std::find(names.begin(), names.end(), builtin) == names.end())
        throw Error(Errc::usage, unknown("a bump source", builtin, names));
    if (options.has_time && !moves)
        throw Error(Errc::usage, fmt::format("--time: {} does not move", builtin));
    HeightMap relief = make_bump(builtin, options.size, options.size,
                                 {.width = options.width, .time = options.time});
    for (float& height : relief.heights.values())
        height = static_cast<float>(height * options.read.scale);
    relief.wrap = options.read.wrap.value_or(Wrap::repeat);
    SlopeMap map = slopes(relief);
    return {BumpKind::height, std::move(relief), std::move(map), {}, {}};
}

// Writing -----------------------------------------------------------------------------------------

// Numbers are kept with as many digits as the format has.
TexelFormat format_for(const Options& options) {
    if (options.format != TexelFormat::automatic) return options.format;
    const auto& known = detail::codec_for_name(options.output).texel_formats;
    for (const TexelFormat best : {TexelFormat::rgba32f, TexelFormat::unorm16})
        if (std::find(known.begin(), known.end(), best) != known.end()) return best;
    return known.front();
}

// Heights in metres; as integers, from the lowest (0) to the highest (1).
Image stored_heights(const HeightMap& relief, bool integer, const Options& options,
                     const Shared& shared) {
    if (!integer) return relief.heights;
    Image picture = relief.heights;
    const auto values = picture.values();
    const auto [low_at, high_at] = std::minmax_element(values.begin(), values.end());
    const double low = *low_at, span = *high_at - low;
    for (float& value : values) value = span > 0 ? static_cast<float>((value - low) / span) : 0.5f;
    if (span > 0)
        tell(shared, fmt::format("{}: black is {:g} m and white {:g} m: --scale {:g} --width {:g} "
                                 "reads it back",
                                 options.output, low, low + span, span, relief.width));
    return picture;
}

// du and dv as red and green; as integers 1/2 + slope / (2 range).
Image stored_slopes(const SlopeMap& map, bool integer, double range) {
    Image picture(map.slopes.width(), map.slopes.height(), 3);
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            for (int c = 0; c < 2; ++c) {
                const double slope = map.slopes.at(x, y)[c];
                picture.at(x, y)[c] =
                    static_cast<float>(integer ? 0.5 + 0.5 * slope / range : slope);
            }
    return picture;
}

// What a smaller level of normals or slopes loses, each as GGX's alpha in the fourth channel, to be
// added in squares to that of the surface.
Image with_alpha(const Image& picture, const BumpLevel& level) {
    Image result(picture.width(), picture.height(), 4);
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) {
            std::copy_n(picture.at(x, y), 3, result.at(x, y));
            const double variance = covariance(level, x, y).mean();
            result.at(x, y)[3] = static_cast<float>(alpha_with_variance(0, variance));
        }
    return result;
}

std::vector<Image> stored_levels(const BumpPicture& bump, bool integer, const Options& options,
                                 const Shared& shared) {
    if (options.to == BumpKind::height) {
        Image heights = stored_heights(*bump.relief, integer, options, shared);
        if (!options.all_levels) return {std::move(heights)};
        return detail::area_levels(std::move(heights));
    }
    const auto stored = [&](const SlopeMap& slopes, const NormalMap& normals) {
        return options.to == BumpKind::normal ? stored_normals(normals, options.green)
                                              : stored_slopes(slopes, integer, options.read.range);
    };
    const NormalMap finest = bump.normals ? *bump.normals : normals(bump.slopes);
    if (!options.all_levels) return {stored(bump.slopes, finest)};
    std::vector<Image> levels;
    for (const BumpLevel& level : bump_levels(bump.slopes)) {
        // Directions of the mean slopes: of unit length, as shaders expect it.
        const NormalMap mean = levels.empty() ? finest : normals(SlopeMap{level.mean});
        levels.push_back(with_alpha(stored({level.mean}, mean), level));
    }
    return levels;
}

Json levels_json(const SlopeMap& map) {
    Json json = Json::array();
    for (const BumpLevel& level : bump_levels(map)) {
        double variance = 0, length = 0;
        for (int y = 0; y < level.mean.height(); ++y)
            for (int x = 0; x < level.mean.width(); ++x) {
                variance += covariance(level, x, y).mean();
                length += level.normal.rgb(x, y).length();
            }
        const auto count = static_cast<double>(level.mean.texel_count());
        json.push_back({{"width", level.mean.width()},
                        {"height", level.mean.height()},
                        {"slope_variance", variance / count},
                        {"alpha", alpha_with_variance(0, variance / count)},
                        {"alpha_toksvig", alpha_with_mean_length(0, length / count)}});
    }
    return json;
}

double steepest(const SlopeMap& map) {
    double most = 0;
    for (int y = 0; y < map.slopes.height(); ++y)
        for (int x = 0; x < map.slopes.width(); ++x)
            most =
                std::max<double>(most, std::hypot(map.slopes.at(x, y)[0], map.slopes.at(x, y)[1]));
    return most;
}

void print_result(const Options& options, const BumpPicture& bump, TexelFormat format,
                  const WriteReport& report, const Shared& shared) {
    const Image& slopes = bump.slopes.slopes;
    const double angle = std::atan(steepest(bump.slopes)) * 180 / kPi;
    if (!shared.json) {
        if (!shared.quiet)
            print(fmt::format("{}: {} map, {} x {}, {}, at most {:.3g}° steep, {}\n",
                              options.output, name(options.to), slopes.width(), slopes.height(),
                              name(format), angle, bytes_text(report.byte_count)));
        return;
    }
    Json json{{"file", options.output},
              {"kind", name(options.to)},
              {"width", slopes.width()},
              {"height", slopes.height()},
              {"format", name(format)},
              {"bytes", report.byte_count},
              {"clipped_texels", report.clipped_texel_count},
              {"steepest_degrees", angle}};
    if (options.to == BumpKind::normal) json["green"] = name(options.green);
    if (bump.relief) {
        const auto values = bump.relief->heights.values();
        const auto [low, high] = std::minmax_element(values.begin(), values.end());
        json["metres"] = {{"width", bump.relief->width},
                          {"height", bump.relief->height},
                          {"lowest", *low},
                          {"highest", *high}};
    }
    json["levels"] = levels_json(bump.slopes);
    print_json(json);
}

void check_options(const Options& options, bool drawn) {
    if (options.source.empty())
        throw Error(Errc::usage,
                    "IN is missing: a file, or builtin:NAME; see mirrorball bump --list");
    if (options.output.empty()) throw Error(Errc::usage, "--output FILE is missing");
    MapWriteOptions write;
    write.format = options.format;
    check_target(options.output, write);
    if (drawn && options.read.kind)
        throw Error(Errc::usage, "--from: built-in sources are heights");
    if (!drawn && options.has_size)
        throw Error(Errc::usage, "--size: only built-in sources have any; files keep their own");
    if (!drawn && options.has_time) throw Error(Errc::usage, "--time: only built-in sources move");
}

int run(const Options& options, const Shared& shared) {
    if (options.list) return print_list(shared);
    const bool drawn = options.source.starts_with("builtin:");
    check_options(options, drawn);
    const auto texels = static_cast<std::uint64_t>(options.size) * options.size;
    if (drawn) check_memory(texels * 9 * sizeof(float), "the map", shared);

    const BumpPicture bump =
        drawn ? draw_bump(options.source.substr(8), options) : read_picture(options, shared);
    if (options.to == BumpKind::height && !bump.relief)
        throw Error(Errc::usage,
                    fmt::format("--to height: {} holds a {} map, and heights do not follow from it",
                                options.source, name(bump.kind)));
    WriteOptions write;
    write.format = format_for(options);
    write.transfer = Transfer::linear;
    write.metadata = {{"mirrorball.bump", std::string(name(options.to))}};
    if (options.to == BumpKind::normal)
        write.metadata["mirrorball.green"] = std::string(name(options.green));
    const WriteReport report = detail::write_levels(
        options.output, stored_levels(bump, is_integer(write.format), options, shared), write);
    if (report.clipped_texel_count > 0)
        tell(shared, fmt::format("{}: {} texels are beyond what the format holds and are clipped{}",
                                 options.output, report.clipped_texel_count,
                                 options.to == BumpKind::slopes ? "; --range widens it" : ""));
    print_result(options, bump, write.format, report, shared);
    return 0;
}

// Sets a value and notes that it was given.
SetValue noted(SetValue set, bool& given) {
    return [set = std::move(set), &given](const std::string& typed) {
        set(typed);
        given = true;
    };
}

Choices source_choices() {
    Choices choices = file_choices();
    for (const BumpSource& source : bump_sources())
        choices.values.push_back("builtin:" + source.name);
    return choices;
}

}  // namespace

Command bump_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    Command command{.name = "bump",
                    .summary = "Height, normal and du/dv maps: made, and converted to each other."};
    command.arguments = {{"IN", "a picture, or builtin:NAME; --list shows those",
                          text(options->source), source_choices(), false}};
    const Choices kinds{{"height", "normal", "dudv"}, true}, greens{{"up", "down"}, true};
    BumpReadOptions& read = options->read;
    const SetValue set_from = [&read](const std::string& typed) {
        read.kind = parse_bump_kind(typed);
    };
    const SetValue set_wrap = [&read](const std::string& typed) { read.wrap = parse_wrap(typed); };
    constexpr double kMost = 1e6, kLeast = 1e-6;
    command.options = {
        {"-o,--output", "FILE", "the result: .png .tif .exr .ktx2 ...", text(options->output),
         file_choices()},
        {"--list", "", "the built-in sources there are", flag(options->list)},
        {"--to", "KIND", "height, normal or dudv [normal]", parsed(options->to, parse_bump_kind),
         kinds},
        {"--from", "KIND", "of a file [height if it is grey, else normal]", set_from, kinds},
        {"--scale", "METRES", "what a height of 1 in the file stands for; times built-in ones [1]",
         real_number(read.scale, -kMost, kMost)},
        {"--width", "METRES", "that the picture covers from left to right [1; built-in: --list]",
         real_number(options->width, kLeast, kMost)},
        {"--size", "N", "edge of a built-in source in texels [512]",
         noted(whole_number(options->size, 1, 32768), options->has_size)},
        {"--wrap",
         "WAY",
         "beyond the edges: repeat, clamp or mirror [repeat]",
         set_wrap,
         {{"repeat", "clamp", "mirror"}, true}},
        {"--green", "WAY", "green of the result points up (OpenGL) or down (Direct3D) [up]",
         parsed(options->green, parse_green), greens},
        {"--from-green", "WAY", "green of the input points up or down [up]",
         parsed(read.green, parse_green), greens},
        {"--range", "SLOPE", "that 8 and 16 bits of du/dv reach to either side [1]",
         real_number(read.range, 1e-6, kMost)},
        {"--time", "SECONDS", "at which a moving source is seen [0]",
         noted(real_number(options->time, -1e9, 1e9), options->has_time)},
        {"--transfer",
         "CURVE",
         "of 8- and 16-bit input [linear]",
         parsed(read.transfer, parse_transfer),
         {{"linear", "srgb"}, true}},
        {"--levels", "", "all mip levels, with the roughness they lose as alpha: .ktx2 and .dds",
         flag(options->all_levels)},
        {"--format", "FORMAT", "of a texel [float32; PNG 16 bits]",
         parsed(options->format, parse_texel_format), texel_format_choices()}};
    add_shared_options(command, shared);
    command.notes = {
        "Normals are stored as 1/2 + n/2, x to the right, y up in the picture (green up), z out of "
        "the surface; du and dv are the slopes to the right and up, and n ~ (-du, -dv, 1). Files "
        "of floats hold slopes and metres as they are; PNG and 8- or 16-bit TIFF hold slopes as "
        "1/2 + slope / (2 range) and heights from the lowest to the highest. They are numbers, "
        "without sRGB's curve.",
        "--json tells the roughness that each mip level should have to look like the first; "
        "--levels stores it in the fourth channel, for every texel: sqrt(2 variance), to be added "
        "in squares to the alpha of the surface."};
    command.examples = {"mirrorball bump builtin:waves -o waves.png --time 2.5",
                        "mirrorball bump stones.png -o stones-normal.png --scale 0.02 --width 0.5",
                        "mirrorball bump opengl.png -o direct3d.png --from normal --green down",
                        "mirrorball bump builtin:bark -o bark.exr --to height --size 1024",
                        "mirrorball bump stones.exr -o stones.ktx2 --levels --format rgba16f",
                        "mirrorball bump --list"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
