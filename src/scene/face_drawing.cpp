#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/scene.h>

namespace mirrorball {
namespace {

constexpr std::array<std::string_view, 3> kNames = {"texture", "copy", "one-pass"};

}  // namespace

std::string_view name(FaceDrawing drawing) {
    return kNames[static_cast<std::size_t>(drawing)];
}

FaceDrawing parse_face_drawing(std::string_view name) {
    const auto found = std::find(kNames.begin(), kNames.end(), name);
    if (found == kNames.end()) {
        throw Error(Errc::usage, fmt::format("\"{}\" is no way to draw the faces of a cube map; "
                                             "there are: {}",
                                             name, fmt::join(kNames, ", ")));
    }
    return static_cast<FaceDrawing>(found - kNames.begin());
}

}  // namespace mirrorball
