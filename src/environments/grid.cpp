// Latitude and longitude: a checkerboard of 15 degrees, lines every 5, numbers along the equator
// and the main meridians. Hue turns with the longitude and lightness rises with the latitude, so
// every place is told from every other.
//
// Longitude is 0 ahead (-Z), positive to the right: +X is at 90.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "environment.h"
#include "shading.h"
#include "strokes.h"

namespace mirrorball::detail {
namespace {

// Degrees.
constexpr double kDetail = 0.2 * kPi / 180;
constexpr double kCell = 15, kFine = 5;
constexpr double kFinePen = 0.12, kCellPen = 0.28, kMainPen = 0.6;
constexpr double kNumberHeight = 2.4, kNumberPen = 0.3;

const Vec3d kInk(0.9);

// Hues of even lightness, smoothly around the circle.
Vec3d hue(double longitude) {
    const auto channel = [&](double at) { return 0.5 + 0.5 * std::cos(longitude - radians(at)); };
    return {0.03 + 0.62 * channel(0), 0.05 + 0.36 * channel(120), 0.06 + 0.62 * channel(240)};
}

// To the nearest multiple of `step`.
double off_line(double x, double step) {
    return std::abs(x - step * std::round(x / step));
}

// How much of a sample's surroundings a line covers whose middle is `off` degrees away: a ramp
// about as wide as samples are apart, so that thin lines keep their width.
double coverage(double off, double pen) {
    constexpr double kRamp = kDetail * 180 / kPi;
    return std::clamp((pen - off) / kRamp + 0.5, 0.0, 1.0);
}

class Grid final : public Environment {
  public:
    Grid() {
        for (int i = 0; i < kNumberCount; ++i) numbers_[i] = fmt::format("{}'", i * kCell);
    }

    [[nodiscard]] Vec3d radiance(const Vec3d& direction) const override {
        const double across = std::hypot(direction.x, direction.z);
        const double latitude = std::atan2(direction.y, across) / radians(1);
        const double longitude = std::atan2(direction.x, -direction.z) / radians(1);
        // A degree of longitude is shorter toward the poles; pens are not.
        const double narrowing = across;

        // Near the poles the finer meridians would run together: they end one after another, each
        // hidden under a line of the latitude.
        const double steepness = std::abs(latitude);
        const double meridian_cell = steepness > 75 ? 45 : kCell;
        const bool odd = (static_cast<int>(std::floor(latitude / kCell)) +
                          static_cast<int>(std::floor(longitude / meridian_cell))) &
                         1;
        const double lightness = std::exp2(latitude / 60);
        Vec3d colour = hue(radians(longitude)) * (lightness * (odd ? 0.62 : 0.38));

        double off_fine = off_line(latitude, kFine);
        if (steepness < 60) off_fine = std::min(off_fine, off_line(longitude, kFine) * narrowing);
        colour = mix(colour, kInk, 0.3 * coverage(off_fine, kFinePen));
        const double off_cell =
            std::min(off_line(latitude, kCell), off_line(longitude, meridian_cell) * narrowing);
        colour = mix(colour, kInk * 0.75, coverage(off_cell, kCellPen));
        const double off_main = std::min(steepness, off_line(longitude, 90) * narrowing);
        colour = mix(colour, kInk, coverage(off_main, kMainPen));
        return mix(colour, kInk, coverage(off_number(latitude, longitude, narrowing), kNumberPen));
    }
    [[nodiscard]] double detail() const override { return kDetail; }

  private:
    static constexpr int kNumberCount = 13;  // to 180 degrees

    // Degrees to the nearest stroke of a number. They stand just to the right of and above the
    // lines that they name: longitudes at the equator, latitudes beside the four main meridians.
    [[nodiscard]] double off_number(double latitude, double longitude, double narrowing) const {
        const int east = static_cast<int>(std::floor(longitude / kCell + 0.1));
        double off = off_text(longitude - east * kCell, latitude, std::abs(east), east < 0);
        const int north = static_cast<int>(std::floor(latitude / kCell + 0.1));
        if (north != 0 && std::abs(north) <= 5) {
            const double from_meridian = (longitude - 90 * std::round(longitude / 90)) * narrowing;
            off = std::min(
                off, off_text(from_meridian, latitude - north * kCell, std::abs(north), north < 0));
        }
        return off;
    }

    [[nodiscard]] double off_text(double x, double y, int number, bool negative) const {
        constexpr double kMargin = 1.3, kFar = 1e9, kSignWidth = 0.96;
        const std::string_view digits = numbers_[number];
        const double sign_width = negative ? kSignWidth : 0;
        const double width = text_width(digits) + sign_width;
        const Vec2 p{(x - kMargin) / kNumberHeight - width / 2,
                     (y - kMargin) / kNumberHeight - 0.5};
        if (std::abs(p.x) > width || std::abs(p.y) > 1) return kFar;
        double distance = distance_to_text({p.x - sign_width / 2, p.y}, digits);
        if (negative)
            distance = std::min(distance, distance_to_text({p.x + width / 2 - 0.3, p.y}, "-"));
        return distance * kNumberHeight;
    }

    std::array<std::string, kNumberCount> numbers_;
};

}  // namespace

std::unique_ptr<Environment> make_grid() {
    return std::make_unique<Grid>();
}

}  // namespace mirrorball::detail
