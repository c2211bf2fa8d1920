// The integrals behind DFG tables, by Gauss-Legendre quadrature over half vectors.
//
// The view is at c = n.v, s = sqrt(1 - c^2); h at theta from the normal and phi from the plane of
// view; l is v mirrored about h, so that dl = 4 (v.h) dh and
//
//     v.h = c cos(theta) + s sin(theta) cos(phi),   n.l = c cos(2 theta) + s sin(2 theta) cos(phi)
//
// The light is above the horizon for |phi| < phi_max(theta): all around for theta < theta_a =
// (pi/2 - theta_v)/2, nowhere for theta > theta_b = (pi/2 + theta_v)/2, and where n.l = 0 between
// them. With these bounds the integrand has no step. The singularities that are left sit at ends of
// intervals, where nodes are drawn together:
//
//   - towards phi_max n.l goes to 0, and G bends the more sharply the more grazing the view:
//     phi = phi_max (1 - y^2);
//   - towards theta_a from below the integral over phi bends likewise: 1 - (1 - y)^3;
//   - beyond theta_a and before theta_b it changes as the power 3/2 of the distance: a step that is
//     flat at both ends, 10 y^3 - 15 y^4 + 6 y^5.
//
// With 16 points in phi, 16 and 32 in theta, A and B are within 2e-6 of what 192 and 192 give, for
// every roughness and n.v >= 1e-4, Charlie within 1e-6 of itself (docs/theory/dfg.md).
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <mirrorball/dfg.h>
#include <mirrorball/error.h>

#include "core/parallel.h"
#include "prefilter/gauss_legendre.h"

namespace mirrorball {
namespace {

constexpr int kMostTexels = 4096;
constexpr double kLeastSheenRoughness = 0.01;

double power5(double x) {
    return x * x * x * x * x;
}

// Half vectors of one theta: all of them reflect the view to above the horizon, or some.
enum class Ring { whole, cut };

struct View {
    double c, s;  ///< cosine and sine to the normal

    explicit View(double n_dot_v) : c(n_dot_v), s(std::sqrt(1 - n_dot_v * n_dot_v)) {}

    [[nodiscard]] double theta_a() const { return std::asin(c) / 2; }
    [[nodiscard]] double theta_b() const { return kPi / 2 - theta_a(); }
    [[nodiscard]] double phi_max(double cos_theta, double sin_theta, Ring ring) const {
        if (ring == Ring::whole) return kPi;
        const double cos_2_theta = (cos_theta - sin_theta) * (cos_theta + sin_theta);
        const double sin_2_theta = 2 * cos_theta * sin_theta;
        return std::acos(std::clamp(-c * cos_2_theta / (s * sin_2_theta), -1.0, 1.0));
    }
};

// The integral over phi of add(n.l, v.h, weight), which adds up what it likes.
template <class Add>
void around(const View& view, double cos_theta, double sin_theta, double phi_max, Add&& add) {
    const double cos_2_theta = (cos_theta - sin_theta) * (cos_theta + sin_theta);
    const double sin_2_theta = 2 * cos_theta * sin_theta;
    for (const auto& [x, weight] : detail::gauss_legendre(16)) {
        const double y = (1 + x) / 2;
        const double cos_phi = std::cos(phi_max * (1 - y * y));
        const double n_dot_l = view.c * cos_2_theta + view.s * sin_2_theta * cos_phi;
        const double v_dot_h = view.c * cos_theta + view.s * sin_theta * cos_phi;
        // dphi = phi_max 2 y dy, dy = dx/2, both signs of phi; rounding may reach below 0 at the
        // end
        add(std::max(0.0, n_dot_l), v_dot_h, weight * 2 * phi_max * y);
    }
}

// The integral of f(x, weight) over [a, b], with nodes where rings of the kind need them.
template <class F>
void between(double a, double b, Ring ring, F&& f) {
    if (!(a < b)) return;
    for (const auto& [x, weight] : detail::gauss_legendre(ring == Ring::whole ? 16 : 32)) {
        const double y = (1 + x) / 2, z = 1 - y;
        if (ring == Ring::whole)
            f(a + (b - a) * (1 - z * z * z), weight / 2 * (b - a) * 3 * z * z);
        else
            f(a + (b - a) * y * y * y * (10 - 15 * y + 6 * y * y),
              weight / 2 * (b - a) * 30 * y * y * z * z);
    }
}

// Half vectors of GGX as tan(theta) = alpha tan(psi). D n.h dh = sin(2 psi) dpsi dphi / 2 pi, which
// is as smooth for a small alpha as for a large one, and v.h / n.h grows no faster than it falls:
//
//     E = 1/pi integral sin(psi) (v.h/n.h cos(psi)) (G / n.v) dphi dpsi
Dfg integrate_ggx(const View& view, double alpha) {
    const double spread_v = std::hypot(view.c, alpha * view.s);
    double albedo = 0, bias = 0;
    const auto add_rings = [&](double theta_from, double theta_to, Ring ring) {
        const auto psi_of = [&](double theta) {
            return std::atan2(std::sin(theta), alpha * std::cos(theta));
        };
        between(psi_of(theta_from), psi_of(theta_to), ring, [&](double psi, double psi_weight) {
            const double cos_psi = std::cos(psi), sin_psi = std::sin(psi);
            const double length = std::hypot(cos_psi, alpha * sin_psi);  // cos(psi) / n.h
            const double cos_theta = cos_psi / length, sin_theta = alpha * sin_psi / length;
            const double factor = psi_weight * sin_psi * length / kPi;
            around(view, cos_theta, sin_theta, view.phi_max(cos_theta, sin_theta, ring),
                   [&](double n_dot_l, double v_dot_h, double weight) {
                       const double spread_l =
                           std::sqrt(n_dot_l * n_dot_l * (1 - alpha * alpha) + alpha * alpha);
                       // G / n.v
                       const double shadowing =
                           2 * n_dot_l / (n_dot_l * spread_v + view.c * spread_l);
                       const double value = factor * weight * v_dot_h * shadowing;
                       albedo += value;
                       bias += value * power5(1 - v_dot_h);
                   });
        });
    };
    add_rings(0, view.theta_a(), Ring::whole);
    add_rings(view.theta_a(), view.theta_b(), Ring::cut);
    return {albedo - bias, bias};
}

// D (v.h) n.l / (n.l + n.v - n.l n.v) over half vectors. Their D = (2 + k) sin^k(theta) / 2 pi,
// k = 1/alpha, is largest at theta_b, and so narrow for a large k that what lies below e^-40 of
// that is left out.
double integrate_charlie(const View& view, double alpha) {
    const double k = 1 / alpha;
    const double theta_0 = std::asin(std::sin(view.theta_b()) * std::exp(-40 / k));
    double sum = 0;
    const auto add_rings = [&](double from, double to, Ring ring) {
        between(from, to, ring, [&](double theta, double theta_weight) {
            const double cos_theta = std::cos(theta), sin_theta = std::sin(theta);
            const double d = (2 + k) * std::pow(sin_theta, k) / (2 * kPi);
            const double factor = theta_weight * d * sin_theta;
            around(view, cos_theta, sin_theta, view.phi_max(cos_theta, sin_theta, ring),
                   [&](double n_dot_l, double v_dot_h, double weight) {
                       sum += factor * weight * v_dot_h * n_dot_l /
                              (n_dot_l + view.c - n_dot_l * view.c);
                   });
        });
    };
    add_rings(theta_0, view.theta_a(), Ring::whole);
    add_rings(std::max(theta_0, view.theta_a()), view.theta_b(), Ring::cut);
    return sum;
}

}  // namespace

Dfg ggx_dfg(double n_dot_v, double roughness) {
    const double alpha = roughness * roughness;
    if (alpha == 0) {
        const double fresnel = power5(1 - n_dot_v);
        return {1 - fresnel, fresnel};
    }
    return integrate_ggx(View(n_dot_v), alpha);
}

double charlie_albedo(double n_dot_v, double roughness) {
    const double least = std::max(roughness, kLeastSheenRoughness);
    return integrate_charlie(View(n_dot_v), least * least);
}

// E rises steeply towards grazing angles: nodes at the squares.
double ggx_mean_albedo(double roughness) {
    double sum = 0;
    for (const auto& [x, weight] : detail::gauss_legendre(32)) {
        const double y = (1 + x) / 2, cosine = y * y;
        sum += weight / 2 * 2 * y * 2 * cosine * ggx_dfg(cosine, roughness).albedo();
    }
    return sum;
}

Vec3d energy_compensation(const Vec3d& f0, double albedo) {
    return Vec3d(1) + f0 * (1 / albedo - 1);
}

// Of the light 1 - E that is not gone after one bounce, each further bounce reflects F_avg,
// Schlick's mean F0 + (1 - F0)/21, and of that E leaves.
MultipleScattering multiple_scattering(const Dfg& dfg, const Vec3d& f0) {
    MultipleScattering result;
    result.single = dfg.reflectance(f0);
    const double missing = 1 - dfg.albedo();
    for (int c = 0; c < 3; ++c) {
        const double mean = f0[c] + (1 - f0[c]) / 21;
        result.multiple[c] = result.single[c] * mean * missing / (1 - missing * mean);
        result.diffuse[c] = 1 - result.single[c] - result.multiple[c];
    }
    return result;
}

DfgTable::DfgTable(int width, int height, const Progress& progress) {
    if (std::min(width, height) < 2 || std::max(width, height) > kMostTexels)
        throw Error(Errc::usage, fmt::format("a DFG table of {} x {} texels; expected 2 to {} each",
                                             width, height, kMostTexels));
    image_ = Image(width, height, 3);
    detail::parallel_for(
        height,
        [&](std::int64_t row) {
            const int y = static_cast<int>(row);
            const double roughness = (y + 0.5) / height;
            for (int x = 0; x < width; ++x) {
                const double n_dot_v = (x + 0.5) / width;
                const Dfg dfg = ggx_dfg(n_dot_v, roughness);
                image_.set_rgb(
                    x, y, Vec3f(Vec3d(dfg.scale, dfg.bias, charlie_albedo(n_dot_v, roughness))));
            }
        },
        progress);
}

Vec3f DfgTable::look_up(double n_dot_v, double roughness) const {
    const double x = std::clamp(n_dot_v * image_.width() - 0.5, 0.0, image_.width() - 1.0);
    const double y = std::clamp(roughness * image_.height() - 0.5, 0.0, image_.height() - 1.0);
    const int x0 = std::min(static_cast<int>(x), image_.width() - 2);
    const int y0 = std::min(static_cast<int>(y), image_.height() - 2);
    const auto u = static_cast<float>(x - x0), v = static_cast<float>(y - y0);
    return (image_.rgb(x0, y0) * (1 - u) + image_.rgb(x0 + 1, y0) * u) * (1 - v) +
           (image_.rgb(x0, y0 + 1) * (1 - u) + image_.rgb(x0 + 1, y0 + 1) * u) * v;
}

Dfg DfgTable::ggx(double n_dot_v, double roughness) const {
    const Vec3f texel = look_up(n_dot_v, roughness);
    return {texel.x, texel.y};
}

double DfgTable::charlie(double n_dot_v, double roughness) const {
    return look_up(n_dot_v, roughness).z;
}

}  // namespace mirrorball
