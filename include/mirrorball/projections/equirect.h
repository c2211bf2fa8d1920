// Equirectangular: longitude along s, latitude along t. Blinn and Newell 1976.
//
//     s = 1/2 + atan2(x, -z) / 2 pi        the centre looks along -z, three quarters along +x
//     t = acos(y) / pi                     +y at the top
//     dw = 2 pi^2 sin(pi t) ds dt
#pragma once

#include <cmath>

#include <mirrorball/projections/arctan.h>
#include <mirrorball/projections/face_point.h>

namespace mirrorball {

struct Equirect {
    static constexpr const char* name = "equirect";
    static constexpr int face_count = 1;
    static constexpr int aspect = 2;
    static constexpr bool fills_square = true;
    static constexpr bool three_at_corners = false;
    static constexpr int seam_count = 1;  // the left edge meets the right one
    static constexpr int pole_count = 2;  // the top edge and the bottom edge

    template <class T>
    static FacePoint<T> project(const Vec3<T>& d) {
        // the polar angle keeps its precision at the poles, where acos(y) loses half the digits
        const double longitude = detail::arctan2(d.x, -d.z);
        const double polar = detail::arctan2(std::sqrt(d.x * d.x + d.z * d.z), d.y);
        return {0, T(0.5 + longitude * (0.5 / kPi)), T(polar * (1 / kPi))};
    }

    template <class T>
    static Vec3<T> direction(const FacePoint<T>& p) {
        const T longitude = T(2 * kPi) * (p.s - T(0.5)), polar = T(kPi) * p.t;
        const T sin_polar = std::sin(polar);
        return {sin_polar * std::sin(longitude), std::cos(polar), -sin_polar * std::cos(longitude)};
    }

    template <class T>
    static Tangents<T> tangents(const FacePoint<T>& /*p*/, const Vec3<T>& d) {
        constexpr T pi = T(kPi);
        const T sine = std::sqrt(d.x * d.x + d.z * d.z);  // of the polar angle
        // at a pole itself every meridian will do
        const T east = sine > 0 ? d.x / sine : T(0), south = sine > 0 ? d.z / sine : T(-1);
        return {Vec3<T>(-d.z, 0, d.x) * (2 * pi), Vec3<T>(d.y * east, -sine, d.y * south) * pi};
    }

    static double density(const FacePoint<double>& p) {
        return 2 * kPi * kPi * std::sin(kPi * p.t);
    }

    template <class T>
    static bool covers(const FacePoint<T>& p) {
        return p.s >= 0 && p.s <= 1 && p.t >= 0 && p.t <= 1;
    }

    /// Over a pole one comes down on the opposite meridian.
    template <class T>
    static FacePoint<T> wrap(FacePoint<T> p) {
        if (p.t < 0 || p.t > 1) {
            p.t = p.t < 0 ? -p.t : 2 - p.t;
            p.s += T(0.5);
        }
        p.s -= std::floor(p.s);
        return p;
    }

    static double solid_angle(int /*face*/, const FaceRect& r) {
        // 2 pi (cos a - cos b), with the difference as a product that does not cancel
        const double a = kPi * r.t0, b = kPi * r.t1;
        return 2 * kPi * (r.s1 - r.s0) * 2 * std::sin((a + b) / 2) * std::sin((b - a) / 2);
    }
};

}  // namespace mirrorball
