#include "face_words.h"

#include <fmt/format.h>

namespace mirrorball::detail {

std::string_view face_in_words(Projection projection, int face) {
    static constexpr std::string_view kCubeFaces[] = {"face +X", "face -X", "face +Y",
                                                      "face -Y", "face +Z", "face -Z"};
    static constexpr std::string_view kParaboloids[] = {"the front", "the back"};
    if (projection == Projection::cube) return kCubeFaces[face];
    if (projection == Projection::dual_paraboloid) return kParaboloids[face];
    return {};
}

std::string map_in_words(Projection projection) {
    const std::string_view word = name(projection);
    const bool vowel = std::string_view("aeio").find(word.front()) != std::string_view::npos;
    return fmt::format("{} {} map", vowel ? "an" : "a", word);
}

std::string texel_in_words(Projection projection, int level, int face, int x, int y) {
    std::string words = fmt::format("texel ({}, {})", x, y);
    const std::string_view face_words = face_in_words(projection, face);
    if (!face_words.empty()) words += fmt::format(" of {}", face_words);
    if (level > 0) words += fmt::format(", level {}", level);
    return words;
}

}  // namespace mirrorball::detail
