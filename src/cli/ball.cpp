#include "ball.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace mirrorball::cli {
namespace {

constexpr int kSamples = 2;  // per pixel and axis

Vec3f draw_pixel(int px, int py, int size, const Shade& shade) {
    Vec3f sum(0, 0, 0);
    int inside = 0;
    for (int i = 0; i < kSamples * kSamples; ++i) {
        const double x = 2 * (px + (i % kSamples + 0.5) / kSamples) / size - 1;
        const double y = 1 - 2 * (py + (i / kSamples + 0.5) / kSamples) / size;
        const double z2 = 1 - x * x - y * y;
        if (z2 <= 0) continue;
        sum += shade({x, y, std::sqrt(z2)});
        ++inside;
    }
    // The rim keeps its colour instead of fading to black: the page cuts the circle out.
    return inside > 0 ? sum / static_cast<float>(inside) : sum;
}

}  // namespace

Image draw_ball(int size, const Shade& shade) {
    Image image(size, size, 3);
    detail::parallel_for(size, [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < size; ++x) image.set_rgb(x, y, draw_pixel(x, y, size, shade));
    });
    return image;
}

}  // namespace mirrorball::cli
