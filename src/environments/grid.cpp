// Latitude and longitude: a checkerboard of 15 degrees, lines every 5, numbers along the equator
// and the main meridians. Hue turns with the longitude and lightness rises with the latitude, so
// every place is told from every other.
//
// Longitude is 0 ahead (-Z), positive to the right: +X is at 90.
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "environment.h"
#include "shading.h"
#include "strokes.h"

namespace mirrorball::detail {
namespace {

// Degrees.
constexpr double kDetail = 0.12 * kPi / 180;
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

        if (on_number(latitude, longitude, narrowing)) return kInk;
        // Near the poles the finer meridians would run together: they end one after another.
        const double steepness = std::abs(latitude);
        const double meridian_cell = steepness > 75 + kCellPen ? 45 : kCell;
        if (std::abs(latitude) < kMainPen || off_line(longitude, 90) * narrowing < kMainPen)
            return kInk;
        const double off_cell =
            std::min(off_line(latitude, kCell), off_line(longitude, meridian_cell) * narrowing);
        if (off_cell < kCellPen) return kInk * 0.75;

        const bool odd = (static_cast<int>(std::floor(latitude / kCell)) +
                          static_cast<int>(std::floor(longitude / meridian_cell))) &
                         1;
        const double lightness = std::exp2(latitude / 60);
        const Vec3d paper = hue(radians(longitude)) * (lightness * (odd ? 0.62 : 0.38));
        double off_fine = off_line(latitude, kFine);
        if (steepness < 60 + kFinePen)
            off_fine = std::min(off_fine, off_line(longitude, kFine) * narrowing);
        return off_fine < kFinePen ? mix(paper, kInk, 0.3) : paper;
    }
    [[nodiscard]] double detail() const override { return kDetail; }

  private:
    static constexpr int kNumberCount = 25;  // to 360, should anyone want them

    // Just to the right of and above the lines that they are on: longitudes at the equator,
    // latitudes beside the four main meridians.
    [[nodiscard]] bool on_number(double latitude, double longitude, double narrowing) const {
        const int east = static_cast<int>(std::floor(longitude / kCell + 0.1));
        if (std::abs(east) < kNumberCount &&
            on_text(longitude - east * kCell, latitude, east < 0 ? -east : east, east < 0))
            return true;
        const int north = static_cast<int>(std::floor(latitude / kCell + 0.1));
        if (north == 0 || std::abs(north) > 5) return false;
        const double from_meridian = (longitude - 90 * std::round(longitude / 90)) * narrowing;
        return on_text(from_meridian, latitude - north * kCell, std::abs(north), north < 0);
    }

    [[nodiscard]] bool on_text(double x, double y, int number, bool negative) const {
        constexpr double kMargin = 1.3;
        const std::string_view digits = numbers_[number];
        const double sign_width = negative ? 0.96 : 0;
        const double width = text_width(digits) + sign_width;
        const Vec2 p{(x - kMargin) / kNumberHeight - width / 2,
                     (y - kMargin) / kNumberHeight - 0.5};
        if (std::abs(p.x) > width || std::abs(p.y) > 1) return false;
        double distance = distance_to_text({p.x - sign_width / 2, p.y}, digits);
        if (negative)
            distance = std::min(distance, distance_to_text({p.x + width / 2 - 0.3, p.y}, "-"));
        return distance * kNumberHeight < kNumberPen;
    }

    std::array<std::string, kNumberCount> numbers_;
};

}  // namespace

std::unique_ptr<Environment> make_grid() {
    return std::make_unique<Grid>();
}

}  // namespace mirrorball::detail
