// Equal-area octahedral map: folded like the octahedral one, with every texel the same solid angle.
// Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD"; pbrt-v4's maps.
//
// In the quadrant x, y >= 0 of [-1,1]^2, with r = x + y inside the diagonal (z >= 0) and 2 - x - y
// outside it:
//
//     |z| = 1 - r^2,   phi = pi/4 ((y - x) / r + 1)       azimuth from +x towards +y
//     dw = pi dx dy
#pragma once

#include <algorithm>
#include <cmath>

#include <mirrorball/projections/arctan.h>
#include <mirrorball/projections/octahedral.h>

namespace mirrorball {

struct EqualAreaOctahedral {
    static constexpr const char* name = "equal-area-octahedral";
    static constexpr int face_count = 1;
    static constexpr int aspect = 1;
    static constexpr bool fills_square = true;
    static constexpr bool three_at_corners = false;
    static constexpr int seam_count = 4;
    static constexpr int pole_count = 0;

    template <class T>
    static FacePoint<T> project(const Vec3<T>& d) {
        const T ax = std::abs(d.x), ay = std::abs(d.y), az = std::abs(d.z);
        const T planar2 = ax * ax + ay * ay, length = std::sqrt(planar2 + az * az);
        // r = sqrt(1 - |z|), with 1 - |z| as (x^2 + y^2) / (1 + |z|), which does not cancel
        const T r = std::sqrt(planar2 / (length * (length + az)));
        const T turn = planar2 > 0 ? T(detail::arctan2(ay, ax) * (2 / kPi)) : T(0.5);
        T y = r * turn, x = r - y;
        if (d.z < 0) {
            const T inner_x = x;
            x = 1 - y, y = 1 - inner_x;
        }
        return detail::from_disc(0, std::copysign(x, d.x), std::copysign(y, d.y));
    }

    template <class T>
    static Vec3<T> direction(const FacePoint<T>& p) {
        const auto [x, y] = detail::to_disc(detail::wrap_folded(p));
        const Polar<T> polar = to_polar(std::abs(x), std::abs(y));
        const T planar = polar.r * std::sqrt(2 - polar.r * polar.r);
        return {std::copysign(planar * std::cos(polar.phi), x),
                std::copysign(planar * std::sin(polar.phi), y),
                polar.upper ? 1 - polar.r * polar.r : polar.r * polar.r - 1};
    }

    template <class T>
    static Tangents<T> tangents(const FacePoint<T>& p, const Vec3<T>& /*d*/) {
        const auto [x, y] = detail::to_disc(p);
        const T ax = std::abs(x), ay = std::abs(y);
        const Polar<T> polar = to_polar(ax, ay);
        const T r = std::fmax(polar.r, T(1e-9)), root = std::sqrt(2 - r * r);
        const T planar = r * root, planar_slope = (2 - 2 * r * r) / root;
        const T cos_phi = std::cos(polar.phi), sin_phi = std::sin(polar.phi);
        const T side = polar.upper ? T(1) : T(-1);
        const T turn_x = -T(kPi) / 2 * (polar.upper ? ay : 1 - ay) / (r * r);
        const T turn_y = T(kPi) / 2 * (polar.upper ? ax : 1 - ax) / (r * r);
        const T sx = std::copysign(T(1), x), sy = std::copysign(T(1), y);
        // r grows with x and y inside the diagonal and shrinks outside it; z is side (1 - r^2)
        const auto along = [&](T turn) {
            return Vec3<T>(sx * (side * planar_slope * cos_phi - planar * sin_phi * turn),
                           sy * (side * planar_slope * sin_phi + planar * cos_phi * turn), -2 * r);
        };
        return {along(turn_x) * (2 * sx), along(turn_y) * (-2 * sy)};
    }

    static double density(const FacePoint<double>& /*p*/) { return 4 * kPi; }

    template <class T>
    static bool covers(const FacePoint<T>& p) {
        return p.s >= 0 && p.s <= 1 && p.t >= 0 && p.t <= 1;
    }
    template <class T>
    static FacePoint<T> wrap(const FacePoint<T>& p) {
        return detail::wrap_folded(p);
    }

    static double solid_angle(int /*face*/, const FaceRect& r) {
        return 4 * kPi * (r.s1 - r.s0) * (r.t1 - r.t0);
    }

  private:
    template <class T>
    struct Polar {
        T r, phi;
        bool upper;
    };

    // \pre 0 <= x, y <= 1
    template <class T>
    static Polar<T> to_polar(T x, T y) {
        const bool upper = x + y <= 1;
        const T r = upper ? x + y : (1 - x) + (1 - y);
        const T turn = r > 0 ? (y - x) / r : T(0);
        return {r, T(kPi / 4) * (turn + 1), upper};
    }
};

}  // namespace mirrorball
