// Ear clipping: Meisters 1975, "Polygons Have Ears". Cutting off an ear changes only whether its
// two neighbours are ears, so the work is corners times reflex corners.
#include "triangulate.h"

#include <algorithm>
#include <cmath>

namespace mirrorball::detail {
namespace {

struct Point {
    double x, y;
};

// Twice the signed area.
double area(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The polygon seen along its normal (Newell's sum of cross products), counter-clockwise. Dropping
// the longest axis of the normal shears what is left, which changes no side of any line.
std::vector<Point> flattened(std::span<const Vec3f> corners) {
    Vec3d normal(0);
    const Vec3d origin(corners[0]);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        normal += (Vec3d(corners[i]) - origin).cross(Vec3d(corners[i + 1]) - origin);

    int dropped = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(normal[i]) > std::abs(normal[dropped])) dropped = i;
    int x = (dropped + 1) % 3, y = (dropped + 2) % 3;
    if (normal[dropped] < 0) std::swap(x, y);

    std::vector<Point> points;
    for (const Vec3f& corner : corners) points.push_back({corner[x], corner[y]});
    return points;
}

// A ring of the corners that are not cut off yet.
class Ring {
  public:
    explicit Ring(const std::vector<Point>& points) : points_(points) {
        const auto count = static_cast<std::uint32_t>(points.size());
        for (std::uint32_t i = 0; i < count; ++i) {
            before_.push_back((i + count - 1) % count);
            after_.push_back((i + 1) % count);
            if (!is_convex(i)) reflex_.push_back(i);
        }
    }

    [[nodiscard]] bool has_reflex() const { return !reflex_.empty(); }
    [[nodiscard]] std::uint32_t before(std::uint32_t i) const { return before_[i]; }
    [[nodiscard]] std::uint32_t after(std::uint32_t i) const { return after_[i]; }

    [[nodiscard]] bool is_ear(std::uint32_t i) const {
        if (!is_convex(i)) return false;
        const Point &a = points_[before_[i]], &b = points_[i], &c = points_[after_[i]];
        return std::none_of(reflex_.begin(), reflex_.end(), [&](std::uint32_t other) {
            if (other == i || other == before_[i] || other == after_[i]) return false;
            const Point& p = points_[other];
            return area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0;
        });
    }

    void cut_off(std::uint32_t i) {
        after_[before_[i]] = after_[i];
        before_[after_[i]] = before_[i];
        std::erase_if(reflex_, [&](std::uint32_t other) { return other == i || is_convex(other); });
    }

  private:
    [[nodiscard]] bool is_convex(std::uint32_t i) const {
        return area(points_[before_[i]], points_[i], points_[after_[i]]) > 0;
    }

    const std::vector<Point>& points_;
    std::vector<std::uint32_t> before_, after_, reflex_;
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Vec3f> corners) {
    const auto count = static_cast<std::uint32_t>(corners.size());
    std::vector<std::array<std::uint32_t, 3>> triangles;
    if (count == 3) return {{0, 1, 2}};

    const std::vector<Point> points = flattened(corners);
    Ring ring(points);
    if (!ring.has_reflex()) {
        for (std::uint32_t i = 2; i < count; ++i) triangles.push_back({0, i - 1, i});
        return triangles;
    }
    if (count > kMostConcaveCorners) return {};

    std::vector<bool> ear(count);
    for (std::uint32_t i = 0; i < count; ++i) ear[i] = ring.is_ear(i);

    std::uint32_t at = 0;
    for (std::uint32_t left = count; left > 3; --left) {
        // A polygon that crosses itself may have no ear; then whatever comes next is cut off.
        for (std::uint32_t seen = 0; seen < left && !ear[at]; ++seen) at = ring.after(at);
        const std::uint32_t before = ring.before(at), after = ring.after(at);
        triangles.push_back({before, at, after});
        ring.cut_off(at);
        ear[before] = ring.is_ear(before);
        ear[after] = ring.is_ear(after);
        at = after;
    }
    triangles.push_back({ring.before(at), at, ring.after(at)});
    return triangles;
}

}  // namespace mirrorball::detail
