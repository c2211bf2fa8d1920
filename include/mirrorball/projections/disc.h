// Exact solid angles for the maps that live in a disc: sphere map, angular map, paraboloid.
//
// All three are round: the solid angle inside radius rho and a wedge dphi is W(rho^2) dphi. By
// Green's theorem the solid angle of any region is the integral of W dphi around it; where the
// boundary runs outside the unit disc, the wedge it sweeps ends at the rim, so W(1) takes W's
// place:
//
//     solid angle of (rectangle and disc) = closed integral of W(min(q, 1)) dphi,  q = x^2 + y^2
//
// Along a straight edge at distance p from the centre, at position u, q = p^2 + u^2 and
// dphi = p du / q. A map gives W(1) and the integral of W(q) p / q du over a part of an edge inside
// the disc; for two of the three that is a closed form.
#pragma once

#include <algorithm>
#include <cmath>

#include <mirrorball/projections/face_point.h>

namespace mirrorball::detail {

template <class T>
struct DiscPoint {
    T x, y;
};

// The disc's x runs to the right and y up; the face's t runs down.
template <class T>
DiscPoint<T> to_disc(const FacePoint<T>& p) {
    return {2 * p.s - 1, 1 - 2 * p.t};
}
template <class T>
FacePoint<T> from_disc(int face, T x, T y) {
    return {face, (1 + x) / 2, (1 - y) / 2};
}

template <class T>
bool in_disc(const FacePoint<T>& p) {
    const auto [x, y] = to_disc(p);
    return x * x + y * y <= 1;
}

/// For maps whose rim is one direction: whoever walks out over the rim comes in on the other side.
template <class T>
FacePoint<T> wrap_through_rim(const FacePoint<T>& p) {
    const auto [x, y] = to_disc(p);
    const T rho = std::sqrt(x * x + y * y);
    if (rho <= 1) return p;
    const T scale = -(2 - rho) / rho;
    return from_disc(p.face, x * scale, y * scale);
}

// The integral of W dphi along the edge at signed distance p, from u0 to u1.
template <class Map>
double disc_edge(double p, double u0, double u1) {
    if (p == 0) return 0;
    const double half_chord = std::abs(p) < 1 ? std::sqrt(1 - p * p) : 0;
    const double in0 = std::clamp(u0, -half_chord, half_chord);
    const double in1 = std::clamp(u1, -half_chord, half_chord);
    const auto angle = [p](double from, double to) {
        return std::atan(to / p) - std::atan(from / p);
    };
    const double inside = in0 != in1 ? Map::edge_integral(p, in0, in1) : 0;
    return inside + Map::rim * (angle(u0, in0) + angle(in1, u1));
}

template <class Map>
double disc_solid_angle(const FaceRect& r) {
    const double x0 = 2 * r.s0 - 1, x1 = 2 * r.s1 - 1, y0 = 1 - 2 * r.t1, y1 = 1 - 2 * r.t0;
    // wholly outside it is 0 and not a sum's rounding: that is how an unused texel is known
    const double nearest_x = std::clamp(0.0, x0, x1), nearest_y = std::clamp(0.0, y0, y1);
    if (nearest_x * nearest_x + nearest_y * nearest_y >= 1) return 0;
    // counter-clockwise; distances are positive where the centre lies to the left of the edge
    const double sum = disc_edge<Map>(-y0, x0, x1) + disc_edge<Map>(x1, y0, y1) +
                       disc_edge<Map>(y1, -x1, -x0) + disc_edge<Map>(-x0, -y1, -y0);
    return std::max(0.0, sum);
}

}  // namespace mirrorball::detail
