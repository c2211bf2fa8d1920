// Sphere map: the picture of a small, perfect mirror ball, seen from +z by an orthographic camera
// that looks along -z. OpenGL's GL_SPHERE_MAP; the survey's Eq. 1 and 2; a photograph of a mirror
// ball.
//
//     (x, y) = (r_x, r_y) / m,  m = sqrt(2 (r_z + 1))     on the unit disc, x right and y up
//     r = 2 h_z h - (0, 0, 1),  h = (x, y, sqrt(1 - x^2 - y^2)) the ball's normal
//     dw = 4 dx dy                                        equal-area
//
// The centre shows what is behind the camera, +z. The whole rim is the one direction -z; there
// texels are stretched without bound, though none is larger than another.
#pragma once

#include <cmath>

#include <mirrorball/projections/disc.h>

namespace mirrorball {

struct SphereMap {
    static constexpr const char* name = "sphere";
    static constexpr int face_count = 1;
    static constexpr int aspect = 1;
    static constexpr bool fills_square = false;
    static constexpr bool three_at_corners = false;
    static constexpr int seam_count = 0;
    static constexpr int pole_count = 1;  // the rim

    /// The direction -z, which is all of the rim, goes to the rim's rightmost point.
    template <class T>
    static FacePoint<T> project(const Vec3<T>& d) {
        const T planar2 = d.x * d.x + d.y * d.y, length = std::sqrt(planar2 + d.z * d.z);
        // 1 / m, with 1 + z as (x^2 + y^2) / (1 - z) where it would cancel
        if (d.z >= 0) {
            const T scale = 1 / std::sqrt(2 * length * (length + d.z));
            return detail::from_disc(0, d.x * scale, d.y * scale);
        }
        if (planar2 == 0) return detail::from_disc(0, T(1), T(0));
        const T scale = std::sqrt((length - d.z) / (2 * length * planar2));
        return detail::from_disc(0, d.x * scale, d.y * scale);
    }

    template <class T>
    static Vec3<T> direction(const FacePoint<T>& p) {
        const auto [x, y] = detail::to_disc(detail::wrap_through_rim(p));
        const T q = x * x + y * y, h_z = std::sqrt(std::fmax(T(0), 1 - q));
        return {2 * h_z * x, 2 * h_z * y, 1 - 2 * q};
    }

    template <class T>
    static Tangents<T> tangents(const FacePoint<T>& p, const Vec3<T>& /*d*/) {
        const auto [x, y] = detail::to_disc(p);
        // on the rim the derivative along the radius is infinite; the bound keeps it a number
        const T h_z = std::sqrt(std::fmax(T(1e-12), 1 - x * x - y * y));
        const Vec3<T> dx(2 * h_z - 2 * x * x / h_z, -2 * x * y / h_z, -4 * x);
        const Vec3<T> dy(-2 * x * y / h_z, 2 * h_z - 2 * y * y / h_z, -4 * y);
        return {dx * T(2), dy * T(-2)};
    }

    static double density(const FacePoint<double>& p) { return covers(p) ? 16 : 0; }

    template <class T>
    static bool covers(const FacePoint<T>& p) {
        return detail::in_disc(p);
    }
    template <class T>
    static FacePoint<T> wrap(const FacePoint<T>& p) {
        return detail::wrap_through_rim(p);
    }

    static double solid_angle(int /*face*/, const FaceRect& r) {
        return detail::disc_solid_angle<SphereMap>(r);
    }

    // W(q) = 2 q; see disc.h
    static constexpr double rim = 2;
    static double edge_integral(double p, double u0, double u1) { return 2 * p * (u1 - u0); }
};

}  // namespace mirrorball
