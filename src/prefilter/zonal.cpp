#include <mirrorball/zonal.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include <mirrorball/vector.h>

#include "prefilter/gauss_legendre.h"
#include "prefilter/legendre.h"
#include "prefilter/lobe_kernel.h"
#include "prefilter/zonal_quadrature.h"

namespace mirrorball {
namespace detail {
namespace {

// A panel of 32 points takes 20 radians of the fastest polynomial on either side of its centre, one
// of 16 points 4, of 8 points 0.7, each to 1e-15.
constexpr double kPhasePerPanel = 40;

int point_count(double phase, int least) {
    const int count = phase < 1.4 ? 8 : phase < 8 ? 16 : 32;
    return std::max(count, least);
}

// The panels of a kernel that is smooth on [0, end] but for what happens on the scale `near` at 0
// and `far` at the end, toward which they shrink by halves.
std::vector<double> graded_edges(double end, double near, double far, double widest) {
    std::vector<double> edges{0};
    for (double at = 0; at < end;) {
        const double left = end - at;
        double width = std::min({widest, std::max(near, at), std::max(far, left / 2)});
        if (width > 0.9 * left) width = left;
        at = width == left ? end : at + width;
        edges.push_back(at);
    }
    return edges;
}

std::vector<double> table_edges(const LobeTable& table, double widest) {
    std::vector<double> edges{0};
    for (const double angle : table.angles) {
        if (angle == 0) continue;
        const double start = edges.back();
        const int count = static_cast<int>(std::ceil((angle - start) / widest));
        for (int i = 1; i < count; ++i) edges.push_back(start + (angle - start) * i / count);
        edges.push_back(angle);
    }
    return edges;
}

std::vector<double> panel_edges(const Lobe& lobe, double widest) {
    const double parameter = lobe.parameter, horizon = kPi / 2;
    switch (lobe.kind) {
        case Lobe::Kind::phong:
        case Lobe::Kind::blinn_phong: {
            // next to a Gaussian of this deviation, nothing after 10 of them
            const double exponent = lobe.kind == Lobe::Kind::phong ? 4 * parameter : parameter;
            const double deviation = 2 / std::sqrt(exponent + 1);
            return graded_edges(std::min(horizon, 10 * deviation), 2 * deviation, horizon,
                                std::min(widest, 4 * deviation));
        }
        case Lobe::Kind::ggx:
            // poles at theta = +-2 i atanh(alpha)
            return graded_edges(horizon, 2 * parameter * parameter, horizon, widest);
        case Lobe::Kind::charlie:
            // a power of theta at the axis, e^(-q t) t at the horizon with q = 1 / 2 alpha
            return graded_edges(horizon, 1e-5, 2 * parameter * parameter, widest);
        case Lobe::Kind::tabulated:
            return table_edges(*lobe.table, widest);
        default:
            return graded_edges(horizon, horizon, horizon, widest);
    }
}

}  // namespace

ZonalQuadrature::ZonalQuadrature(const Lobe& lobe, int band_count) {
    const LobeKernel kernel(lobe);
    const double widest = kPhasePerPanel / band_count;
    const std::vector<double> edges = panel_edges(lobe, widest);
    const int least = lobe.kind == Lobe::Kind::tabulated ? 8 : 16;
    for (std::size_t i = 1; i < edges.size(); ++i) {
        const double centre = (edges[i - 1] + edges[i]) / 2, half = (edges[i] - edges[i - 1]) / 2;
        for (const auto& [x, weight] : gauss_legendre(point_count(2 * half * band_count, least))) {
            const double angle = centre + half * x, sine = std::sin(angle / 2);
            const double value = kernel.at(sine * sine);
            if (value == 0) continue;
            Nodes& side = angle <= kPi / 2 ? front : back;
            const double nearest = angle <= kPi / 2 ? sine : std::cos(angle / 2);
            side.x.push_back(2 * nearest * nearest);
            side.weight.push_back(2 * kPi * std::sin(angle) * half * weight);
            side.value.push_back(value);
        }
    }
}

namespace {

std::vector<double> products(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> c(a.size());
    std::transform(a.begin(), a.end(), b.begin(), c.begin(), std::multiplies<>());
    return c;
}

}  // namespace

std::vector<double> ZonalQuadrature::coefficients(int band_count) const {
    std::vector<double> lambda(band_count);
    legendre_sums(front.x, products(front.weight, front.value), lambda);
    if (back.x.empty()) return lambda;
    std::vector<double> more(band_count);
    legendre_sums(back.x, products(back.weight, back.value), more);
    for (int l = 0; l < band_count; ++l) lambda[l] += l % 2 == 0 ? more[l] : -more[l];
    return lambda;
}

double ZonalQuadrature::square() const {
    double sum = 0;
    for (const Nodes* side : {&front, &back})
        for (std::size_t i = 0; i < side->x.size(); ++i)
            sum += side->weight[i] * side->value[i] * side->value[i];
    return sum;
}

}  // namespace detail

namespace {

using detail::LobeKernel;
using detail::ZonalQuadrature;

// pi, 2 pi / 3, then 2 pi (-1)^(l/2-1) / ((l+2)(l-1)) l! / (2^l (l/2)!^2) for even l; from l to
// l + 2 that is a factor of -(l-1) / (l+4).
std::vector<double> diffuse_coefficients(int band_count) {
    std::vector<double> lambda(band_count, 0.0);
    lambda[0] = kPi;
    if (band_count > 1) lambda[1] = 2 * kPi / 3;
    for (int l = 2; l < band_count; l += 2)
        lambda[l] = l == 2 ? kPi / 4 : lambda[l - 2] * -(l - 3.0) / (l + 2.0);
    return lambda;
}

// A product of factors below 1 in magnitude: every step adds one rounding, and nothing cancels.
std::vector<double> phong_coefficients(double exponent, int band_count) {
    std::vector<double> lambda(band_count);
    lambda[0] = 1;
    if (band_count > 1) lambda[1] = (exponent + 1) / (exponent + 2);
    for (int l = 2; l < band_count; ++l)
        lambda[l] = lambda[l - 2] * (exponent + 2 - l) / (exponent + l + 1);
    return lambda;
}

}  // namespace

std::vector<double> zonal_coefficients(const Lobe& lobe, int band_count) {
    assert(!lobe.is_delta() && band_count >= 1 && band_count <= kLargestBandCount);
    if (lobe.kind == Lobe::Kind::diffuse) return diffuse_coefficients(band_count);
    if (lobe.kind == Lobe::Kind::phong) return phong_coefficients(lobe.parameter, band_count);
    return ZonalQuadrature(lobe, band_count).coefficients(band_count);
}

std::vector<double> window_coefficients(Window window, int band_count) {
    assert(band_count >= 1);
    std::vector<double> factors(band_count, 1.0);
    for (int l = 1; l < band_count; ++l) {
        const double phase = kPi * l / band_count;
        if (window == Window::hanning) factors[l] = (1 + std::cos(phase)) / 2;
        if (window == Window::lanczos) factors[l] = std::sin(phase) / phase;
    }
    return factors;
}

}  // namespace mirrorball
