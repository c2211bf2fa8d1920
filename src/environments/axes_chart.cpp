// Six labelled sides: which way is which, which way is up, and whether anything is mirrored.
//
// The sides are a cube's about the viewer. Hue tells the axis (X red, Y green, Z blue) and
// lightness the sign (full: positive, pale: negative), so that it also reads without colour vision.
// A side's letters stand upright for a viewer who turns to it by the shortest way from -Z, without
// rolling:
//
//     side       its right   its up          small letters at its edges: what lies beyond
//     +X         +Z          +Y
//     -X         -Z          +Y
//     +Y         +X          +Z              looking up, head tilted back
//     -Y         +X          -Z              looking down
//     +Z         -X          +Y              turned about
//     -Z         +X          +Y
#include <cmath>
#include <string_view>

#include "environment.h"
#include "shading.h"
#include "strokes.h"

namespace mirrorball::detail {
namespace {

constexpr double kDetail = 0.3 * kPi / 180;  // less than the finest line, in a corner

// On a side, x to the right and y up, both -1 to 1: gnomonic, as on a cube.
constexpr double kLabelHeight = 0.62, kLabelPen = 0.062, kLabelY = -0.16;
constexpr double kHintHeight = 0.13, kHintPen = 0.02, kHintDistance = 0.83;
constexpr double kBorder = 0.965, kBorderPen = 0.012;
constexpr double kGridStep = 0.25, kGridPen = 0.009;

struct Side {
    std::string_view name;
    Vec3d forward, right, up;
    Vec3d paper, ink;
    std::string_view at_left, at_right, below, above;
};

const Vec3d kWhite(0.95);
const Side kSides[6] = {
    {"+X", {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0.68, 0.055, 0.035}, kWhite, "-Z", "+Z", "-Y", "+Y"},
    {"-X",
     {-1, 0, 0},
     {0, 0, -1},
     {0, 1, 0},
     {0.90, 0.60, 0.54},
     {0.32, 0.02, 0.012},
     "+Z",
     "-Z",
     "-Y",
     "+Y"},
    {"+Y", {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0.085, 0.40, 0.055}, kWhite, "-X", "+X", "-Z", "+Z"},
    {"-Y",
     {0, -1, 0},
     {1, 0, 0},
     {0, 0, -1},
     {0.62, 0.82, 0.48},
     {0.02, 0.15, 0.015},
     "-X",
     "+X",
     "+Z",
     "-Z"},
    {"+Z", {0, 0, 1}, {-1, 0, 0}, {0, 1, 0}, {0.035, 0.14, 0.66}, kWhite, "+X", "-X", "-Y", "+Y"},
    {"-Z",
     {0, 0, -1},
     {1, 0, 0},
     {0, 1, 0},
     {0.50, 0.68, 0.92},
     {0.012, 0.04, 0.30},
     "-X",
     "+X",
     "-Y",
     "+Y"},
};

const Side& side_of(const Vec3d& d) {
    const double x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
    if (x >= y && x >= z) return kSides[d.x > 0 ? 0 : 1];
    if (y >= z) return kSides[d.y > 0 ? 2 : 3];
    return kSides[d.z > 0 ? 4 : 5];
}

bool on_label(const Vec2& p, std::string_view text, const Vec2& centre, double height, double pen) {
    return distance_to_text({(p.x - centre.x) / height, (p.y - centre.y) / height}, text) * height <
           pen;
}

// A shaft with a solid head.
bool on_arrow(const Vec2& p) {
    constexpr double kFoot = 0.30, kNeck = 0.48, kTip = 0.68, kHalfHead = 0.15, kHalfShaft = 0.042;
    const double x = std::abs(p.x);
    if (p.y >= kFoot && p.y <= kNeck && x <= kHalfShaft) return true;
    return p.y >= kNeck && p.y <= kTip && x <= kHalfHead * (kTip - p.y) / (kTip - kNeck);
}

bool on_grid(const Vec2& p) {
    const auto near_line = [](double x) {
        return std::abs(x - kGridStep * std::round(x / kGridStep)) < kGridPen;
    };
    return near_line(p.x) || near_line(p.y);
}

class AxesChart final : public Environment {
  public:
    [[nodiscard]] Vec3d radiance(const Vec3d& direction) const override {
        const Side& side = side_of(direction);
        const double forward = direction.dot(side.forward);
        const Vec2 p{direction.dot(side.right) / forward, direction.dot(side.up) / forward};

        if (on_label(p, side.name, {0, kLabelY}, kLabelHeight, kLabelPen) || on_arrow(p))
            return side.ink;
        const double edge = std::max(std::abs(p.x), std::abs(p.y));
        if (edge > kHintDistance - kHintHeight &&
            (on_label(p, side.at_left, {-kHintDistance, 0}, kHintHeight, kHintPen) ||
             on_label(p, side.at_right, {kHintDistance, 0}, kHintHeight, kHintPen) ||
             on_label(p, side.below, {0, -kHintDistance}, kHintHeight, kHintPen) ||
             on_label(p, side.above, {0, kHintDistance}, kHintHeight, kHintPen)))
            return side.ink;
        if (std::abs(edge - kBorder) < kBorderPen) return side.ink;
        if (edge > kBorder) return side.paper * 0.75;
        // A little light in the middle keeps the eye there.
        const Vec3d paper = side.paper * (1.06 - 0.16 * std::min(p.x * p.x + p.y * p.y, 1.6));
        return on_grid(p) ? mix(paper, side.ink, 0.16) : paper;
    }
    [[nodiscard]] double detail() const override { return kDetail; }
};

}  // namespace

std::unique_ptr<Environment> make_axes_chart() {
    return std::make_unique<AxesChart>();
}

}  // namespace mirrorball::detail
