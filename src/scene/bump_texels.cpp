// The texels of bump maps: read, or made by a source for a moment.
#include "scene/bump_texels.h"

#include <algorithm>

#include <fmt/format.h>

namespace mirrorball {
namespace {

constexpr std::string_view kBuiltin = "builtin:";

std::string_view source_name(const BumpMap& bump) {
    std::string_view name = bump.source;
    if (name.starts_with(kBuiltin)) name.remove_prefix(kBuiltin.size());
    return name;
}

// From 0, the lowest, to 1; level ones are at the top.
Image normalised(const Image& heights) {
    Image result = heights;
    const auto values = result.values();
    const auto [low_at, high_at] = std::minmax_element(values.begin(), values.end());
    const double low = *low_at, span = double{*high_at} - low;
    for (float& value : values) value = span > 0 ? static_cast<float>((value - low) / span) : 1;
    return result;
}

Image level_heights() {
    Image heights(1, 1, 1);
    *heights.at(0, 0) = 1;
    return heights;
}

BumpTexels texels_of(SlopeMap slopes, const std::optional<HeightMap>& relief) {
    return {std::move(slopes), relief ? normalised(relief->heights) : level_heights()};
}

}  // namespace

bool detail::is_bump_source(const BumpMap& bump) {
    const std::vector<BumpSource> sources = bump_sources();
    return bump.source.starts_with(kBuiltin) ||
           std::any_of(sources.begin(), sources.end(),
                       [&](const BumpSource& s) { return s.name == bump.source; }) ||
           !std::filesystem::path(bump.source).has_extension();
}

BumpTexels detail::make_bump_texels(const BumpMap& bump, double time) {
    const HeightMap relief =
        make_bump(source_name(bump), bump.size, bump.size, {.width = bump.width, .time = time});
    return texels_of(slopes(relief), relief);
}

BumpTexels detail::read_bump_texels(const BumpMap& bump, const std::filesystem::path& folder,
                                    std::uint64_t memory) {
    BumpPicture picture = read_bump(folder / bump.source, {.kind = bump.kind,
                                                           .scale = bump.height_scale,
                                                           .width = bump.width > 0 ? bump.width : 1,
                                                           .wrap = bump.wrap,
                                                           .green = bump.green,
                                                           .memory_limit = memory});
    return texels_of(std::move(picture.slopes), picture.relief);
}

bool moves(const BumpMap& bump) {
    for (const BumpSource& source : bump_sources())
        if (source.name == source_name(bump)) return source.moves;
    return false;
}

std::string bump_key(const BumpMap& bump) {
    return fmt::format("{} {} {} {} {} {} {}", bump.source,
                       bump.kind ? name(*bump.kind) : "any kind", name(bump.green), name(bump.wrap),
                       bump.height_scale, bump.width, bump.size);
}

std::shared_ptr<const BumpTexels> bump_texels(const BumpMap& bump, const SceneAssets& assets,
                                              double time) {
    if (moves(bump)) return std::make_shared<BumpTexels>(detail::make_bump_texels(bump, time));
    return assets.bumps.at(bump_key(bump));
}

}  // namespace mirrorball
