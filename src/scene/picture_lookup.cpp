#include "scene/picture_lookup.h"

#include <algorithm>
#include <cmath>

namespace mirrorball::detail {
namespace {

// The texel that a number of one along a side of `size` stands for.
int wrapped(double i, int size, Wrap wrap) {
    const double last = size - 1;
    if (wrap == Wrap::clamp) return static_cast<int>(std::clamp(i, 0.0, last));
    const double period = wrap == Wrap::mirror ? 2.0 * size : size;
    const double within = std::min(i - std::floor(i / period) * period, period - 1);
    return static_cast<int>(within < size ? within : period - 1 - within);
}

}  // namespace

Vec3d look_up_picture(const Image& picture, const Imath::V2d& place, Wrap wrap) {
    const int channels = std::min(picture.channels(), 3);
    const auto texel = [&](double i, double j) {
        const float* values =
            picture.at(wrapped(i, picture.width(), wrap), wrapped(j, picture.height(), wrap));
        Vec3d result(0);
        for (int c = 0; c < channels; ++c) result[c] = values[c];
        return result;
    };
    const double x = place.x * picture.width() - 0.5, y = place.y * picture.height() - 0.5;
    if (!std::isfinite(x) || !std::isfinite(y)) return texel(0, 0);
    const double x0 = std::floor(x), y0 = std::floor(y);
    const auto row = [&](double j) {
        return texel(x0, j) + (texel(x0 + 1, j) - texel(x0, j)) * (x - x0);
    };
    return row(y0) + (row(y0 + 1) - row(y0)) * (y - y0);
}

}  // namespace mirrorball::detail
