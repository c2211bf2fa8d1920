#include "dfg_files.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include <mirrorball/error.h>

namespace mirrorball::cli {
namespace {

constexpr std::size_t kMostChannels = 3;

struct ChannelEntry {
    DfgChannel channel;
    const char* name;
    const char* meaning;
};
constexpr ChannelEntry kChannels[] = {
    {DfgChannel::scale, "scale", "A of L = L_D (F0 A + F90 B), GGX with height-correlated Smith"},
    {DfgChannel::bias, "bias", "B of it"},
    {DfgChannel::albedo, "albedo", "A + B, the directional albedo of GGX without Fresnel"},
    {DfgChannel::charlie, "charlie", "the directional albedo of Charlie sheen"},
};

struct Preset {
    const char* name;
    std::vector<DfgChannel> channels;
};
const std::vector<Preset>& presets() {
    using enum DfgChannel;
    static const std::vector<Preset> all = {{"gltf", {scale, bias, charlie}},
                                            {"unreal", {scale, bias}},
                                            {"filament", {bias, albedo, charlie}}};
    return all;
}

const ChannelEntry& entry(DfgChannel channel) {
    return kChannels[static_cast<std::size_t>(channel)];
}

DfgChannel parse_channel(const std::string& text) {
    for (const ChannelEntry& known : kChannels)
        if (text == known.name) return known.channel;
    throw Error(Errc::usage, unknown("a channel", text, dfg_channel_choices().values));
}

float value(const Vec3f& texel, DfgChannel channel) {
    switch (channel) {
        case DfgChannel::scale:
            return texel.x;
        case DfgChannel::bias:
            return texel.y;
        case DfgChannel::albedo:
            return texel.x + texel.y;
        case DfgChannel::charlie:
            return texel.z;
    }
    return 0;
}

std::string upper_case(std::string text) {
    for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return text;
}

constexpr const char* kLookUp = R"(
/* What a texture unit reads at (n_dot_v, roughness): bilinear, clamped to the edge. Both 0 to 1. */
static inline void {0}_look_up(float n_dot_v, float roughness, float out[{1}_CHANNELS]) {{
    float x = n_dot_v * {1}_WIDTH - 0.5f, y = roughness * {1}_HEIGHT - 0.5f;
    x = x < 0 ? 0 : x > {1}_WIDTH - 1 ? {1}_WIDTH - 1 : x;
    y = y < 0 ? 0 : y > {1}_HEIGHT - 1 ? {1}_HEIGHT - 1 : y;
    const int x0 = (int)x < {1}_WIDTH - 1 ? (int)x : {1}_WIDTH - 2;
    const int y0 = (int)y < {1}_HEIGHT - 1 ? (int)y : {1}_HEIGHT - 2;
    const float u = x - (float)x0, v = y - (float)y0;
    for (int c = 0; c < {1}_CHANNELS; ++c)
        out[c] = (1 - v) * ((1 - u) * {0}_table[y0][x0][c] + u * {0}_table[y0][x0 + 1][c]) +
                 v * ((1 - u) * {0}_table[y0 + 1][x0][c] + u * {0}_table[y0 + 1][x0 + 1][c]);
}}
)";

// Row after row of values, a few texels to a line.
std::string array_text(const Image& table, const std::vector<DfgChannel>& channels) {
    constexpr int kTexelsPerLine = 2;
    std::string text;
    for (int y = 0; y < table.height(); ++y) {
        text += "    {";
        for (int x = 0; x < table.width(); ++x) {
            if (x > 0) text += x % kTexelsPerLine == 0 ? ",\n     " : ", ";
            text += "{";
            for (std::size_t c = 0; c < channels.size(); ++c)
                text += fmt::format("{}{:#.9g}f", c > 0 ? ", " : "",
                                    value(table.rgb(x, y), channels[c]));
            text += "}";
        }
        text += y + 1 < table.height() ? "},\n" : "}\n";
    }
    return text;
}

}  // namespace

std::string name(DfgChannel channel) {
    return entry(channel).name;
}

std::string names(const std::vector<DfgChannel>& channels) {
    std::string text;
    for (const DfgChannel channel : channels) text += (text.empty() ? "" : ",") + name(channel);
    return text;
}

std::vector<DfgChannel> parse_dfg_channels(const std::string& text) {
    for (const Preset& preset : presets())
        if (text == preset.name) return preset.channels;
    std::vector<DfgChannel> channels;
    for (const std::string& part : split(text, ',')) channels.push_back(parse_channel(part));
    if (channels.size() > kMostChannels)
        throw Error(Errc::usage, fmt::format("found {} channels; a texel has at most {}",
                                             channels.size(), kMostChannels));
    return channels;
}

Choices dfg_channel_choices() {
    Choices choices;
    for (const Preset& preset : presets()) choices.values.emplace_back(preset.name);
    for (const ChannelEntry& known : kChannels) choices.values.emplace_back(known.name);
    return choices;
}

Image dfg_image(const DfgTable& table, const std::vector<DfgChannel>& channels) {
    const Image& source = table.image();
    Image image(source.width(), source.height(), channels.size() == 1 ? 1 : 3);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            for (std::size_t c = 0; c < channels.size(); ++c)
                image.at(x, y)[c] = value(source.rgb(x, y), channels[c]);
    return image;
}

Metadata dfg_metadata(const std::vector<DfgChannel>& channels) {
    return {{"mirrorball.table", "dfg"},
            {"mirrorball.columns", "n.v = (x + 0.5) / width"},
            {"mirrorball.rows",
             "perceptual roughness = (y + 0.5) / height, alpha = roughness^2, row 0 first"},
            {"mirrorball.channels", names(channels)}};
}

std::string dfg_header(const DfgTable& table, const std::vector<DfgChannel>& channels,
                       const std::string& prefix) {
    const std::string macro = upper_case(prefix);
    const Image& image = table.image();
    std::string text = fmt::format(
        "/* DFG table, made by mirrorball {}.\n *\n"
        " * {}_table[y][x] is for n.v = (x + 0.5) / {}_WIDTH and the perceptual roughness\n"
        " * (y + 0.5) / {}_HEIGHT, alpha = roughness^2. As a texture with row 0 at t = 0, look up\n"
        " * (n.v, roughness): linear, clamped to the edge.\n *\n",
        MIRRORBALL_VERSION, prefix, macro, macro);
    for (std::size_t c = 0; c < channels.size(); ++c)
        text += fmt::format(" * [{}] {}: {}\n", c, name(channels[c]), entry(channels[c]).meaning);
    text += fmt::format(
        " */\n#ifndef {0}_TABLE_H\n#define {0}_TABLE_H\n\n"
        "#define {0}_WIDTH {1}\n#define {0}_HEIGHT {2}\n#define {0}_CHANNELS {3}\n\n"
        "static const float {4}_table[{0}_HEIGHT][{0}_WIDTH][{0}_CHANNELS] = {{\n",
        macro, image.width(), image.height(), channels.size(), prefix);
    text += array_text(image, channels) + "};\n";
    text += fmt::format(kLookUp, prefix, macro);
    return text + "\n#endif\n";
}

}  // namespace mirrorball::cli
