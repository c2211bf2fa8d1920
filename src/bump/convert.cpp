// Heights to slopes to normals, and back from normals to slopes.
#include <cmath>

#include <fmt/format.h>

#include <mirrorball/bump.h>
#include <mirrorball/error.h>

#include "core/nearest.h"
#include "core/parallel.h"

namespace mirrorball {
namespace {

constexpr float kSteepest = 100;  // a slope of 89.4 degrees

int wrapped(int i, int count, Wrap wrap) {
    const int period = wrap == Wrap::mirror ? 2 * count : count;
    const int within = (i % period + period) % period;
    return within < count ? within : period - 1 - within;
}

// Derivative per texel at the texel `i` of `count`, where value(j) gives the others.
template <class Value>
double one_sided(int i, int count, const Value& value) {
    if (count == 1) return 0;
    if (count == 2) return value(1) - value(0);
    const bool low = i < count / 2;
    const auto from_edge = [&](int j) { return value(low ? j : count - 1 - j); };
    const int distance = low ? i : count - 1 - i;
    const double sign = low ? 1 : -1;
    if (count < 5) {
        if (distance > 0) return (value(i + 1) - value(i - 1)) / 2;
        return sign * (-3 * from_edge(0) + 4 * from_edge(1) - from_edge(2)) / 2;
    }
    if (distance == 0)
        return sign *
               (-25 * from_edge(0) + 48 * from_edge(1) - 36 * from_edge(2) + 16 * from_edge(3) -
                3 * from_edge(4)) /
               12;
    return sign *
           (-3 * from_edge(0) - 10 * from_edge(1) + 18 * from_edge(2) - 6 * from_edge(3) +
            from_edge(4)) /
           12;
}

template <class Value>
double derivative(int i, int count, Wrap wrap, const Value& value) {
    const bool inside = i >= 2 && i + 2 < count;
    if (!inside && wrap == Wrap::clamp) return one_sided(i, count, value);
    const auto at = [&](int j) -> double {
        return value(inside ? i + j : wrapped(i + j, count, wrap));
    };
    // As differences of pairs: equal heights cancel to nothing, whatever their size.
    return (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / 12;
}

void check_heights(const Image& heights) {
    for (int y = 0; y < heights.height(); ++y)
        for (int x = 0; x < heights.width(); ++x)
            if (!std::isfinite(*heights.at(x, y)))
                throw Error(Errc::cannot_read,
                            fmt::format("the height at column {}, row {} is {} (a finite number "
                                        "was expected)",
                                        x, y, *heights.at(x, y)));
}

void check_slope(double slope, int x, int y) {
    if (std::abs(slope) > std::numeric_limits<float>::max())
        throw Error(Errc::cannot_read,
                    fmt::format("the slope at column {}, row {} is {:.3g}, beyond what a float "
                                "holds (lower heights or a wider picture were expected)",
                                x, y, slope));
}

}  // namespace

SlopeMap slopes(const HeightMap& relief) {
    const Image& heights = relief.heights;
    assert(heights.channels() == 1 && relief.width > 0 && relief.height > 0);
    check_heights(heights);
    const int width = heights.width(), height = heights.height();
    const double per_metre_x = width / relief.width, per_metre_y = height / relief.height;
    SlopeMap map{Image(width, height, 2)};
    detail::parallel_for(height, [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < width; ++x) {
            const double along_s = derivative(x, width, relief.wrap,
                                              [&](int i) -> double { return *heights.at(i, y); });
            const double along_t = derivative(y, height, relief.wrap,
                                              [&](int i) -> double { return *heights.at(x, i); });
            const double du = along_s * per_metre_x;
            const double dv = -along_t * per_metre_y;  // y is up, rows go down
            check_slope(du, x, y);
            check_slope(dv, x, y);
            map.slopes.at(x, y)[0] = static_cast<float>(du);
            map.slopes.at(x, y)[1] = static_cast<float>(dv);
        }
    });
    return map;
}

NormalMap normals(const HeightMap& relief) {
    return normals(slopes(relief));
}

NormalMap normals(const SlopeMap& map) {
    const Image& slopes = map.slopes;
    NormalMap result{Image(slopes.width(), slopes.height(), 3)};
    for (int y = 0; y < slopes.height(); ++y)
        for (int x = 0; x < slopes.width(); ++x) {
            // Subtracted, not negated, so that flat is 0 and never -0.
            const Vec3d n(0.0 - slopes.at(x, y)[0], 0.0 - slopes.at(x, y)[1], 1);
            result.normals.set_rgb(x, y, Vec3f(n / std::hypot(n.x, n.y, n.z)));
        }
    return result;
}

SlopeMap slopes(const NormalMap& map) {
    const Image& normals = map.normals;
    SlopeMap result{Image(normals.width(), normals.height(), 2)};
    for (int y = 0; y < normals.height(); ++y)
        for (int x = 0; x < normals.width(); ++x) {
            const Vec3f n = normals.rgb(x, y);
            float du = 0, dv = 0;
            if (n.z >= n.length() / kSteepest) {
                if (n.z > 0) du = (0 - n.x) / n.z, dv = (0 - n.y) / n.z;
            } else if (const float lean = std::hypot(n.x, n.y); lean > 0) {
                du = (0 - n.x) / lean * kSteepest, dv = (0 - n.y) / lean * kSteepest;
            }
            result.slopes.at(x, y)[0] = du;
            result.slopes.at(x, y)[1] = dv;
        }
    return result;
}

// Seams -------------------------------------------------------------------------------------------

namespace {

double jump_ratio(double seam_squares, std::int64_t seam_count, double inner_squares,
                  std::int64_t inner_count) {
    if (seam_squares == 0) return 0;
    const double seam = seam_squares / static_cast<double>(seam_count);
    const double inner =
        inner_squares / static_cast<double>(std::max<std::int64_t>(inner_count, 1));
    return inner > 0 ? std::sqrt(seam / inner) : std::numeric_limits<double>::infinity();
}

}  // namespace

Seams seams(const HeightMap& relief) {
    const Image& heights = relief.heights;
    const int width = heights.width(), height = heights.height();
    double across = 0, down = 0, inner_across = 0, inner_down = 0;
    const auto square = [&](int x0, int y0, int x1, int y1) {
        const double jump = double{*heights.at(x0, y0)} - *heights.at(x1, y1);
        return jump * jump;
    };
    for (int y = 0; y < height; ++y) {
        across += square(0, y, width - 1, y);
        for (int x = 1; x < width; ++x) inner_across += square(x, y, x - 1, y);
    }
    for (int x = 0; x < width; ++x) {
        down += square(x, 0, x, height - 1);
        for (int y = 1; y < height; ++y) inner_down += square(x, y, x, y - 1);
    }
    return {jump_ratio(across, height, inner_across, std::int64_t{height} * (width - 1)),
            jump_ratio(down, width, inner_down, std::int64_t{width} * (height - 1))};
}

}  // namespace mirrorball
