// Every plot is made of the same parts: a section through the sphere of directions, seen from the
// side; texels as cells, each in the colour of the direction that it holds; rays from the texels to
// where they look. All directions are the library's own, of the projections' types.
#include "projection_plots.h"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "svg.h"

namespace mirrorball::cli {
namespace {

using Point = FacePoint<double>;

constexpr int kWidth = 1280, kHeight = 720;
const Ink kOutline{.stroke = ink::kText, .fill = "", .width = 2.5};

// A direction's colour goes once around the wheel of hues as it goes around the section.
std::string hue(double angle) {
    const double turn = angle / (2 * kPi) - std::floor(angle / (2 * kPi));
    std::array<int, 3> bytes{};
    for (int c = 0; c < 3; ++c) {
        const double wave = 0.5 + 0.5 * std::cos(2 * kPi * (turn - c / 3.0));
        bytes[c] = static_cast<int>(std::lround(40 + 190 * wave));
    }
    return fmt::format("#{:02x}{:02x}{:02x}", bytes[0], bytes[1], bytes[2]);
}

// The plane through which the sphere is cut: two directions of the map's frame, and what those to
// the right, up, left and down are called.
struct Plane {
    Vec3d right, up;
    const char* names[4];

    [[nodiscard]] double angle(const Vec3d& d) const { return std::atan2(d.dot(up), d.dot(right)); }
};

class Section {
  public:
    Section(Plane plane, Spot centre, double unit)
        : plane_(std::move(plane)),
          centre_(centre),
          unit_(unit) {}

    Svg svg{kWidth, kHeight};

    [[nodiscard]] Spot at(double right, double up) const {
        return {centre_.x + right * unit_, centre_.y - up * unit_};
    }
    /// Of the unit circle, times `radius`.
    [[nodiscard]] Spot towards(const Vec3d& d, double radius = 1) const {
        return at(radius * d.dot(plane_.right), radius * d.dot(plane_.up));
    }
    [[nodiscard]] std::string colour(const Vec3d& d) const { return hue(plane_.angle(d)); }

    void head(const std::string& title, const std::vector<std::string>& lines) {
        svg.text({48, 56}, title, 30, ink::kText, Anchor::start, true);
        for (std::size_t i = 0; i < lines.size(); ++i)
            svg.text({48, 88 + 24 * static_cast<double>(i)}, lines[i], 17, ink::kSoft);
    }
    void foot(const ProjectionFacts& facts) {
        const auto count = [](int n, const char* what) {
            return n == 0 ? fmt::format("no {}", what)
                          : fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
        };
        svg.text(
            {48, kHeight - 28},
            fmt::format("pixels used {:.3g} %   ·   solid angles 1 : {:.3g}   ·   stretched up "
                        "to {:.3g} : 1   ·   {}, {}",
                        facts.used_share * 100, facts.solid_angle_ratio, facts.worst_stretch,
                        count(facts.seam_count, "seam"), count(facts.pole_count, "pole")),
            17, ink::kText);
    }

    /// All directions of the plane and their colours, around `middle`.
    void wheel(Spot middle, double radius, double width) {
        constexpr int kSteps = 180;
        const auto spot = [&](double i, double r) -> Spot {
            const double a = 2 * kPi * i / kSteps;
            return {middle.x + r * std::cos(a), middle.y - r * std::sin(a)};
        };
        for (int i = 0; i < kSteps; ++i) {
            svg.path({spot(i - 0.55, radius), spot(i + 0.55, radius)},
                     {.stroke = hue(2 * kPi * i / kSteps), .fill = "", .width = width});
        }
        const double rim = radius + width / 2;
        const auto label = [&](double dx, double dy, int i, Anchor anchor) {
            svg.text({middle.x + dx, middle.y - dy + 6}, plane_.names[i], 18, ink::kText, anchor);
        };
        label(rim + 6, 0, 0, Anchor::start);
        label(0, rim + 16, 1, Anchor::middle);
        label(-rim - 6, 0, 2, Anchor::end);
        label(0, -rim - 16, 3, Anchor::middle);
    }

    /// A row of texels, edge after edge, each in the colour of what it holds.
    void texels(const std::vector<Spot>& edges, const std::vector<Vec3d>& directions,
                double width = 16) {
        for (std::size_t i = 0; i < directions.size(); ++i) {
            const Spot a = edges[i], b = edges[i + 1];
            const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
            const double nx = -dy / length * width / 2, ny = dx / length * width / 2;
            svg.path({{a.x + nx, a.y + ny},
                      {b.x + nx, b.y + ny},
                      {b.x - nx, b.y - ny},
                      {a.x - nx, a.y - ny}},
                     {.stroke = "#ffffff", .fill = colour(directions[i]), .width = 1.5}, true);
        }
    }

    void ray(Spot from, Spot to, const Vec3d& d, double width = 1.8) {
        svg.line(from, to, {.stroke = colour(d), .fill = "", .width = width});
    }
    void arrow(Spot from, Spot to, const Vec3d& d) {
        svg.arrow(from, to, {.stroke = colour(d), .fill = "", .width = 1.8});
    }
    /// The survey's white points: where a ray meets the surface.
    void dot(Spot spot) {
        svg.circle(spot, 3.6, {.stroke = ink::kText, .fill = "#ffffff", .width = 1.5});
    }

  private:
    Plane plane_;
    Spot centre_;
    double unit_;
};

// The middles of `count` texels along a line of a face, and the directions that they hold.
template <class Map>
std::vector<Vec3d> directions_along(Point from, Point to, int count) {
    std::vector<Vec3d> directions;
    for (int i = 0; i < count; ++i) {
        const double x = (i + 0.5) / count;
        directions.push_back(Map::direction(
            Point{from.face, from.s + (to.s - from.s) * x, from.t + (to.t - from.t) * x}));
    }
    return directions;
}

std::vector<Spot> edges_along(Spot from, Spot to, std::size_t count) {
    std::vector<Spot> edges;
    for (std::size_t i = 0; i <= count; ++i) {
        const double x = static_cast<double>(i) / static_cast<double>(count);
        edges.push_back({from.x + (to.x - from.x) * x, from.y + (to.y - from.y) * x});
    }
    return edges;
}

Spot middle(Spot a, Spot b) {
    return {(a.x + b.x) / 2, (a.y + b.y) / 2};
}

const Plane kSide{
    {0, 0, 1}, {0, 1, 0}, {"+z", "+y", "-z", "-y"}};  // from the side: z to the right, y up

// A disc's column of texels at `map_x` and the parallel rays of an orthographic camera from there
// to the surface, x = depth(y), which reflects them.
template <class Map, class Depth>
void reflect_column(Section& s, int face, double map_x, int count, double arrow_length,
                    Depth depth) {
    const std::vector<Vec3d> directions =
        directions_along<Map>({face, 0.5, 0.0}, {face, 0.5, 1.0}, count);
    std::vector<Spot> dots;
    for (int i = 0; i < count; ++i) {
        const double y = 1 - (2 * i + 1.0) / count, x = depth(y);
        const Vec3d& d = directions[static_cast<std::size_t>(i)];
        dots.push_back(s.at(x, y));
        s.ray(s.at(map_x, y), dots.back(), d, 1.3);
        s.arrow(dots.back(), s.at(x + arrow_length * d.z, y + arrow_length * d.y), d);
    }
    for (const Spot& dot : dots) s.dot(dot);
    s.texels(edges_along(s.at(map_x, 1), s.at(map_x, -1), directions.size()), directions);
}

template <class Curve>
void draw_curve(Section& s, Curve curve, double from, double to) {
    std::vector<Spot> spots;
    constexpr int kSteps = 180;
    for (int i = 0; i <= kSteps; ++i) {
        const auto [x, y] = curve(from + (to - from) * i / kSteps);
        spots.push_back(s.at(x, y));
    }
    s.svg.path(thinned(spots), kOutline);
}

std::string draw(SphereMap, const ProjectionFacts& facts) {
    constexpr int kCount = 20;
    Section s(kSide, {470, 400}, 185);
    s.head("Sphere map", {"what an orthographic camera far to the right, at +z, sees of a small "
                          "mirror ball: r = 2 (n·v) n - v"});
    s.svg.circle(s.at(0, 0), 185, {.stroke = "", .fill = "#f0f2f4"});
    draw_curve(
        s, [](double a) { return std::pair(std::cos(a), std::sin(a)); }, 0, 2 * kPi);
    reflect_column<SphereMap>(s, 0, 3.1, kCount, 0.62,
                              [](double y) { return std::sqrt(1 - y * y); });
    s.svg.text(s.at(3.1, 1.1), "the map", 18, ink::kText, Anchor::middle);
    s.svg.text(s.at(0, 0), "mirror ball", 18, ink::kSoft, Anchor::middle);
    s.wheel({170, 590}, 44, 14);
    s.svg.text(s.at(2.05, -1.2), "the rim is the one direction -z", 17, ink::kSoft, Anchor::middle);
    s.foot(facts);
    return s.svg.str();
}

std::string draw(DualParaboloid, const ProjectionFacts& facts) {
    constexpr int kCount = 18;
    Section s(kSide, {640, 395}, 165);
    s.head("Dual paraboloid", {"two orthographic cameras, at +z and -z, each see a paraboloid "
                               "reflect half of all directions, as if from its focus"});
    for (const double side : {1.0, -1.0}) {
        const auto depth = [side](double y) { return side * (0.5 - 0.5 * y * y); };
        draw_curve(
            s, [&](double y) { return std::pair(depth(y), y); }, -1, 1);
        reflect_column<DualParaboloid>(s, side > 0 ? 0 : 1, side * 2.9, kCount, 0.62, depth);
    }
    s.svg.circle(s.at(0, 0), 4, {.stroke = "", .fill = ink::kText});
    s.svg.text(s.at(0.04, -0.03), "focus", 17, ink::kText);
    s.svg.text(s.at(2.9, 1.1), "front map", 18, ink::kText, Anchor::middle);
    s.svg.text(s.at(-2.9, 1.1), "back map", 18, ink::kText, Anchor::middle);
    s.wheel({900, 622}, 36, 12);
    s.foot(facts);
    return s.svg.str();
}

std::string draw(Cube, const ProjectionFacts& facts) {
    constexpr int kCount = 9;
    // faces around the horizon in the order of the unfolded row, and their names
    constexpr std::pair<int, const char*> kFaces[] = {{1, "-x"}, {4, "+z"}, {0, "+x"}, {5, "-z"}};
    Section s({{1, 0, 0}, {0, 0, -1}, {"+x", "-z", "-x", "+z"}}, {360, 395}, 138);
    s.head("Cube map", {"six perspective pictures from the centre: texels are alike on a face,",
                        "not on the sphere; near a corner 5.2 of them share a middle one's angle"});
    constexpr double kEdge = 130;
    const Spot row{720, 400 - kEdge / 2};
    const auto square = [&](double column, double line) {
        const Spot a{row.x + column * kEdge, row.y + line * kEdge};
        s.svg.path({a, {a.x + kEdge, a.y}, {a.x + kEdge, a.y + kEdge}, {a.x, a.y + kEdge}},
                   {.stroke = ink::kAxis, .fill = "#f7f8f9", .width = 1.5}, true);
        return a;
    };
    s.svg.text({square(1, -1).x + kEdge / 2, row.y - kEdge / 2 + 6}, "+y", 18, ink::kSoft,
               Anchor::middle);
    s.svg.text({square(1, 1).x + kEdge / 2, row.y + 1.5 * kEdge + 6}, "-y", 18, ink::kSoft,
               Anchor::middle);
    for (std::size_t i = 0; i < std::size(kFaces); ++i) {
        const auto [face, face_name] = kFaces[i];
        const Spot a = square(static_cast<double>(i), 0);
        const auto directions = directions_along<Cube>({face, 0.0, 0.5}, {face, 1.0, 0.5}, kCount);
        s.texels(edges_along({a.x, 400}, {a.x + kEdge, 400}, kCount), directions);
        s.svg.text({a.x + kEdge / 2, row.y + 30}, face_name, 18, ink::kText, Anchor::middle);
        // a direction's place on the cube: its largest component is 1 there
        std::vector<Spot> edges;
        for (int k = 0; k <= kCount; ++k) {
            const Vec3d d = Cube::direction(Point{face, static_cast<double>(k) / kCount, 0.5});
            edges.push_back(s.towards(d / std::max(std::abs(d.x), std::abs(d.z))));
        }
        for (const Vec3d& d : directions) s.ray(s.at(0, 0), s.towards(d, 1.62), d, 1.3);
        s.texels(edges, directions, 12);
    }
    s.svg.circle(s.at(0, 0), 5, {.stroke = "", .fill = ink::kText});
    s.wheel(s.at(0, 0), 138 * 1.67, 14);
    s.foot(facts);
    return s.svg.str();
}

// Directions as a ring; texels on a line that it is unrolled to, joined by lines.
void unroll(Section& s, Spot top, Spot bottom, const std::vector<Vec3d>& directions) {
    const std::vector<Spot> edges = edges_along(top, bottom, directions.size());
    for (std::size_t i = 0; i < directions.size(); ++i)
        s.ray(s.towards(directions[i], 1.06), middle(edges[i], edges[i + 1]), directions[i], 1.2);
    s.texels(edges, directions);
}

std::string draw(Equirect, const ProjectionFacts& facts) {
    constexpr int kCount = 18;
    Section s({{1, 0, 0}, {0, 1, 0}, {"+x", "+y", "-x", "-y"}}, {640, 400}, 190);
    s.head("Equirectangular",
           {"rows at equal angles of latitude, columns at equal longitudes: at the poles a whole "
            "row is one direction"});
    for (const double side : {1.0, -1.0}) {
        const double column = side > 0 ? 0.75 : 0.25;
        unroll(s, s.at(side * 2.3, 1.2), s.at(side * 2.3, -1.2),
               directions_along<Equirect>({0, column, 0.0}, {0, column, 1.0}, kCount));
        s.svg.text(s.at(side * 2.3, 1.28), side > 0 ? "column at 3/4" : "column at 1/4", 18,
                   ink::kText, Anchor::middle);
    }
    s.svg.circle(s.at(0, 0), 190, {.stroke = "", .fill = "#ffffff"});
    // the axis, and what a texel in the middle and one at a pole span
    s.svg.line(s.at(0, 0.94), s.at(0, -0.94),
               {.stroke = ink::kAxis, .fill = "", .width = 1.5, .dashed = true});
    for (int i = 0; i <= kCount; ++i) {
        const double a = kPi * (0.5 - static_cast<double>(i) / kCount);
        s.svg.line(s.at(-0.95 * std::cos(a), 0.95 * std::sin(a)),
                   s.at(0.95 * std::cos(a), 0.95 * std::sin(a)),
                   {.stroke = ink::kGrid, .fill = "", .width = 1.5});
    }
    s.wheel(s.at(0, 0), 190, 14);
    s.foot(facts);
    return s.svg.str();
}

std::string draw(AngularMap, const ProjectionFacts& facts) {
    constexpr int kCount = 24;
    Section s({{0, 0, -1}, {0, 1, 0}, {"-z", "+y", "+z", "-y"}}, {400, 400}, 190);
    s.head("Angular map (light probe)",
           {"the distance from the centre of the map is the angle from -z: the circle unrolled"});
    unroll(s, s.at(3.4, 1.35), s.at(3.4, -1.35),
           directions_along<AngularMap>({0, 0.5, 0.0}, {0, 0.5, 1.0}, kCount));
    s.svg.text(s.at(3.4, 1.44), "the map", 18, ink::kText, Anchor::middle);
    s.svg.circle(s.at(0, 0), 190 * 1.06, {.stroke = "", .fill = "#ffffff"});
    for (int i = 0; i < kCount; ++i) {
        const Vec3d d = AngularMap::direction(Point{0, 0.5, (i + 0.5) / kCount});
        s.ray(s.at(0, 0), s.towards(d, 0.95), d, 1.3);
    }
    s.svg.circle(s.at(0, 0), 5, {.stroke = "", .fill = ink::kText});
    s.wheel(s.at(0, 0), 190, 14);
    s.foot(facts);
    return s.svg.str();
}

// The way around the sphere through x = 0 lies on the square along the right half of its upper
// edge, the middle column and the right half of the lower edge.
template <class Map, class OnSurface>
void draw_folded(Section& s, OnSurface on_surface) {
    constexpr int kCount = 10;  // per half edge of the square
    constexpr double kEdge = 400;
    const Spot corner{820, 200};
    const auto on_map = [&](const Point& p) {
        return Spot{corner.x + p.s * kEdge, corner.y + p.t * kEdge};
    };
    s.svg.path({on_map({0, 0, 0}), on_map({0, 1, 0}), on_map({0, 1, 1}), on_map({0, 0, 1})},
               {.stroke = ink::kAxis, .fill = "#f7f8f9", .width = 1.5}, true);
    s.svg.path({on_map({0, 0.5, 0}), on_map({0, 1, 0.5}), on_map({0, 0.5, 1}), on_map({0, 0, 0.5})},
               {.stroke = ink::kAxis, .fill = "", .width = 1.5, .dashed = true}, true);
    const std::pair<Point, Point> parts[] = {{{0, 1, 0}, {0, 0.5, 0}},
                                             {{0, 0.5, 0}, {0, 0.5, 0.5}},
                                             {{0, 0.5, 0.5}, {0, 0.5, 1}},
                                             {{0, 0.5, 1}, {0, 1, 1}}};
    std::vector<std::pair<std::vector<Spot>, std::vector<Vec3d>>> rows;
    for (const auto& [from, to] : parts) {
        const auto directions = directions_along<Map>(from, to, kCount);
        for (const Vec3d& d : directions) s.ray(s.at(0, 0), s.towards(d, 1.47), d, 1.3);
        std::vector<Spot> edges;
        for (int k = 0; k <= kCount; ++k) {
            const double x = static_cast<double>(k) / kCount;
            edges.push_back(s.towards(on_surface(Map::direction(
                Point{0, from.s + (to.s - from.s) * x, from.t + (to.t - from.t) * x}))));
        }
        s.texels(edges, directions, 14);
        s.texels(edges_along(on_map(from), on_map(to), kCount), directions);
    }
    s.svg.circle(s.at(0, 0), 5, {.stroke = "", .fill = ink::kText});
    s.wheel(s.at(0, 0), 152 * 1.52, 14);
    s.svg.text(on_map({0, 0.5, -0.05}), "the map", 18, ink::kText, Anchor::middle);
    s.svg.text(on_map({0, 0.54, 0.515}), "+z", 18, ink::kText);
    s.svg.text(on_map({0, 1.03, 0.015}), "-z", 18, ink::kText);
    s.svg.text(on_map({0, 1.03, 1.015}), "-z", 18, ink::kText);
}

std::string draw(Octahedral, const ProjectionFacts& facts) {
    Section s(kSide, {370, 390}, 152);
    s.head("Octahedral map",
           {"the sphere projected on an octahedron, whose back is folded out into "
            "the corners of a square"});
    draw_folded<Octahedral>(s, [](const Vec3d& d) { return d / (std::abs(d.y) + std::abs(d.z)); });
    s.foot(facts);
    return s.svg.str();
}

std::string draw(EqualAreaOctahedral, const ProjectionFacts& facts) {
    Section s(kSide, {370, 390}, 152);
    s.head("Equal-area octahedral map",
           {"folded like an octahedron, with |z| = 1 - r²: every texel has the same solid angle"});
    draw_folded<EqualAreaOctahedral>(s, [](const Vec3d& d) { return d; });
    s.foot(facts);
    return s.svg.str();
}

}  // namespace

std::string projection_plot(Projection projection, const ProjectionFacts& facts) {
    return visit(projection, [&](auto map) { return draw(map, facts); });
}

}  // namespace mirrorball::cli
