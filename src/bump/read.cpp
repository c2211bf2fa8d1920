// Files of heights, slopes or normals. Remarks are what a wrong result would look right without.
#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include <mirrorball/bump.h>
#include <mirrorball/error.h>

namespace mirrorball {
namespace {

bool is_grey(const Image& picture) {
    if (picture.channels() < 3) return true;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) {
            const Vec3f texel = picture.rgb(x, y);
            if (texel.x != texel.y || texel.y != texel.z) return false;
        }
    return true;
}

// The distance of two codes of an integer format; 0 of floats.
double code_step(TexelFormat format) {
    return format == TexelFormat::unorm8    ? 1.0 / 255
           : format == TexelFormat::unorm16 ? 1.0 / 65535
                                            : 0;
}

void remark_on(const HeightMap& relief, bool wrap_is_told, std::vector<std::string>& remarks) {
    const auto values = relief.heights.values();
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (*low == *high)
        remarks.push_back(fmt::format("all heights are {:g} m: the result is flat", *low));
    constexpr double kVisible = 3;
    const Seams jumps = seams(relief);
    const double most = std::max(jumps.across, jumps.down);
    if (relief.wrap == Wrap::repeat && !wrap_is_told && most > kVisible)
        remarks.push_back(
            fmt::format("is no tile: it jumps {:.3g} times as much from edge to edge as between "
                        "neighbours inside; wrapping by clamp or mirror keeps that out of the "
                        "slopes",
                        most));
}

HeightMap heights_of(const Image& picture, const BumpReadOptions& options) {
    HeightMap relief{Image(picture.width(), picture.height(), 1)};
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            *relief.heights.at(x, y) = static_cast<float>(*picture.at(x, y) * options.scale);
    relief.width = options.width;
    relief.height = relief.width * picture.height() / picture.width();
    relief.wrap = options.wrap.value_or(Wrap::repeat);
    return relief;
}

SlopeMap slopes_of(const Image& picture, double step, double range) {
    if (picture.channels() < 2)
        throw Error(Errc::cannot_read,
                    "a picture of 1 channel is no du/dv map (2 were expected; "
                    "one alone may be heights)");
    SlopeMap map{Image(picture.width(), picture.height(), 2)};
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            for (int c = 0; c < 2; ++c) {
                const float value = picture.at(x, y)[c];
                if (!std::isfinite(value))
                    throw Error(Errc::cannot_read,
                                fmt::format("the slope at column {}, row {} is {} (a finite number "
                                            "was expected)",
                                            x, y, value));
                // The two codes next to one half both stand for none.
                const double signed_value = 2 * double{value} - 1;
                const double slope = step == 0 ? double{value}
                                     : std::abs(signed_value) <= 1.001 * step
                                         ? 0
                                         : signed_value * range;
                map.slopes.at(x, y)[c] = static_cast<float>(slope);
            }
    return map;
}

void remark_on(const NormalFaults& faults, std::vector<std::string>& remarks) {
    if (faults.signed_values) remarks.emplace_back("holds normals as they are, not as 1/2 + n/2");
    if (faults.inward_count > 0)
        remarks.push_back(fmt::format("{} normals point into the surface and are turned out of it",
                                      faults.inward_count));
    if (faults.without_count > 0)
        remarks.push_back(
            fmt::format("{} texels have no direction and are taken as flat", faults.without_count));
    // Four codes of 8 bits; beyond that, no encoder's rounding.
    if (faults.largest_length_error > 0.03)
        remarks.push_back(
            fmt::format("normals are off unit length by up to {:.2g} and are made unit length; is "
                        "it a normal map?",
                        faults.largest_length_error));
}

BumpPicture taken_as_heights(const Image& picture, const BumpReadOptions& options) {
    BumpPicture bump{.kind = BumpKind::height};
    if (!is_grey(picture)) bump.remarks.emplace_back("has colours; red is taken as the height");
    bump.relief = heights_of(picture, options);
    bump.slopes = slopes(*bump.relief);
    remark_on(*bump.relief, options.wrap.has_value(), bump.remarks);
    return bump;
}

BumpPicture taken_as_normals(const Image& picture, double step, Green green) {
    BumpPicture bump{.kind = BumpKind::normal};
    NormalFaults faults;
    bump.normals = parse_normals(picture, green, step, &faults);
    bump.slopes = slopes(*bump.normals);
    remark_on(faults, bump.remarks);
    return bump;
}

BumpPicture parse_bump(const Image& picture, double step, const BumpReadOptions& options) {
    switch (options.kind.value_or(is_grey(picture) ? BumpKind::height : BumpKind::normal)) {
        case BumpKind::height:
            return taken_as_heights(picture, options);
        case BumpKind::normal:
            return taken_as_normals(picture, step, options.green);
        case BumpKind::slopes:
            break;
    }
    return {.kind = BumpKind::slopes, .slopes = slopes_of(picture, step, options.range)};
}

}  // namespace

BumpPicture read_bump(const std::filesystem::path& path, const BumpReadOptions& options) {
    ReadOptions read;
    read.transfer = options.transfer;
    read.memory_limit = options.memory_limit;
    const FileContents contents = read_file(path, read);
    const double step = code_step(contents.stored);
    BumpPicture bump;
    try {
        bump = parse_bump(contents.levels.front().front(), step, options);
    } catch (const Error& error) {  // which knows texels, not files
        throw Error(error.code(), fmt::format("{}: {}", path.string(), error.what()));
    }
    if (options.transfer == Transfer::srgb && step > 0)
        bump.remarks.emplace_back("decoded from sRGB, as asked");
    return bump;
}

}  // namespace mirrorball
