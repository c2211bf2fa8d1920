// Dual paraboloid: two pictures of half a sphere each, front (z >= 0) and back. Heidrich and Seidel
// 1998; the survey's Eq. 4 to 7.
//
//     (x, y) = (r_x, r_y) / (1 + |r_z|)                   on the unit disc, x right and y up
//     r = (2x, 2y, +-(1 - q)) / (1 + q),  q = x^2 + y^2
//     dw = 4 / (1 + q)^2 dx dy                            4 at the centre to 1 at the rim
//
// The back picture is not mirrored: x and y mean the same in both. (The survey's matrix gives it
// turned by 180 degrees; Layout::side_by_side_turned stores it so.) A picture goes on past its rim
// into the other half, by the same formula.
#pragma once

#include <cmath>

#include <mirrorball/projections/disc.h>

namespace mirrorball {

struct DualParaboloid {
    static constexpr const char* name = "dual-paraboloid";
    static constexpr int face_count = 2;
    static constexpr int aspect = 1;
    static constexpr bool fills_square = false;
    static constexpr bool three_at_corners = false;
    static constexpr int seam_count = 1;  // the two rims are one circle
    static constexpr int pole_count = 0;

    template <class T>
    static FacePoint<T> project(const Vec3<T>& d) {
        const T scale = 1 / (std::sqrt(d.dot(d)) + std::abs(d.z));
        return detail::from_disc(d.z >= 0 ? 0 : 1, d.x * scale, d.y * scale);
    }

    template <class T>
    static Vec3<T> direction(const FacePoint<T>& p) {
        const auto [x, y] = detail::to_disc(p);
        const T q = x * x + y * y, scale = 1 / (1 + q);
        return {2 * x * scale, 2 * y * scale, side<T>(p.face) * (1 - q) * scale};
    }

    template <class T>
    static Tangents<T> tangents(const FacePoint<T>& p, const Vec3<T>& /*d*/) {
        const auto [x, y] = detail::to_disc(p);
        const T q = x * x + y * y, scale = 2 / ((1 + q) * (1 + q)), z = side<T>(p.face);
        const Vec3<T> dx((1 + q - 2 * x * x) * scale, -2 * x * y * scale, -2 * x * scale * z);
        const Vec3<T> dy(-2 * x * y * scale, (1 + q - 2 * y * y) * scale, -2 * y * scale * z);
        return {dx * T(2), dy * T(-2)};
    }

    static double density(const FacePoint<double>& p) {
        const auto [x, y] = detail::to_disc(p);
        const double q = x * x + y * y;
        return q <= 1 ? 16 / ((1 + q) * (1 + q)) : 0;
    }

    template <class T>
    static bool covers(const FacePoint<T>& p) {
        return detail::in_disc(p);
    }

    template <class T>
    static FacePoint<T> wrap(const FacePoint<T>& p) {
        const auto [x, y] = detail::to_disc(p);
        const T q = x * x + y * y;
        return q <= 1 ? p : detail::from_disc(1 - p.face, x / q, y / q);
    }

    static double solid_angle(int /*face*/, const FaceRect& r) {
        return detail::disc_solid_angle<DualParaboloid>(r);
    }

    // W(q) = 2 q / (1 + q); see disc.h
    static constexpr double rim = 1;
    static double edge_integral(double p, double u0, double u1) {
        const double k = std::sqrt(1 + p * p);
        return 2 * p / k * (std::atan(u1 / k) - std::atan(u0 / k));
    }

  private:
    template <class T>
    static T side(int face) {
        return face == 0 ? T(1) : T(-1);
    }
};

}  // namespace mirrorball
