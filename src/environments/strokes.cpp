#include "strokes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

namespace mirrorball::detail {
namespace {

struct Stroke {
    Vec2 a, b;
};

// Glyphs stand on y = 0, are 1 high and kGlyphWidth wide.
constexpr double kGlyphWidth = 0.6, kGap = 0.36;
constexpr double kMiddle = kGlyphWidth / 2;

constexpr Stroke kPlus[] = {{{0.02, 0.5}, {0.58, 0.5}}, {{kMiddle, 0.22}, {kMiddle, 0.78}}};
constexpr Stroke kMinus[] = {{{0.02, 0.5}, {0.58, 0.5}}};
constexpr Stroke kX[] = {{{0, 0}, {0.6, 1}}, {{0, 1}, {0.6, 0}}};
constexpr Stroke kY[] = {{{0, 1}, {0.3, 0.5}}, {{0.6, 1}, {0.3, 0.5}}, {{0.3, 0.5}, {0.3, 0}}};
constexpr Stroke kZ[] = {{{0, 1}, {0.6, 1}}, {{0.6, 1}, {0, 0}}, {{0, 0}, {0.6, 0}}};
constexpr Stroke k0[] = {{{0.15, 0}, {0.45, 0}},  {{0.45, 0}, {0.6, 0.2}}, {{0.6, 0.2}, {0.6, 0.8}},
                         {{0.6, 0.8}, {0.45, 1}}, {{0.45, 1}, {0.15, 1}},  {{0.15, 1}, {0, 0.8}},
                         {{0, 0.8}, {0, 0.2}},    {{0, 0.2}, {0.15, 0}}};
constexpr Stroke k1[] = {{{0.1, 0.78}, {0.34, 1}}, {{0.34, 1}, {0.34, 0}}};
constexpr Stroke k2[] = {{{0, 0.8}, {0.15, 1}},    {{0.15, 1}, {0.45, 1}},
                         {{0.45, 1}, {0.6, 0.82}}, {{0.6, 0.82}, {0.6, 0.62}},
                         {{0.6, 0.62}, {0, 0}},    {{0, 0}, {0.6, 0}}};
constexpr Stroke k3[] = {{{0, 1}, {0.6, 1}},         {{0.6, 1}, {0.28, 0.6}},
                         {{0.28, 0.6}, {0.45, 0.6}}, {{0.45, 0.6}, {0.6, 0.42}},
                         {{0.6, 0.42}, {0.6, 0.18}}, {{0.6, 0.18}, {0.45, 0}},
                         {{0.45, 0}, {0.12, 0}},     {{0.12, 0}, {0, 0.14}}};
constexpr Stroke k4[] = {{{0.45, 0}, {0.45, 1}}, {{0.45, 1}, {0, 0.32}}, {{0, 0.32}, {0.6, 0.32}}};
constexpr Stroke k5[] = {{{0.55, 1}, {0.06, 1}},     {{0.06, 1}, {0.02, 0.56}},
                         {{0.02, 0.56}, {0.4, 0.6}}, {{0.4, 0.6}, {0.6, 0.42}},
                         {{0.6, 0.42}, {0.6, 0.18}}, {{0.6, 0.18}, {0.42, 0}},
                         {{0.42, 0}, {0.12, 0}},     {{0.12, 0}, {0, 0.12}}};
constexpr Stroke k6[] = {
    {{0.45, 1}, {0.1, 0.62}},   {{0.1, 0.62}, {0, 0.36}},    {{0, 0.36}, {0, 0.18}},
    {{0, 0.18}, {0.15, 0}},     {{0.15, 0}, {0.45, 0}},      {{0.45, 0}, {0.6, 0.18}},
    {{0.6, 0.18}, {0.6, 0.38}}, {{0.6, 0.38}, {0.45, 0.56}}, {{0.45, 0.56}, {0.08, 0.56}}};
constexpr Stroke k7[] = {{{0, 1}, {0.6, 1}}, {{0.6, 1}, {0.2, 0}}};
constexpr Stroke k8[] = {
    {{0.15, 0.55}, {0.45, 0.55}}, {{0.45, 0.55}, {0.6, 0.4}},   {{0.6, 0.4}, {0.6, 0.15}},
    {{0.6, 0.15}, {0.45, 0}},     {{0.45, 0}, {0.15, 0}},       {{0.15, 0}, {0, 0.15}},
    {{0, 0.15}, {0, 0.4}},        {{0, 0.4}, {0.15, 0.55}},     {{0.45, 0.55}, {0.55, 0.68}},
    {{0.55, 0.68}, {0.55, 0.87}}, {{0.55, 0.87}, {0.43, 1}},    {{0.43, 1}, {0.17, 1}},
    {{0.17, 1}, {0.05, 0.87}},    {{0.05, 0.87}, {0.05, 0.68}}, {{0.05, 0.68}, {0.15, 0.55}}};
constexpr Stroke k9[] = {
    {{0.15, 0}, {0.5, 0.38}}, {{0.5, 0.38}, {0.6, 0.64}}, {{0.6, 0.64}, {0.6, 0.82}},
    {{0.6, 0.82}, {0.45, 1}}, {{0.45, 1}, {0.15, 1}},     {{0.15, 1}, {0, 0.82}},
    {{0, 0.82}, {0, 0.62}},   {{0, 0.62}, {0.15, 0.44}},  {{0.15, 0.44}, {0.52, 0.44}}};
constexpr Stroke kDegree[] = {{{0.06, 1}, {0.24, 1}},
                              {{0.24, 1}, {0.24, 0.82}},
                              {{0.24, 0.82}, {0.06, 0.82}},
                              {{0.06, 0.82}, {0.06, 1}}};
constexpr std::span<const Stroke> kDigits[] = {k0, k1, k2, k3, k4, k5, k6, k7, k8, k9};

std::span<const Stroke> glyph(char character) {
    if (character >= '0' && character <= '9') return kDigits[character - '0'];
    switch (character) {
        case '+':
            return kPlus;
        case '-':
            return kMinus;
        case 'X':
            return kX;
        case 'Y':
            return kY;
        case 'Z':
            return kZ;
        default:
            assert(character == '\'');
            return kDegree;
    }
}

}  // namespace

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
    const double dx = b.x - a.x, dy = b.y - a.y;
    const double along = ((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy);
    const double t = std::clamp(along, 0.0, 1.0);
    return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

double text_width(std::string_view text) {
    return static_cast<double>(text.size()) * (kGlyphWidth + kGap) - kGap;
}

double distance_to_text(const Vec2& p, std::string_view text) {
    const double half_width = text_width(text) / 2;
    const double outside = std::max(std::abs(p.x) - half_width, std::abs(p.y) - 0.5);
    if (outside > 0.5) return outside;

    double nearest = 1e9;
    double left = -half_width;
    for (const char character : text) {
        for (const Stroke& stroke : glyph(character))
            nearest =
                std::min(nearest, distance_to_segment({p.x - left, p.y + 0.5}, stroke.a, stroke.b));
        left += kGlyphWidth + kGap;
    }
    return nearest;
}

}  // namespace mirrorball::detail
