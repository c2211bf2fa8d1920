#include "exr_picture.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "codec.h"
#include "edge_grid.h"
#include "exr_strip.h"

namespace mirrorball::detail {

using Imath::Box2i;

const Axes kLatLongAxes{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
const Axes kCubeAxes{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}};

namespace {

// The picture is the display window: what was stored beyond it goes, what was not stored is black.
Image in_display_window(const InputFile& file, const Image& data, const Box2i& data_window,
                        const Box2i& display_window, const ReadOptions& options) {
    const double texels = double(width_of(display_window)) * double(height_of(display_window));
    constexpr double kMostEmptiness = 64;
    if (texels > kMostEmptiness * double(data.texel_count()))
        file.fail(fmt::format("stores {} x {} pixels of a picture of {} x {}", data.width(),
                              data.height(), width_of(display_window), height_of(display_window)));
    check_claim(file, width_of(display_window), height_of(display_window), data.channels(), 2, 0,
                options);
    Image picture(static_cast<int>(width_of(display_window)),
                  static_cast<int>(height_of(display_window)), data.channels());
    const Box2i shared{{std::max(data_window.min.x, display_window.min.x),
                        std::max(data_window.min.y, display_window.min.y)},
                       {std::min(data_window.max.x, display_window.max.x),
                        std::min(data_window.max.y, display_window.max.y)}};
    if (shared.isEmpty()) file.fail("stores no pixel of its display window");
    for (int y = shared.min.y; y <= shared.max.y; ++y) {
        const float* from = data.at(shared.min.x - data_window.min.x, y - data_window.min.y);
        std::copy_n(from, width_of(shared) * data.channels(),
                    picture.at(shared.min.x - display_window.min.x, y - display_window.min.y));
    }
    return picture;
}

bool has_shape(const std::vector<Image>& levels, int width, int height) {
    return std::all_of(levels.begin(), levels.end(), [&](const Image& image) {
        return std::int64_t{image.width()} * height == std::int64_t{image.height()} * width;
    });
}

void take_environment(std::vector<Image> levels, Projection projection, FileContents& contents) {
    const bool is_cube = projection == Projection::cube;
    for (Image& image : levels)
        contents.levels.push_back(is_cube ? cube_from_edge_grid(cut_strip(image))
                                          : std::vector{equirect_from_edge_grid(image)});
    contents.projection = projection;
    contents.axes = is_cube ? kCubeAxes : kLatLongAxes;
}

}  // namespace

std::int64_t width_of(const Box2i& box) {
    return std::int64_t{box.max.x} - box.min.x + 1;
}
std::int64_t height_of(const Box2i& box) {
    return std::int64_t{box.max.y} - box.min.y + 1;
}

std::size_t exr_level_count(const std::vector<Image>& levels, std::optional<int> said) {
    if (said) return std::clamp<std::size_t>(std::max(*said, 1), 1, levels.size());
    std::size_t count = 1;
    while (count < levels.size() &&
           std::int64_t{levels[count].width()} << count == levels.front().width() &&
           std::int64_t{levels[count].height()} << count == levels.front().height())
        ++count;
    return count;
}

void take_exr_levels(const InputFile& file, std::vector<Image> levels, const ExrPictureWords& words,
                     const ReadOptions& options, FileContents& contents) {
    levels.resize(exr_level_count(levels, words.level_count));
    if (words.environment) {
        const bool is_cube = words.environment == Projection::cube;
        if (is_cube ? has_shape(levels, 1, 6) : has_shape(levels, 2, 1))
            return take_environment(std::move(levels), *words.environment, contents);
        contents.notes.push_back(fmt::format(
            "its envmap attribute ({}) was left aside, as its size of {} x {} is another's",
            is_cube ? "cube" : "latlong", levels.front().width(), levels.front().height()));
    }
    const Box2i &data = words.data_window, &display = words.display_window;
    if (data != display) {
        contents.notes.push_back(fmt::format(
            "stores {} x {} pixels of a picture of {} x {}; the rest is black or was left out",
            levels.front().width(), levels.front().height(), width_of(display),
            height_of(display)));
        levels.resize(1);
        levels.front() = in_display_window(file, levels.front(), data, display, options);
    }
    for (Image& image : levels) contents.levels.emplace_back().push_back(std::move(image));
}

}  // namespace mirrorball::detail
