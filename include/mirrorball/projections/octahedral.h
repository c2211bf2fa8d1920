// Octahedral map: the sphere projected on an octahedron, whose lower half is folded out into the
// corners of a square. Praun and Hoppe 2003; Engelhardt and Dachsbacher 2008.
//
//     p = d / (|x| + |y| + |z|);  z >= 0: (p_x, p_y);  else ((1-|p_y|) sgn p_x, (1-|p_x|) sgn p_y)
//     on [-1,1]^2, x right and y up;  dw = 1 / |p|^3 dx dy
//
// The centre is +z, the four corners are -z: each edge of the picture meets itself, folded about
// its middle. Axes say where the fold axis z points: preset "fold-y" puts it up.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <mirrorball/projections/disc.h>

namespace mirrorball {

namespace detail {

/// Straight across an edge of a folded square one comes back in mirrored about the edge's middle.
template <class T>
FacePoint<T> wrap_folded(FacePoint<T> p) {
    if (p.s < 0 || p.s > 1) {
        p.s = p.s < 0 ? -p.s : 2 - p.s;
        p.t = 1 - p.t;
    }
    if (p.t < 0 || p.t > 1) {
        p.t = p.t < 0 ? -p.t : 2 - p.t;
        p.s = 1 - p.s;
    }
    return p;
}

}  // namespace detail

struct Octahedral {
    static constexpr const char* name = "octahedral";
    static constexpr int face_count = 1;
    static constexpr int aspect = 1;
    static constexpr bool fills_square = true;
    static constexpr bool three_at_corners = false;
    static constexpr int seam_count = 4;  // each edge with itself
    static constexpr int pole_count = 0;

    template <class T>
    static FacePoint<T> project(const Vec3<T>& d) {
        const T scale = 1 / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
        const T x = d.x * scale, y = d.y * scale;
        if (d.z >= 0) return detail::from_disc(0, x, y);
        return detail::from_disc(0, std::copysign(1 - std::abs(y), x),
                                 std::copysign(1 - std::abs(x), y));
    }

    template <class T>
    static Vec3<T> direction(const FacePoint<T>& p) {
        const auto [x, y] = detail::to_disc(detail::wrap_folded(p));
        const Vec3<T> d = on_octahedron(x, y);
        return d / std::sqrt(d.dot(d));
    }

    template <class T>
    static Tangents<T> tangents(const FacePoint<T>& p, const Vec3<T>& /*d*/) {
        const auto [x, y] = detail::to_disc(p);
        const Vec3<T> u = on_octahedron(x, y);
        const T sx = std::copysign(T(1), x), sy = std::copysign(T(1), y);
        const bool upper = u.z >= 0;
        const Vec3<T> dx = upper ? Vec3<T>(1, 0, -sx) : Vec3<T>(0, -sx * sy, -sx);
        const Vec3<T> dy = upper ? Vec3<T>(0, 1, -sy) : Vec3<T>(-sx * sy, 0, -sy);
        const T length2 = u.dot(u), length = std::sqrt(length2);
        return {(dx - u * (u.dot(dx) / length2)) * (2 / length),
                (dy - u * (u.dot(dy) / length2)) * (-2 / length)};
    }

    static double density(const FacePoint<double>& p) {
        const auto [x, y] = detail::to_disc(p);
        const Vec3d u = on_octahedron(x, y);
        const double length2 = u.dot(u);
        return 4 / (length2 * std::sqrt(length2));
    }

    template <class T>
    static bool covers(const FacePoint<T>& p) {
        return p.s >= 0 && p.s <= 1 && p.t >= 0 && p.t <= 1;
    }
    template <class T>
    static FacePoint<T> wrap(const FacePoint<T>& p) {
        return detail::wrap_folded(p);
    }

    /// On a face of the octahedron straight lines are great circles: the rectangle, cut along the
    /// folds, becomes spherical polygons. The four quadrants are alike, and so are the two sides of
    /// a quadrant's fold.
    static double solid_angle(int /*face*/, const FaceRect& r) {
        const double x0 = 2 * r.s0 - 1, x1 = 2 * r.s1 - 1, y0 = 2 * r.t0 - 1, y1 = 2 * r.t1 - 1;
        double sum = 0;
        for (const double sx : {-1.0, 1.0}) {
            for (const double sy : {-1.0, 1.0}) {
                const double a0 = std::max(0.0, std::min(sx * x0, sx * x1));
                const double a1 = std::max(sx * x0, sx * x1);
                const double b0 = std::max(0.0, std::min(sy * y0, sy * y1));
                const double b1 = std::max(sy * y0, sy * y1);
                if (a0 >= a1 || b0 >= b1) continue;
                // the outer triangle, folded in: (x, y) -> (1 - y, 1 - x)
                sum += inner_part(a0, b0, a1, b1) + inner_part(1 - b1, 1 - a1, 1 - b0, 1 - a0);
            }
        }
        return sum;
    }

  private:
    template <class T>
    static Vec3<T> on_octahedron(T x, T y) {
        const T z = 1 - std::abs(x) - std::abs(y);
        if (z >= 0) return {x, y, z};
        return {std::copysign(1 - std::abs(y), x), std::copysign(1 - std::abs(x), y), z};
    }

    // Solid angle of the part of [a0,a1] x [b0,b1] with a + b <= 1, in the quadrant a, b >= 0.
    static double inner_part(double a0, double b0, double a1, double b1) {
        const std::array<std::array<double, 2>, 4> corners = {
            {{a0, b0}, {a1, b0}, {a1, b1}, {a0, b1}}};
        std::array<Vec3d, 6> polygon;
        int count = 0;
        for (int i = 0; i < 4; ++i) {
            const auto [x, y] = corners[i];
            const auto [next_x, next_y] = corners[(i + 1) % 4];
            const double z = 1 - x - y, next_z = 1 - next_x - next_y;
            if (z >= 0) polygon[count++] = {x, y, z};
            if ((z > 0 && next_z < 0) || (z < 0 && next_z > 0)) {
                const double k = z / (z - next_z);
                polygon[count++] = {x + k * (next_x - x), y + k * (next_y - y), 0};
            }
        }
        double sum = 0;
        for (int i = 2; i < count; ++i) sum += triangle(polygon[0], polygon[i - 1], polygon[i]);
        return sum;
    }

    // Van Oosterom and Strackee 1983; the triple product from differences, which do not cancel.
    static double triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
        const double la = a.length(), lb = b.length(), lc = c.length();
        const double volume = a.dot((b - a).cross(c - a));
        const double sum = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        return 2 * std::atan2(volume, sum);
    }
};

}  // namespace mirrorball
