#include "brdf_plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "core/parallel.h"
#include "svg.h"

namespace mirrorball::cli {
namespace {

constexpr double kDegree = kPi / 180;

double largest(const Vec3d& colour) {
    return std::max({colour.x, colour.y, colour.z});
}

bool is_grey(const Vec3d& c) {
    return std::abs(c.x - c.y) <= 1e-3 * largest(c) && std::abs(c.x - c.z) <= 1e-3 * largest(c);
}

// A direction in the plane of incidence: light comes from the left, -x.
Vec3d in_plane(double degrees) {
    return {std::sin(degrees * kDegree), 0, std::cos(degrees * kDegree)};
}

// Linear light as a CSS colour, its largest channel full: the hue of a lobe.
std::string css_colour(const Vec3d& light, double level = 1) {
    const double top = std::max(largest(light), 1e-30);
    std::array<int, 3> bytes{};
    for (int c = 0; c < 3; ++c) {
        const double x = std::clamp(light[c] / top * level, 0.0, 1.0);
        const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
        bytes[c] = static_cast<int>(std::lround(255 * encoded));
    }
    return fmt::format("#{:02x}{:02x}{:02x}", bytes[0], bytes[1], bytes[2]);
}

// Titles are as long as a BRDF's text may be.
std::string shortened(const std::string& title) {
    return title.size() <= 72 ? title : title.substr(0, 70) + "…";
}

void head(Svg& svg, const std::string& title, const std::string& caption) {
    svg.text({48, 52}, shortened(title), 26, ink::kText, Anchor::start, true);
    svg.text({48, 80}, caption, 15, ink::kSoft);
}

// Panels in rows of two at most, below the head.
struct Panels {
    static constexpr double kWidth = 520, kTop = 100;
    int columns, rows;
    double height;

    Panels(std::size_t count, double panel_height)
        : columns(count > 1 ? 2 : 1),
          rows(static_cast<int>((count + 1) / 2)),
          height(panel_height) {}
    [[nodiscard]] Svg svg() const {
        return {static_cast<int>(std::max(2, columns) * kWidth),
                static_cast<int>(kTop + rows * height + 20)};
    }
    // The middle of a panel's lower edge.
    [[nodiscard]] Spot foot(std::size_t i) const {
        const double x = columns == 1 ? kWidth : (static_cast<double>(i % 2) + 0.5) * kWidth;
        return {x, kTop + (static_cast<double>(i / 2) + 1) * height};
    }
};

// The protractor that a polar plot lies on.
void draw_protractor(Svg& svg, Spot centre, double radius) {
    const auto at = [&](double degrees, double r) -> Spot {
        return {centre.x + r * std::sin(degrees * kDegree),
                centre.y - r * std::cos(degrees * kDegree)};
    };
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
        std::vector<Spot> arc;
        for (int d = -90; d <= 90; d += 2) arc.push_back(at(d, share * radius));
        svg.path(arc, {.stroke = ink::kGrid, .fill = "", .width = 1});
    }
    for (int d = -60; d <= 60; d += 30) {
        svg.line(centre, at(d, radius), {.stroke = ink::kGrid, .fill = "", .width = 1});
        svg.text({at(d, radius + 14).x, at(d, radius + 14).y + 4}, fmt::format("{}°", std::abs(d)),
                 12, ink::kSoft, Anchor::middle);
    }
    svg.line({centre.x - radius - 12, centre.y}, {centre.x + radius + 12, centre.y},
             {.stroke = ink::kAxis, .fill = "", .width = 2});
}

void draw_polar_panel(Svg& svg, const Brdf& brdf, double angle, Spot foot) {
    constexpr double kRadius = 205;
    const Spot centre{foot.x, foot.y - 44};
    draw_protractor(svg, centre, kRadius);

    constexpr int kStepsPerDegree = 20;  // finer than lobes of exponent 1e6
    const Vec3d wi = in_plane(-angle);
    std::vector<double> degrees;
    std::vector<Vec3d> values;
    double peak = 0;
    for (int i = -90 * kStepsPerDegree + 1; i < 90 * kStepsPerDegree; ++i) {
        degrees.push_back(static_cast<double>(i) / kStepsPerDegree);
        values.push_back(brdf.evaluate(wi, in_plane(degrees.back())));
        peak = std::max(peak, largest(values.back()));
    }
    const auto outline = [&](const std::function<double(const Vec3d&)>& part) {
        std::vector<Spot> spots = {centre};
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double r = kRadius * part(values[i]) / peak, a = degrees[i] * kDegree;
            spots.push_back({centre.x + r * std::sin(a), centre.y - r * std::cos(a)});
        }
        return thinned(spots);
    };
    if (peak > 0) {
        const auto brightest = std::max_element(
            values.begin(), values.end(),
            [](const Vec3d& a, const Vec3d& b) { return largest(a) < largest(b); });
        const bool grey = std::all_of(values.begin(), values.end(), is_grey);
        svg.path(outline([](const Vec3d& f) { return largest(f); }),
                 {.stroke = "", .fill = grey ? "#9ec3e6" : css_colour(*brightest), .opacity = 0.55},
                 true);
        if (grey)
            svg.path(outline([](const Vec3d& f) { return f.x; }),
                     {.stroke = ink::kBlue, .fill = "", .width = 2}, true);
        for (int c = 2; c >= 0 && !grey; --c)
            svg.path(outline([c](const Vec3d& f) { return f[c]; }),
                     {.stroke = ink::kChannels[c], .fill = "", .width = 1.8}, true);
    }
    // a mirror's part is no area but a line: as long as the share that it reflects
    const double mirror = largest(brdf.mirror_reflectance(wi));
    const Vec3d r = in_plane(angle);
    if (mirror > 0)
        svg.arrow(centre, {centre.x + mirror * kRadius * r.x, centre.y - mirror * kRadius * r.z},
                  {.stroke = ink::kOrange, .fill = "", .width = 3.5});
    else
        svg.line(centre, {centre.x + kRadius * r.x, centre.y - kRadius * r.z},
                 {.stroke = ink::kOrange, .fill = "", .width = 1.2, .dashed = true});
    svg.arrow({centre.x + kRadius * wi.x, centre.y - kRadius * wi.z},
              {centre.x + 0.02 * kRadius * wi.x, centre.y - 0.02 * kRadius * wi.z},
              {.stroke = ink::kText, .fill = "", .width = 2});

    std::string caption = peak > 0 ? fmt::format("rim = {:.3g} per sr", peak) : "";
    if (mirror > 0) caption += fmt::format("{}mirror {:.3g}", caption.empty() ? "" : ", ", mirror);
    svg.text({foot.x - kRadius, foot.y - 16}, fmt::format("light from {:g}°", angle), 16,
             ink::kText, Anchor::start, true);
    svg.text({foot.x + kRadius, foot.y - 16}, caption, 14, ink::kSoft, Anchor::end);
}

// Dark violet to yellow, of rising brightness throughout (after the idea of matplotlib's maps).
Vec3d ramp(double t) {
    constexpr int kCount = 5;
    const Vec3d stops[kCount] = {{0.16, 0.11, 0.36},
                                 {0.15, 0.33, 0.55},
                                 {0.13, 0.57, 0.55},
                                 {0.48, 0.79, 0.33},
                                 {0.99, 0.91, 0.25}};
    const double x = std::clamp(t, 0.0, 1.0) * (kCount - 1);
    const int i = std::min(static_cast<int>(x), kCount - 2);
    return stops[i] * (1 - (x - i)) + stops[i + 1] * (x - i);
}

// From the side, a little above and in front: x to the right, z up.
struct Camera {
    Spot centre;
    double scale;

    [[nodiscard]] Spot project(const Vec3d& p) const {
        return {centre.x + scale * (kAcross.x * p.x + kAcross.y * p.y),
                centre.y - scale * (kUp.x * p.x + kUp.y * p.y + kUp.z * p.z)};
    }
    [[nodiscard]] static double nearness(const Vec3d& p) { return kToward.dot(p); }

    static inline const double kTurn = -68 * kDegree, kTilt = 24 * kDegree;
    static inline const Vec3d kAcross{-std::sin(kTurn), std::cos(kTurn), 0};
    static inline const Vec3d kToward{std::cos(kTilt) * std::cos(kTurn),
                                      std::cos(kTilt) * std::sin(kTurn), std::sin(kTilt)};
    static inline const Vec3d kUp{-std::sin(kTilt) * std::cos(kTurn),
                                  -std::sin(kTilt) * std::sin(kTurn), std::cos(kTilt)};
};

// From `low` to `high`, the closer together the nearer to `middle`: no lobe there is too narrow.
std::vector<double> crowded(double low, double middle, double high) {
    constexpr int kSteps = 160;  // to either side
    std::vector<double> values;
    for (int i = -kSteps; i <= kSteps; ++i) {
        const double x = static_cast<double>(i) / kSteps,
                     reach = i < 0 ? middle - low : high - middle;
        values.push_back(middle + reach * x * x * x);
    }
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
}

// Of steps that cost so much each, the ends of `count` strides of equal cost, and `peak` among
// them.
std::vector<std::size_t> strides(const std::vector<double>& costs, int count, std::size_t peak) {
    double total = 0;
    for (const double cost : costs) total += cost;
    std::vector<std::size_t> ends = {0};
    double sum = 0;
    for (std::size_t i = 0; i < costs.size(); ++i) {
        sum += costs[i];
        const bool full = sum >= total * static_cast<double>(ends.size()) / count;
        if (full || i + 1 == peak) ends.push_back(i + 1);
    }
    if (ends.back() != costs.size()) ends.push_back(costs.size());
    return ends;
}

struct Quad {
    std::array<Vec3d, 4> corners;
    double value;  // 0 to 1

    [[nodiscard]] Vec3d middle() const {
        return (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
    }
};

// The points f wo over the hemisphere, by angle and azimuth, the largest at distance 1.
struct LobePoints {
    std::vector<double> thetas, azimuths;
    std::vector<std::vector<Vec3d>> tips;
    double peak = 0;
    std::size_t peak_row = 0, peak_column = 0;
};

LobePoints lobe_points(const Brdf& brdf, double angle) {
    LobePoints lobe;
    lobe.thetas = crowded(0, angle * kDegree, kPi / 2 * 0.9999);
    lobe.azimuths = crowded(-kPi, 0, kPi);
    const Vec3d wi = in_plane(-angle);
    for (std::size_t i = 0; i < lobe.thetas.size(); ++i) {
        std::vector<Vec3d> row;
        for (std::size_t j = 0; j < lobe.azimuths.size(); ++j) {
            const double sine = std::sin(lobe.thetas[i]), azimuth = lobe.azimuths[j];
            const Vec3d wo(sine * std::cos(azimuth), sine * std::sin(azimuth),
                           std::cos(lobe.thetas[i]));
            const double f = largest(brdf.evaluate(wi, wo));
            if (f > lobe.peak) {
                lobe.peak = f;
                lobe.peak_row = i;
                lobe.peak_column = j;
            }
            row.push_back(wo * f);
        }
        lobe.tips.push_back(std::move(row));
    }
    for (auto& row : lobe.tips) {
        for (Vec3d& tip : row) tip /= std::max(lobe.peak, 1e-300);
    }
    return lobe;
}

// A mesh whose sides are short where the lobe is steep and everywhere else alike.
std::vector<Quad> lobe_mesh(const LobePoints& lobe) {
    constexpr int kThetaCount = 40, kAzimuthCount = 64;
    const auto& tips = lobe.tips;
    std::vector<double> theta_costs, azimuth_costs;
    for (std::size_t i = 0; i + 1 < lobe.thetas.size(); ++i) {
        double way = 0;
        for (std::size_t j = 0; j < lobe.azimuths.size(); ++j)
            way = std::max(way, (tips[i + 1][j] - tips[i][j]).length());
        theta_costs.push_back(way + (lobe.thetas[i + 1] - lobe.thetas[i]) / 2);
    }
    for (std::size_t j = 0; j + 1 < lobe.azimuths.size(); ++j) {
        double way = 0;
        for (const auto& row : tips) way = std::max(way, (row[j + 1] - row[j]).length());
        azimuth_costs.push_back(way + (lobe.azimuths[j + 1] - lobe.azimuths[j]) / 4);
    }
    const auto rows = strides(theta_costs, kThetaCount, lobe.peak_row);
    const auto columns = strides(azimuth_costs, kAzimuthCount, lobe.peak_column);
    std::vector<Quad> quads;
    for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
        for (std::size_t j = 0; j + 1 < columns.size(); ++j) {
            const auto &upper = tips[rows[i]], &lower = tips[rows[i + 1]];
            Quad quad{{upper[columns[j]], lower[columns[j]], lower[columns[j + 1]],
                       upper[columns[j + 1]]},
                      0};
            for (const Vec3d& corner : quad.corners) quad.value += corner.length() / 4;
            quads.push_back(quad);
        }
    }
    // the far ones first, so that the near ones cover them
    std::stable_sort(quads.begin(), quads.end(), [](const Quad& a, const Quad& b) {
        return Camera::nearness(a.middle()) < Camera::nearness(b.middle());
    });
    return quads;
}

void draw_dome(Svg& svg, const Camera& camera) {
    std::vector<Spot> rim;
    for (int d = 0; d < 360; d += 3)
        rim.push_back(camera.project({std::cos(d * kDegree), std::sin(d * kDegree), 0}));
    svg.path(rim, {.stroke = ink::kAxis, .fill = "#f3f4f6", .width = 1.2}, true);
    for (const double theta : {30.0, 60.0}) {
        std::vector<Spot> circle;
        for (int d = 0; d < 360; d += 3)
            circle.push_back(camera.project({std::sin(theta * kDegree) * std::cos(d * kDegree),
                                             std::sin(theta * kDegree) * std::sin(d * kDegree),
                                             std::cos(theta * kDegree)}));
        svg.path(circle, {.stroke = ink::kGrid, .fill = "", .width = 1}, true);
    }
    for (int azimuth = 0; azimuth < 180; azimuth += 45) {
        std::vector<Spot> arc;
        for (int d = -90; d <= 90; d += 3)
            arc.push_back(camera.project({std::sin(d * kDegree) * std::cos(azimuth * kDegree),
                                          std::sin(d * kDegree) * std::sin(azimuth * kDegree),
                                          std::cos(d * kDegree)}));
        svg.path(arc, {.stroke = ink::kGrid, .fill = "", .width = 1});
    }
}

double area(const std::vector<Spot>& spots) {
    double twice = 0;
    for (std::size_t i = 0; i < spots.size(); ++i) {
        const Spot &a = spots[i], &b = spots[(i + 1) % spots.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return std::abs(twice) / 2;
}

void draw_lobe_panel(Svg& svg, const Brdf& brdf, double angle, Spot foot) {
    const Camera camera{{foot.x, foot.y - 130}, 215};
    const Vec3d wi = in_plane(-angle), r = in_plane(angle);
    draw_dome(svg, camera);
    const Spot centre = camera.project(Vec3d(0));
    svg.line(centre, camera.project({0, 0, 1.08}),
             {.stroke = ink::kAxis, .fill = "", .width = 1.2, .dashed = true});
    svg.arrow(camera.project(wi * 1.1), camera.project(wi * 0.02),
              {.stroke = ink::kText, .fill = "", .width = 2});

    const LobePoints lobe = lobe_points(brdf, angle);
    const double peak = lobe.peak;
    for (const Quad& quad : lobe_mesh(lobe)) {
        std::vector<Spot> spots;
        for (const Vec3d& corner : quad.corners) spots.push_back(camera.project(corner));
        if (area(spots) < 0.02) continue;
        // lit from the upper left front, softly
        Vec3d normal = (quad.corners[2] - quad.corners[0])
                           .cross(quad.corners[3] - quad.corners[1])
                           .normalized();
        if (normal.dot(quad.middle()) < 0) normal = -normal;
        const double light = 0.5 + 0.5 * normal.dot(Vec3d(-0.35, -0.55, 0.76));
        const Vec3d colour = ramp(quad.value) * (0.5 + 0.5 * light);
        const std::string css = fmt::format("#{:02x}{:02x}{:02x}", int(255 * colour.x),
                                            int(255 * colour.y), int(255 * colour.z));
        // an edge of its own colour hides the seams between neighbours
        svg.path(spots, {.stroke = css, .fill = css, .width = 0.6}, true);
    }
    const double mirror = largest(brdf.mirror_reflectance(wi));
    if (mirror > 0)
        svg.arrow(centre, camera.project(r * mirror),
                  {.stroke = ink::kOrange, .fill = "", .width = 3.5});
    else
        svg.line(camera.project(r * 1.01), camera.project(r * 1.12),
                 {.stroke = ink::kOrange, .fill = "", .width = 2.5});

    std::string caption = peak > 0 ? fmt::format("largest {:.3g} per sr", peak) : "";
    if (mirror > 0) caption += fmt::format("{}mirror {:.3g}", caption.empty() ? "" : ", ", mirror);
    svg.text({foot.x - 215, foot.y - 12}, fmt::format("light from {:g}°", angle), 16, ink::kText,
             Anchor::start, true);
    svg.text({foot.x + 215, foot.y - 12}, caption, 14, ink::kSoft, Anchor::end);
}

// A chart over the angle of incidence from 0 to 90 degrees.
class AngleChart {
  public:
    AngleChart(double top, double step) : top_(top) {
        for (int d = 0; d <= 90; d += 15) {
            svg_.line(at(d, 0), at(d, top), {.stroke = ink::kGrid, .fill = "", .width = 1});
            svg_.text({at(d, 0).x, at(d, 0).y + 24}, fmt::format("{}°", d), 14, ink::kSoft,
                      Anchor::middle);
        }
        const int count = static_cast<int>(std::lround(top / step));
        for (int i = 0; i <= count; ++i) {
            svg_.line(at(0, i * step), at(90, i * step),
                      {.stroke = i == 0 ? ink::kAxis : ink::kGrid, .fill = "", .width = 1});
            svg_.text({at(0, 0).x - 12, at(0, i * step).y + 5}, fmt::format("{:.4g}", i * step), 14,
                      ink::kSoft, Anchor::end);
        }
        svg_.text({(at(0, 0).x + at(90, 0).x) / 2, at(0, 0).y + 52}, "angle to the normal", 15,
                  ink::kSoft, Anchor::middle);
    }

    [[nodiscard]] Spot at(double degrees, double value) const {
        return {90 + degrees / 90 * 760, 560 - value / top_ * 430};
    }
    [[nodiscard]] Svg& svg() { return svg_; }

    // Curves of a function of the angle: one where channels agree, else one for each.
    void curves(const std::vector<double>& degrees, const std::vector<Vec3d>& values,
                const char* grey_colour, bool dashed) {
        const bool grey = std::all_of(values.begin(), values.end(), is_grey);
        for (int c = grey ? 0 : 2; c >= 0; --c) {
            std::vector<Spot> spots;
            for (std::size_t i = 0; i < degrees.size(); ++i) {
                const double value = values[i][c];
                if (value > top_) {  // leaves the chart here
                    if (i == 0) break;
                    const double before = values[i - 1][c];
                    const double share = (top_ - before) / (value - before);
                    spots.push_back(
                        at(degrees[i - 1] + share * (degrees[i] - degrees[i - 1]), top_));
                    break;
                }
                spots.push_back(at(degrees[i], value));
            }
            svg_.path(thinned(spots), {.stroke = grey ? grey_colour : ink::kChannels[c],
                                       .fill = "",
                                       .width = 2.6,
                                       .dashed = dashed});
        }
    }

    // A line across, with its name above its left end.
    void level(double value, const std::string& name) {
        if (value > top_) return;
        svg_.line(at(0, value), at(90, value),
                  {.stroke = ink::kAxis, .fill = "", .width = 1.4, .dashed = true});
        svg_.text({at(0, value).x + 8, at(0, value).y - 7}, name, 13, ink::kSoft);
    }

    void legend(int row, const char* colour, bool dashed, const std::string& name) {
        const Spot spot{872, 150.0 + 26 * row};
        svg_.line({spot.x, spot.y}, {spot.x + 30, spot.y},
                  {.stroke = colour, .fill = "", .width = 2.6, .dashed = dashed});
        svg_.text({spot.x + 40, spot.y + 5}, name, 14);
    }

  private:
    double top_;
    Svg svg_{1040, 640};
};

// The names of what curves() drew; the next free row.
int add_legend(AngleChart& chart, int row, const std::vector<Vec3d>& values,
               const char* grey_colour, bool dashed, const std::string& name) {
    if (std::all_of(values.begin(), values.end(), is_grey)) {
        chart.legend(row, grey_colour, dashed, name);
        return row + 1;
    }
    constexpr const char* kNames[] = {"red", "green", "blue"};
    for (int c = 0; c < 3; ++c)
        chart.legend(row + c, ink::kChannels[c], dashed, fmt::format("{}, {}", name, kNames[c]));
    return row + 3;
}

std::string percent(double share) {
    return fmt::format("{:.3g} %", 100 * share);
}

}  // namespace

std::string polar_plot(const Brdf& brdf, const std::string& title,
                       const std::vector<double>& angles) {
    const Panels panels(angles.size(), 300);
    Svg svg = panels.svg();
    head(svg, title,
         "f in the plane of incidence, by the direction of view; each to its own scale");
    for (std::size_t i = 0; i < angles.size(); ++i)
        draw_polar_panel(svg, brdf, angles[i], panels.foot(i));
    return svg.str();
}

std::string hemisphere_plot(const Brdf& brdf, const std::string& title,
                            const std::vector<double>& angles) {
    const Panels panels(angles.size(), 400);
    Svg svg = panels.svg();
    head(svg, title,
         "f over the hemisphere: as far from the centre as it is bright; each to its own "
         "scale");
    for (std::size_t i = 0; i < angles.size(); ++i)
        draw_lobe_panel(svg, brdf, angles[i], panels.foot(i));
    return svg.str();
}

std::string albedo_plot(const Brdf& brdf, const std::string& title) {
    std::vector<double> degrees;
    for (double d = 0; d < 75; d += 2.5) degrees.push_back(d);
    for (double d = 75; d <= 89; d += 1) degrees.push_back(d);
    degrees.insert(degrees.end(), {89.5, 89.8});
    std::vector<Vec3d> albedo(degrees.size()), furnace(degrees.size());
    detail::parallel_for(static_cast<std::int64_t>(degrees.size()), [&](std::int64_t i) {
        const Vec3d w = in_plane(-degrees[i]);
        albedo[i] = directional_albedo(brdf, w).value;
        furnace[i] = furnace_radiance(brdf, w).value;
    });
    double top = 0, apart = 0;
    for (std::size_t i = 0; i < degrees.size(); ++i) {
        top = std::max({top, largest(albedo[i]), largest(furnace[i])});
        apart = std::max(apart, (albedo[i] - furnace[i]).length());
    }
    // beyond twice the light that arrives a curve may leave the chart
    AngleChart chart(top <= 1.001 ? 1 : std::min(2.0, std::ceil(top * 4) / 4), 0.25);
    head(chart.svg(), title,
         "share of the light that is reflected, light coming along the tangent");
    if (top > 1.001) chart.level(1, "all of the light");
    chart.curves(degrees, albedo, ink::kBlue, false);
    int row = add_legend(chart, 0, albedo, ink::kBlue, false, "albedo");
    if (apart > 0.01) {
        chart.curves(degrees, furnace, ink::kOrange, true);
        row = add_legend(chart, row, furnace, ink::kOrange, true, "uniform light");
    }
    const Vec3d mean = mean_albedo(brdf).value;
    chart.svg().text({872, 150.0 + 26 * row + 16},
                     fmt::format("mean {}", percent((mean.x + mean.y + mean.z) / 3)), 14,
                     ink::kSoft);
    return chart.svg().str();
}

std::string fresnel_plot(const Fresnel& fresnel, const std::string& title) {
    std::vector<double> degrees;
    std::vector<Vec3d> values;
    for (int i = 0; i <= 900; ++i) {
        degrees.push_back(i / 10.0);
        values.push_back(fresnel(std::cos(degrees.back() * kDegree)));
    }
    AngleChart chart(1, 0.25);
    const Vec3d mean = fresnel.average(), normal = fresnel(1);
    head(chart.svg(), title, "share of the light that is mirrored");
    chart.curves(degrees, values, ink::kBlue, false);
    const int row = add_legend(chart, 0, values, ink::kBlue, false, "F");
    const auto average = [](const Vec3d& c) { return (c.x + c.y + c.z) / 3; };
    chart.svg().text({872, 150.0 + 26 * row + 16},
                     fmt::format("normal {}", percent(average(normal))), 14, ink::kSoft);
    chart.svg().text({872, 150.0 + 26 * row + 38}, fmt::format("mean {}", percent(average(mean))),
                     14, ink::kSoft);
    return chart.svg().str();
}

}  // namespace mirrorball::cli
