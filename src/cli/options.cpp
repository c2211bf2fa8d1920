#include "options.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <unistd.h>

#include <mirrorball/builtin.h>
#include <mirrorball/error.h>
#include <mirrorball/fresnel.h>
#include <mirrorball/prefilter.h>
#include <mirrorball/row_reader.h>
#include <mirrorball/tone_map.h>

#include "output.h"

namespace mirrorball::cli {
namespace {

constexpr const char* kInputHelp =
    "a file, a pattern for the faces (faces/%s.hdr), their names separated by commas, or "
    "builtin:NAME";

std::uint64_t default_memory_limit() {
    const auto pages = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES));
    return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) / 4 * 3;
}

// Texels around a great circle through the picture's centre, per texel of `size`.
double texels_around(Projection projection) {
    switch (projection) {
        case Projection::cube:
            return 4;
        case Projection::dual_paraboloid:
        case Projection::octahedral:
        case Projection::equal_area_octahedral:
            return 2;
        case Projection::equirect:
        case Projection::sphere:
        case Projection::angular:
            return 1;
    }
    return 1;
}

std::vector<double> parse_numbers(const std::string& text, std::size_t count,
                                  const std::string& form, double least) {
    const auto parts = split(text, ',');
    if (parts.size() != count) {
        throw Error(Errc::usage, fmt::format("\"{}\" is not of the form {}", text, form));
    }
    std::vector<double> numbers;
    for (const std::string& part : parts) {
        numbers.push_back(parse_real_number(part, least, std::numeric_limits<double>::max()));
    }
    return numbers;
}

}  // namespace

// Choices
// -------------------------------------------------------------------------------------------

Choices projection_choices() {
    Choices choices{.values = {}, .closed = true};
    for (std::size_t i = 0; i < kProjectionCount; ++i) {
        choices.values.emplace_back(name(static_cast<Projection>(i)));
    }
    return choices;
}

Choices layout_choices() {
    Choices choices{.values = {}, .closed = true};
    for (const Layout layout : {Layout::single, Layout::horizontal_cross, Layout::vertical_cross,
                                Layout::horizontal_strip, Layout::vertical_strip,
                                Layout::side_by_side, Layout::side_by_side_turned}) {
        choices.values.emplace_back(name(layout));
    }
    return choices;
}

Choices texel_format_choices() {
    Choices choices{.values = {}, .closed = true};
    for (const TexelFormat format :
         {TexelFormat::rgba32f, TexelFormat::rgba16f, TexelFormat::rgb9e5, TexelFormat::r11g11b10f,
          TexelFormat::unorm16, TexelFormat::unorm8}) {
        choices.values.emplace_back(name(format));
    }
    return choices;
}

Choices axes_choices() {
    Choices choices;
    for (const AxesPreset& preset : axes_presets()) choices.values.push_back(preset.name);
    return choices;
}

Choices lobe_choices() {
    return {.values = {"mirror", "diffuse", "phong", "phong:100", "blinn-phong:400", "ggx",
                       "ggx:0.5", "charlie", "charlie:0.5"}};
}

Choices tone_map_choices() {
    Choices choices{.values = {}, .closed = true};
    for (const ToneMap tone_map :
         {ToneMap::none, ToneMap::reinhard, ToneMap::aces, ToneMap::agx, ToneMap::film})
        choices.values.emplace_back(name(tone_map));
    return choices;
}

Choices mapping_choices() {
    return {.values = level_mappings(), .closed = true};
}

Choices surface_choices() {
    Choices choices{.values = {"index=1.5", "f0=0.04"}};
    for (const Metal& metal : metals())
        choices.values.push_back(fmt::format("metal={}", metal.name));
    return choices;
}

Choices builtin_choices() {
    Choices choices{.values = {}, .closed = true};
    for (const Builtin& builtin : builtins()) choices.values.push_back(builtin.name);
    return choices;
}

Choices input_choices() {
    Choices choices = file_choices();
    for (const Builtin& builtin : builtins()) choices.values.push_back("builtin:" + builtin.name);
    return choices;
}

// Options
// -------------------------------------------------------------------------------------------

void add_shared_options(Command& command, Shared& shared) {
    shared.memory_limit = default_memory_limit();
    command.options.insert(
        command.options.end(),
        {{"--json", "", "print one JSON object", flag(shared.json)},
         {"--threads", "N", "threads to use [all; the result is the same for any number]",
          whole_number(shared.threads, 1, 1024)},
         {"--memory", "BYTES",
          "reduce or refuse what needs more, as 512M or 2G [3/4 of the machine's]",
          parsed(shared.memory_limit, parse_memory)},
         {"--quiet", "", "no progress, no notes, no line about what was written",
          flag(shared.quiet)}});
}

void add_input_argument(Command& command, Input& input, bool required) {
    command.arguments.push_back({"IN", kInputHelp, text(input.source), input_choices(), required});
}

void add_inputs_argument(Command& command, std::vector<std::string>& sources) {
    const SetValue add = [&sources](const std::string& typed) {
        text(sources.emplace_back())(typed);
    };
    command.arguments.push_back({"IN", kInputHelp, add, input_choices(), true, true});
}

void add_input_options(Command& command, Input& input) {
    MapReadOptions& options = input.options;
    const SetValue set_axes = [&options](const std::string& typed) {
        try {
            (void)parse_axes(typed, Projection::equirect);
        } catch (const Error& error) {
            const std::string near = nearest(typed, axes_choices().values);
            throw Error(
                Errc::usage,
                error.what() +
                    (near.empty() ? std::string() : fmt::format("; did you mean \"{}\"?", near)));
        }
        options.axes = typed;
    };
    const SetValue set_projection = [&options](const std::string& typed) {
        options.projection = parse_projection(typed);
    };
    const SetValue set_crop = [&options](const std::string& typed) {
        options.crop = parse_crop(typed);
    };
    command.options.insert(
        command.options.end(),
        {{"--from", "PROJECTION", "of the input [the file's word, else its shape]", set_projection,
          projection_choices()},
         {"--axes", "PRESET",
          "whose axes the input has: a program, or as +x+y-z [the file's, else ours]", set_axes,
          axes_choices()},
         {"--crop", "X,Y,R", "outline of a photographed ball: centre and radius in pixels",
          set_crop},
         {"--transfer",
          "CURVE",
          "of 8- and 16-bit input [srgb]",
          parsed(options.transfer, parse_transfer),
          {{"linear", "srgb"}, true}},
         {"--repair", "", "replace texels that are NaN or infinite by their neighbours",
          flag(options.repair)}});
}

std::string source_of(const Input& input) {
    if (!input.faces.empty() && !input.source.empty()) {
        throw Error(Errc::usage, "IN and --faces are both given; one of them names the input");
    }
    if (!input.faces.empty()) return fmt::format("{}", fmt::join(input.faces, ","));
    if (input.source.empty()) throw Error(Errc::usage, "IN is missing: a file, or --faces");
    return input.source;
}

LoadedMap load(const Input& input, const Shared& shared, std::uint64_t result_bytes) {
    return load(source_of(input), input, shared, result_bytes);
}

namespace {

// A panorama that would take more than `most_bytes`, made as much smaller as it takes.
std::optional<LoadedMap> load_reduced(const std::string& source, const MapReadOptions& options,
                                      std::uint64_t most_bytes) {
    std::optional<RowReader> rows = open_if_larger(source, options, most_bytes);
    if (!rows) return std::nullopt;
    const std::optional<int> factor = factor_to_fit(*rows, most_bytes);
    if (!factor) return std::nullopt;
    LoadedMap loaded;
    loaded.map = reduced(*rows, *factor);
    loaded.format = rows->format();
    loaded.stored = rows->stored();
    loaded.metadata = rows->metadata();
    loaded.notes = rows->notes();
    loaded.notes.push_back(fmt::format(
        "{} x {} texels were averaged to {} x {}: the whole takes {}, and --memory leaves {}",
        rows->width(), rows->height(), loaded.map.width(), loaded.map.height(),
        bytes_text(environment_map_bytes(Projection::equirect, rows->width())),
        bytes_text(most_bytes)));
    return loaded;
}

}  // namespace

LoadedMap load(const std::string& source, const Input& input, const Shared& shared,
               std::uint64_t result_bytes) {
    if (source.starts_with("builtin:")) {
        const std::string builtin = source.substr(8);
        const auto known = builtin_choices().values;
        if (std::find(known.begin(), known.end(), builtin) == known.end()) {
            throw Error(Errc::usage, unknown("a built-in environment", builtin, known));
        }
    }
    MapReadOptions options = input.options;
    options.memory_limit = shared.memory_limit;
    const std::uint64_t left = shared.memory_limit - std::min(result_bytes, shared.memory_limit);
    std::optional<LoadedMap> small = load_reduced(source, options, left);
    LoadedMap loaded = small ? std::move(*small) : read_map(source, options);
    for (const std::string& note : loaded.notes) tell(shared, note);
    return loaded;
}

// Values
// --------------------------------------------------------------------------------------------

Rotation parse_rotation(const std::string& text) {
    const auto degrees =
        parse_numbers(text, 3, "YAW,PITCH,ROLL in degrees", std::numeric_limits<double>::lowest());
    return {degrees[0] * kPi / 180, degrees[1] * kPi / 180, degrees[2] * kPi / 180};
}

CropCircle parse_crop(const std::string& text) {
    const auto numbers = parse_numbers(text, 3, "X,Y,RADIUS in pixels", 0);
    if (numbers[2] <= 0) throw Error(Errc::usage, "the radius must be greater than 0");
    return {numbers[0], numbers[1], numbers[2]};
}

std::uint64_t parse_memory(const std::string& text) {
    const std::string units = "KMGT";
    std::string digits = text;
    double factor = 1;
    if (const auto unit = text.empty() ? std::string::npos
                                       : units.find(static_cast<char>(std::toupper(text.back())));
        unit != std::string::npos) {
        digits.pop_back();
        factor = std::pow(1024.0, static_cast<double>(unit + 1));
    }
    try {
        return static_cast<std::uint64_t>(parse_real_number(digits, 1, 1e9) * factor);
    } catch (const Error&) {
        throw Error(Errc::usage, fmt::format("\"{}\" is not a size such as 512M or 2G", text));
    }
}

Interpolation parse_interpolation(const std::string& text) {
    return text == "bilinear" ? Interpolation::bilinear : Interpolation::bicubic;
}

Transfer parse_transfer(const std::string& text) {
    return text == "linear" ? Transfer::linear : Transfer::srgb;
}

// Sizes
// ---------------------------------------------------------------------------------------------

int size_of(const EnvironmentMap& map, int level) {
    return map.width(level);
}

int size_that_keeps_resolution(const EnvironmentMap& source, Projection target) {
    const double around = size_of(source) * texels_around(source.projection);
    const int size = std::max(1, static_cast<int>(std::lround(around / texels_around(target))));
    return target == Projection::equirect ? size + size % 2 : size;
}

std::uint64_t bytes_needed(Projection projection, int size, bool mips) {
    const std::uint64_t bytes = environment_map_bytes(projection, size);
    return mips ? bytes + bytes / 3 : bytes;
}

std::uint64_t bytes_held(const EnvironmentMap& map) {
    std::uint64_t bytes = 0;
    for (const Level& level : map.levels) {
        for (const Image& face : level.faces) bytes += face.values().size_bytes();
    }
    return bytes;
}

void check_size(Projection projection, int size) {
    if (projection == Projection::equirect && size % 2 != 0) {
        throw Error(Errc::usage, fmt::format("--size: the width of an equirect is even, twice its "
                                             "height; found {}",
                                             size));
    }
}

void check_memory(std::uint64_t bytes, const std::string& what, const Shared& shared) {
    if (bytes <= shared.memory_limit) return;
    throw Error(Errc::usage, fmt::format("{} needs {} of memory, --memory allows {}", what,
                                         bytes_text(bytes), bytes_text(shared.memory_limit)));
}

std::string bytes_text(std::uint64_t bytes) {
    const char* const units[] = {"bytes", "KB", "MB", "GB", "TB", "PB"};
    double value = static_cast<double>(bytes);
    int unit = 0;
    for (; value >= 999.5 && unit < 5; ++unit) value /= 1024;
    return unit == 0 ? fmt::format("{} bytes", bytes)
                     : fmt::format("{:.{}f} {}", value, value < 9.95 ? 1 : 0, units[unit]);
}

}  // namespace mirrorball::cli
