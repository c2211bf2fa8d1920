#include "ball_crop.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <mirrorball/error.h>

namespace mirrorball::detail {
namespace {

// The two pixels that a position lies between, and how far it is from the first to the second.
struct Between {
    int first, second;
    float share;
};

// `position` in pixels from the picture's edge, so that pixel i's centre is at i + 1/2.
Between between_pixels(double position, int count) {
    const double from_first_centre = std::clamp(position - 0.5, 0.0, double(count - 1));
    const int first = int(from_first_centre);
    return {first, std::min(first + 1, count - 1), float(from_first_centre - first)};
}

// A share of 0 does not touch b, which may be no number.
float mix(float a, float b, float share) {
    return share == 0 ? a : a + (b - a) * share;
}

}  // namespace

int crop_size(const CropCircle& circle) {
    return std::max(1, int(std::lround(2 * circle.radius)));
}

void check_crop(const std::string& picture_name, int width, int height, const CropCircle& circle) {
    const double x = circle.x, y = circle.y, radius = circle.radius;
    const auto fail = [&](const std::string& expected) {
        throw Error(Errc::usage, fmt::format("{}: the circle of radius {} about ({}, {}) {}",
                                             picture_name, radius, x, y, expected));
    };
    // written so that NaN fails too
    if (!(radius > 0)) fail("is none: its radius must be above 0");
    const bool inside = x - radius >= -1 && x + radius <= width + 1.0 && y - radius >= -1 &&
                        y + radius <= height + 1.0;
    if (!inside) fail(fmt::format("leaves the picture, which is {} x {} pixels", width, height));
}

Image crop_to_circle(const Image& picture, const CropCircle& circle) {
    const int size = crop_size(circle);
    const double pixels_per_texel = 2 * circle.radius / size;
    const auto source = [&](double centre, int i) {
        return centre - circle.radius + (i + 0.5) * pixels_per_texel;
    };

    Image square(size, size, picture.channels());
    for (int y = 0; y < size; ++y) {
        const Between rows = between_pixels(source(circle.y, y), picture.height());
        for (int x = 0; x < size; ++x) {
            const Between columns = between_pixels(source(circle.x, x), picture.width());
            const float* top_left = picture.at(columns.first, rows.first);
            const float* top_right = picture.at(columns.second, rows.first);
            const float* bottom_left = picture.at(columns.first, rows.second);
            const float* bottom_right = picture.at(columns.second, rows.second);
            for (int c = 0; c < picture.channels(); ++c) {
                const float top = mix(top_left[c], top_right[c], columns.share);
                const float bottom = mix(bottom_left[c], bottom_right[c], columns.share);
                square.at(x, y)[c] = mix(top, bottom, rows.share);
            }
        }
    }
    return square;
}

}  // namespace mirrorball::detail
