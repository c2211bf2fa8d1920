#include "targets.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include <mirrorball/error.h>

#include "io/codec.h"
#include "options.h"

namespace mirrorball::cli {

void add_write_options(Command& command, MapWriteOptions& options) {
    command.options.insert(command.options.end(),
                           {{"--format", "FORMAT", "of a texel [the file format's usual one]",
                             parsed(options.format, parse_texel_format), texel_format_choices()},
                            {"--layout", "LAYOUT",
                             "of the faces in a file of one picture [the projection's usual one]",
                             parsed(options.layout, parse_layout), layout_choices()}});
}

Option ktx2_format_option(TexelFormat& format) {
    return {"--format",
            "FORMAT",
            "of a texel [rgba16f]",
            parsed(format, parse_texel_format),
            {{"rgba16f", "rgba32f", "rgb9e5", "r11g11b10f"}, true}};
}

std::string output_help() {
    std::string endings;
    for (const FormatInfo& format : formats()) {
        if (!format.writes) continue;
        for (const std::string& ending : format.endings) endings += " " + ending;
    }
    return "the result:" + endings + "; %s in the name stands for the face";
}

void check_format(const std::string& target, const MapWriteOptions& options) {
    const detail::Codec& codec = detail::codec_for_name(target);
    const auto& known = codec.texel_formats;
    if (options.format != TexelFormat::automatic &&
        std::find(known.begin(), known.end(), options.format) == known.end()) {
        std::vector<std::string_view> names;
        for (const TexelFormat format : known) names.push_back(name(format));
        throw Error(Errc::usage,
                    fmt::format("--format: {} does not hold {}; it holds {}", codec.name,
                                name(options.format), fmt::join(names, ", ")));
    }
}

void check_target(const std::string& target, const MapWriteOptions& options) {
    check_format(target, options);
    const auto folder = std::filesystem::path(target).parent_path();
    std::error_code ignored;
    if (!folder.empty() && !std::filesystem::is_directory(folder, ignored)) {
        throw Error(Errc::cannot_write,
                    fmt::format("{}: there is no folder {}", target, folder.string()));
    }
}

bool holds_levels(const std::string& target) {
    return detail::codec_for_name(target).holds_levels && target.find("%s") == std::string::npos;
}

}  // namespace mirrorball::cli
