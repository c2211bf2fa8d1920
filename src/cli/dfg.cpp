// mirrorball dfg: the split sum's table as a file.
#include <cctype>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/dfg.h>
#include <mirrorball/error.h>

#include "dfg_files.h"
#include "output.h"
#include "progress.h"
#include "targets.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

constexpr int kLeastSize = 2, kMostSize = 4096;

struct Size {
    int width, height;
};

struct Point {
    double n_dot_v, roughness;
};

struct Options {
    std::string output;
    Size size{128, 128};
    std::vector<DfgChannel> channels;
    TexelFormat format = TexelFormat::automatic;
    std::optional<Point> point;
};

// "128" or "256x64".
Size parse_size(const std::string& text) {
    const std::vector<std::string> parts = split(text, 'x');
    if (parts.size() > 2)
        throw Error(Errc::usage, fmt::format("\"{}\" is not a size as 128 or 256x64", text));
    return {parse_whole_number(parts.front(), kLeastSize, kMostSize),
            parse_whole_number(parts.back(), kLeastSize, kMostSize)};
}

Point parse_point(const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    if (parts.size() != 2)
        throw Error(Errc::usage, fmt::format("\"{}\" is not n.v and roughness as 0.5,0.3", text));
    return {parse_real_number(parts[0], 0, 1), parse_real_number(parts[1], 0, 1)};
}

int print_point(const Point& point, const Shared& shared) {
    const Dfg dfg = ggx_dfg(point.n_dot_v, point.roughness);
    const double charlie = charlie_albedo(point.n_dot_v, point.roughness);
    if (shared.json) {
        print_json(Json{{"n_dot_v", point.n_dot_v},
                        {"roughness", point.roughness},
                        {"scale", dfg.scale},
                        {"bias", dfg.bias},
                        {"albedo", dfg.albedo()},
                        {"charlie", charlie}});
    } else {
        print(fmt::format("scale    {:.6f}\nbias     {:.6f}\nalbedo   {:.6f}\ncharlie  {:.6f}\n",
                          dfg.scale, dfg.bias, dfg.albedo(), charlie));
    }
    return 0;
}

bool is_header(const std::string& target) {
    return target.ends_with(".h");
}

// "tables/my dfg.h" -> "my_dfg"
std::string prefix_for(const std::string& target) {
    std::string prefix = std::filesystem::path(target).stem().string();
    for (char& c : prefix)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    if (std::isdigit(static_cast<unsigned char>(prefix.front())) != 0) prefix.insert(0, "dfg_");
    return prefix;
}

// Floats as they are where the format has them, and 16 bits in a PNG: a table is read as numbers.
MapWriteOptions write_options(const Options& options) {
    MapWriteOptions write;
    write.format = options.format;
    write.metadata = dfg_metadata(options.channels);
    const bool holds_floats = options.output.ends_with(".ktx2") ||
                              options.output.ends_with(".exr") ||
                              options.output.ends_with(".dds") || options.output.ends_with(".tif");
    if (options.format == TexelFormat::automatic && holds_floats)
        write.format = TexelFormat::rgba32f;
    if (options.format == TexelFormat::automatic && options.output.ends_with(".png"))
        write.format = TexelFormat::unorm16;
    return write;
}

void check(const Options& options, const MapWriteOptions& write) {
    if (!is_header(options.output)) return check_target(options.output, write);
    if (options.format != TexelFormat::automatic)
        throw Error(Errc::usage, "--format: a C header holds float");
}

int run(const Options& options, const Shared& shared) {
    if (options.point) return print_point(*options.point, shared);
    if (options.output.empty()) throw Error(Errc::usage, "--output FILE is missing");
    const MapWriteOptions write = write_options(options);
    check(options, write);

    ProgressBar bar(shared);
    const DfgTable table(options.size.width, options.size.height, bar.stage("Integrating"));
    bar.hide();
    std::uint64_t byte_count = 0;
    if (is_header(options.output)) {
        const std::string text = dfg_header(table, options.channels, prefix_for(options.output));
        write_text(options.output, text);
        byte_count = text.size();
    } else {
        const WriteReport report =
            write_image(options.output, dfg_image(table, options.channels), write);
        if (report.clipped_texel_count > 0)
            tell(shared, fmt::format("{}: {} texels are beyond what the format holds and are "
                                     "clipped",
                                     options.output, report.clipped_texel_count));
        byte_count = report.byte_count;
    }
    if (shared.json) {
        print_json(Json{{"file", options.output},
                        {"bytes", byte_count},
                        {"width", options.size.width},
                        {"height", options.size.height},
                        {"channels", names(options.channels)},
                        {"columns", "n.v = (x + 0.5) / width"},
                        {"rows", "perceptual roughness = (y + 0.5) / height"}});
    } else if (!shared.quiet) {
        print(fmt::format("{}: {} x {}, {}, {}\n", options.output, options.size.width,
                          options.size.height, names(options.channels), bytes_text(byte_count)));
    }
    return 0;
}

}  // namespace

Command dfg_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    options->channels = parse_dfg_channels("gltf");
    Command command{.name = "dfg",
                    .summary =
                        "What a rough surface reflects of uniform light: the split sum's "
                        "DFG table."};
    command.options = {
        {"-o,--output", "FILE", "the table: .ktx2 .exr .h (C) .png ...", text(options->output),
         file_choices()},
        {"--size", "N", "texels of a side, or as 256x64 [128]", parsed(options->size, parse_size)},
        {"--channels", "LIST",
         "gltf: scale,bias,charlie; unreal: scale,bias; filament: bias,albedo,charlie; or any "
         "up to three of these [gltf]",
         parsed(options->channels, parse_dfg_channels), dfg_channel_choices()},
        {"--format", "FORMAT", "of a texel [float32; PNG 16 bits]",
         parsed(options->format, parse_texel_format), texel_format_choices()},
        {"--at", "N.V,ROUGHNESS", "print the four values there, and write no file",
         [point = &options->point](const std::string& typed) { *point = parse_point(typed); }}};
    add_shared_options(command, shared);
    command.notes = {
        "A reflection of prefiltered light L is L (F0 scale + F90 bias). Columns are n.v from 0 to "
        "1, rows the perceptual roughness, the smoothest first; texel (x, y) stands for its "
        "centre. So the texture coordinate is (n.v, roughness), clamped to the edge; where the "
        "first row of a texture is at the top and t grows upwards, it is (n.v, 1 - roughness).",
        "albedo is scale + bias. charlie is that of sheen, which exceeds 1 at grazing angles if "
        "roughness < 0.42: a PNG clips it and says so. PNG holds its values with the sRGB curve."};
    command.examples = {"mirrorball dfg -o dfg.ktx2 --format rgba16f",
                        "mirrorball dfg -o dfg.exr --size 256 --channels filament",
                        "mirrorball dfg -o dfg.h --size 32 --channels scale,bias",
                        "mirrorball dfg --at 0.5,0.5"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
