#include "ball.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace mirrorball::cli {
namespace {

constexpr int kSamples = 2;  // per pixel and axis

// The texel at (x, y), which may lie one beyond the face: there it is the neighbour's nearest.
Vec3f texel(const Level& level, int face, int x, int y) {
    const int size = level.width();
    if (x >= 0 && y >= 0 && x < size && y < size) return level.faces[face].rgb(x, y);
    const FacePoint<double> place =
        Cube::wrap(FacePoint<double>{face, (x + 0.5) / size, (y + 0.5) / size});
    const auto index = [size](double s) {
        return std::clamp(static_cast<int>(std::floor(s * size)), 0, size - 1);
    };
    return level.faces[place.face].rgb(index(place.s), index(place.t));
}

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

Vec3f look_up(const EnvironmentMap& cube, int level, const Vec3d& direction) {
    const Level& texels = cube.levels[level];
    const FacePoint<double> p = Cube::project(cube.axes.to_map(direction));
    const double x = p.s * texels.width() - 0.5, y = p.t * texels.height() - 0.5;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const float u = static_cast<float>(x - x0), v = static_cast<float>(y - y0);
    const Vec3f top =
        texel(texels, p.face, x0, y0) * (1 - u) + texel(texels, p.face, x0 + 1, y0) * u;
    const Vec3f bottom =
        texel(texels, p.face, x0, y0 + 1) * (1 - u) + texel(texels, p.face, x0 + 1, y0 + 1) * u;
    return top * (1 - v) + bottom * v;
}

}  // namespace mirrorball::cli
