// The survey's section 3 as an experiment: one scene by every method, next to the truth.
#pragma once

#include <cstdint>
#include <vector>

#include <mirrorball/gl/renderer.h>

#include "scene_options.h"

namespace mirrorball::cli {

/// What one method makes of the scene.
struct MethodResult {
    Method method;
    Image picture;  ///< as displayed, linear
    /// |difference| of what is displayed, of 255 steps of sRGB, the mean of three channels; 0 where
    /// there is no object.
    Image error;
    double mean_error = 0, percentile_99 = 0, largest_error = 0;  ///< over the objects' pixels
    std::uint64_t map_bytes = 0;
    double frame_seconds = 0;  ///< median, one sample a pixel
};

struct MethodComparison {
    Image truth;                   ///< each pixel evaluated directly (direct.h)
    std::int64_t pixel_count = 0;  ///< that show an object
    std::vector<MethodResult> results;
    double constant_seconds = 0;  ///< the same objects in a constant colour
};

/// `scene` by each of `methods`, at `sample_count` samples a pixel.
[[nodiscard]] MethodComparison compare_methods(const LoadedScene& loaded, int width, int height,
                                               int sample_count, std::span<const Method> methods,
                                               const Progress& progress = {});

/// The page that shows it; pictures are METHOD.png, METHOD-error.png and truth.png beside it.
[[nodiscard]] std::string methods_page(const MethodComparison& comparison,
                                       const std::string& driver, const SceneInput& input);

/// Errors of this many steps are shown white.
inline constexpr double kErrorShownWhite = 64;

}  // namespace mirrorball::cli
