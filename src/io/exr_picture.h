// What becomes of the pixels of an OpenEXR file, whichever library has read them.
#pragma once

#include <optional>
#include <vector>

#include <ImathBox.h>

#include <mirrorball/axes.h>
#include <mirrorball/image.h>
#include <mirrorball/io.h>

#include "file.h"

namespace mirrorball::detail {

/// By this attribute we say how many of a file's levels count: OpenEXR's always go down to a texel.
inline constexpr const char* kLevelCountAttribute = "mirrorball.level_count";

/// Where OpenEXR's environment maps lie in our world: what axes_preset("openexr", ...) says.
extern const Axes kLatLongAxes, kCubeAxes;

[[nodiscard]] std::int64_t width_of(const Imath::Box2i& box);
[[nodiscard]] std::int64_t height_of(const Imath::Box2i& box);

/// What a header says of its picture.
struct ExrPictureWords {
    Imath::Box2i data_window, display_window;
    /// Of the attribute envmap: an equirect (latlong) or a cube.
    std::optional<Projection> environment;
    std::optional<int> level_count;
};

/// How many of the levels are to be taken, each given with its size: those that the writer says
/// count, else those whose sizes are exact halves, so that the shape stays that of the first.
[[nodiscard]] std::size_t exr_level_count(const std::vector<Image>& levels,
                                          std::optional<int> said);

/// The levels, as their data windows hold them, as an environment in our conventions or as the
/// picture that is the display window.
void take_exr_levels(const InputFile& file, std::vector<Image> levels, const ExrPictureWords& words,
                     const ReadOptions& options, FileContents& contents);

}  // namespace mirrorball::detail
