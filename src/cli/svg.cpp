#include "svg.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "html.h"

namespace mirrorball::cli {
namespace {

std::string style(const Ink& ink) {
    std::string text =
        fmt::format(" fill=\"{}\"", ink.fill.empty() ? "none" : std::string_view(ink.fill));
    if (!ink.stroke.empty())
        text += fmt::format(" stroke=\"{}\" stroke-width=\"{:.4g}\"", ink.stroke, ink.width);
    if (ink.opacity < 1) text += fmt::format(" opacity=\"{:.3g}\"", ink.opacity);
    if (ink.dashed) text += " stroke-dasharray=\"5 5\"";
    return text;
}

double distance_to_line(Spot p, Spot a, Spot b) {
    const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
    if (length == 0) return std::hypot(p.x - a.x, p.y - a.y);
    return std::abs((p.x - a.x) * dy - (p.y - a.y) * dx) / length;
}

}  // namespace

Svg::Svg(int width, int height) : width_(width), height_(height) {}

void Svg::line(Spot from, Spot to, const Ink& ink) {
    body_ += fmt::format("<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\"{}/>\n",
                         from.x, from.y, to.x, to.y, style(ink));
}

void Svg::path(const std::vector<Spot>& spots, const Ink& ink, bool closed) {
    if (spots.empty()) return;
    std::string d;
    for (const Spot& spot : spots)
        d += fmt::format("{}{:.2f} {:.2f}", d.empty() ? 'M' : 'L', spot.x, spot.y);
    body_ += fmt::format("<path d=\"{}{}\"{}/>\n", d, closed ? "Z" : "", style(ink));
}

void Svg::circle(Spot centre, double radius, const Ink& ink) {
    body_ += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\"{}/>\n", centre.x,
                         centre.y, radius, style(ink));
}

void Svg::arrow(Spot from, Spot to, const Ink& ink) {
    const double dx = to.x - from.x, dy = to.y - from.y, length = std::hypot(dx, dy);
    if (length == 0) return;
    const double ux = dx / length, uy = dy / length, size = 4 + 3 * ink.width;
    const Spot base{to.x - ux * size, to.y - uy * size};
    line(from, base, ink);
    path({to,
          {base.x - uy * size * 0.4, base.y + ux * size * 0.4},
          {base.x + uy * size * 0.4, base.y - ux * size * 0.4}},
         {.stroke = "", .fill = ink.stroke}, true);
}

void Svg::text(Spot at, std::string_view words, double size, const char* colour, Anchor anchor,
               bool bold) {
    constexpr const char* kAnchors[] = {"start", "middle", "end"};
    body_ += fmt::format(
        "<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:.4g}\" fill=\"{}\" "
        "text-anchor=\"{}\"{}>{}</text>\n",
        at.x, at.y, size, colour, kAnchors[static_cast<int>(anchor)],
        bold ? " font-weight=\"600\"" : "", escaped(words));
}

std::string Svg::str() const {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
        "height=\"{1}\" font-family=\"system-ui, 'Segoe UI', 'Helvetica Neue', Arial, "
        "'DejaVu Sans', sans-serif\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n{2}</svg>\n",
        width_, height_, body_);
}

std::vector<Spot> thinned(const std::vector<Spot>& spots, double tolerance) {
    if (spots.size() < 3) return spots;
    std::vector<Spot> kept = {spots.front()};
    std::size_t last = 0;
    for (std::size_t i = 2; i < spots.size(); ++i) {
        // the line from the last point kept has to pass all points between
        double worst = 0;
        for (std::size_t k = last + 1; k < i; ++k)
            worst = std::max(worst, distance_to_line(spots[k], spots[last], spots[i]));
        if (worst <= tolerance && i - last < 64) continue;
        last = i - 1;
        kept.push_back(spots[last]);
    }
    kept.push_back(spots.back());
    return kept;
}

}  // namespace mirrorball::cli
