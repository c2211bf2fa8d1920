// Angular map, the "light probe" format: the distance from the centre is the angle from -z.
// Debevec.
//
//     rho = acos(-z) / pi  along (x, y)                   on the unit disc, x right and y up
//     dw = pi sin(pi rho) / rho dx dy
//
// The centre looks along -z; the whole rim is the one direction +z. (Axes with z negated give the
// other reading of Debevec's page, centred on +z: preset "angular+z".)
#pragma once

#include <cmath>

#include <mirrorball/projections/arctan.h>
#include <mirrorball/projections/disc.h>

namespace mirrorball {

struct AngularMap {
    static constexpr const char* name = "angular";
    static constexpr int face_count = 1;
    static constexpr int aspect = 1;
    static constexpr bool fills_square = false;
    static constexpr bool three_at_corners = false;
    static constexpr int seam_count = 0;
    static constexpr int pole_count = 1;  // the rim

    /// The direction +z, which is all of the rim, goes to the rim's rightmost point.
    template <class T>
    static FacePoint<T> project(const Vec3<T>& d) {
        const T planar = std::sqrt(d.x * d.x + d.y * d.y);
        if (planar == 0) return detail::from_disc(0, d.z > 0 ? T(1) : T(0), T(0));
        const T scale = T(detail::arctan2(planar, -d.z)) / (T(kPi) * planar);
        return detail::from_disc(0, d.x * scale, d.y * scale);
    }

    template <class T>
    static Vec3<T> direction(const FacePoint<T>& p) {
        const auto [x, y] = detail::to_disc(p);
        const T rho = std::sqrt(x * x + y * y), g = sine_over(rho);
        return {g * x, g * y, -std::cos(T(kPi) * rho)};
    }

    template <class T>
    static Tangents<T> tangents(const FacePoint<T>& p, const Vec3<T>& /*d*/) {
        constexpr T pi = T(kPi);
        const auto [x, y] = detail::to_disc(p);
        const T rho = std::sqrt(x * x + y * y), g = sine_over(rho);
        // g' / rho for g = sin(pi rho) / rho, by its series where it would cancel
        const T slope = rho < T(1e-2) ? pi * pi * pi * (T(-1) / 3 + pi * pi * rho * rho / 30)
                                      : (pi * std::cos(pi * rho) - g) / (rho * rho);
        const Vec3<T> dx(g + slope * x * x, slope * x * y, pi * g * x);
        const Vec3<T> dy(slope * x * y, g + slope * y * y, pi * g * y);
        return {dx * T(2), dy * T(-2)};
    }

    static double density(const FacePoint<double>& p) {
        const auto [x, y] = detail::to_disc(p);
        const double rho = std::sqrt(x * x + y * y);
        return rho <= 1 ? 4 * kPi * sine_over(rho) : 0;
    }

    template <class T>
    static bool covers(const FacePoint<T>& p) {
        return detail::in_disc(p);
    }
    template <class T>
    static FacePoint<T> wrap(const FacePoint<T>& p) {
        return detail::wrap_through_rim(p);
    }

    static double solid_angle(int /*face*/, const FaceRect& r) {
        return detail::disc_solid_angle<AngularMap>(r);
    }

    // W(q) = 1 - cos(pi sqrt(q)); see disc.h. W(q) / q is entire in q, so Gauss-Legendre quadrature
    // with five nodes on panels of at most 1/8 reaches double precision.
    static constexpr double rim = 2;
    static double edge_integral(double p, double u0, double u1) {
        static constexpr double nodes[] = {0, 0.5384693101056830910, 0.9061798459386639928};
        static constexpr double weights[] = {0.5688888888888888889, 0.4786286704993664680,
                                             0.2369268850561890875};
        const auto f = [p](double u) {
            const double q = p * p + u * u, half = std::sin(kPi / 2 * std::sqrt(q));
            return q > 0 ? 2 * half * half / q : kPi * kPi / 2;
        };
        const int panel_count = 1 + static_cast<int>(std::abs(u1 - u0) * 8);
        const double h = (u1 - u0) / (2 * panel_count);
        double sum = 0;
        for (int i = 0; i < panel_count; ++i) {
            const double middle = u0 + (2 * i + 1) * h;
            sum += weights[0] * f(middle);
            for (int k = 1; k < 3; ++k)
                sum += weights[k] * (f(middle - h * nodes[k]) + f(middle + h * nodes[k]));
        }
        return sum * h * p;
    }

  private:
    // sin(pi rho) / rho
    template <class T>
    static T sine_over(T rho) {
        return rho < T(1e-6) ? T(kPi) : std::sin(T(kPi) * rho) / rho;
    }
};

}  // namespace mirrorball
