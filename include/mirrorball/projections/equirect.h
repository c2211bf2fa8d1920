// Equirectangular: longitude along s, latitude along t. Blinn and Newell 1976.
//
//     s = 1/2 + atan2(x, -z) / 2 pi        the centre looks along -z, three quarters along +x
//     t = acos(y) / pi                     +y at the top
//     dw = 2 pi^2 sin(pi t) ds dt
#pragma once

#include <algorithm>
#include <cmath>

#include <mirrorball/projections/face_point.h>

namespace mirrorball {

struct Equirect {
    static constexpr const char* name = "equirect";
    static constexpr int face_count = 1;
    static constexpr int aspect = 2;
    static constexpr int seam_count = 1;  // the left edge meets the right one
    static constexpr int pole_count = 2;  // the top edge and the bottom edge

    template <class T>
    static FacePoint<T> project(const Vec3<T>& d) {
        constexpr T pi = T(kPi);
        // atan2 keeps its precision at the poles, where acos(y) loses half the digits
        return {0, T(0.5) + std::atan2(d.x, -d.z) / (2 * pi),
                std::atan2(std::sqrt(d.x * d.x + d.z * d.z), d.y) / pi};
    }

    template <class T>
    static Vec3<T> direction(const FacePoint<T>& p) {
        const T longitude = T(2 * kPi) * (p.s - T(0.5)), polar = T(kPi) * p.t;
        const T sin_polar = std::sin(polar);
        return {sin_polar * std::sin(longitude), std::cos(polar), -sin_polar * std::cos(longitude)};
    }

    template <class T>
    static Tangents<T> tangents(const FacePoint<T>& p) {
        constexpr T pi = T(kPi);
        const T longitude = 2 * pi * (p.s - T(0.5)), polar = pi * p.t;
        const T sin_l = std::sin(longitude), cos_l = std::cos(longitude);
        const T sin_p = std::sin(polar), cos_p = std::cos(polar);
        return {Vec3<T>(cos_l, 0, sin_l) * (2 * pi * sin_p),
                Vec3<T>(cos_p * sin_l, -sin_p, -cos_p * cos_l) * pi};
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
