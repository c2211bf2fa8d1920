// How many bands a lobe needs, by rules: what the bands from L up hold, as a share of the whole,
// for each kind of lobe in a closed form that falls with L, and the least L where it is small
// enough. Derived in docs/theory/spectral-prefiltering.md; all shares here are of squares.
#include <mirrorball/zonal.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>

#include <mirrorball/vector.h>

#include "prefilter/lobe_kernel.h"
#include "prefilter/zonal_quadrature.h"

namespace mirrorball {
namespace {

// Up to here the tail that a crease leaves is carried, but no further.
constexpr double kCreaseCap = 128;
constexpr int kTableCap = 512;

// The largest smooth count that anyone may ask for: fits an int with room.
constexpr double kMost = 1e9;

double cube(double x) {
    return x * x * x;
}

// The sum of (2l+1) lambda_l^2 over all bands, by Parseval.
double whole(const Lobe& lobe) {
    return 4 * kPi * detail::ZonalQuadrature(lobe, 1).square();
}

// Where k's slope jumps by `jump` at the horizon, |lambda_l| goes toward jump sqrt(8 pi) l^-5/2 for
// every other l.
double crease_share(double jump, double whole, double bands) {
    return 8 * kPi * jump * jump / (3 * whole * cube(bands));
}

int least_count(const std::function<double(double)>& share, double tolerance) {
    double low = 0, high = 1;
    const double wanted = tolerance * tolerance;
    while (share(high) > wanted && high < kMost) high *= 2;
    while (high - low > 0.5) {
        const double middle = (low + high) / 2;
        (share(middle) > wanted ? low : high) = middle;
    }
    return static_cast<int>(std::ceil(high));
}

// From coefficients in closed form, which cost less than an estimate would in words.
int exact_count(const Lobe& lobe, double whole, double tolerance, int most) {
    const std::vector<double> lambda = zonal_coefficients(lobe, most);
    double rest = whole;
    for (int l = 0; l < most; ++l) {
        if (rest <= tolerance * tolerance * whole) return std::max(l, 1);
        rest -= (2 * l + 1) * lambda[l] * lambda[l];
    }
    return most;
}

// lambda_l ~ exp(-l (l+1) / 2N), so that the share is exp(-L^2 / N).
double gaussian_count(double exponent, double tolerance) {
    return std::sqrt(-2 * exponent * std::log(tolerance));
}

int phong_count(const Lobe& lobe, double tolerance) {
    const double n = lobe.parameter, smooth = 1.01 * gaussian_count(n, tolerance) + 2;
    if (smooth > kLargestBandCount) return static_cast<int>(std::min(smooth, kMost));
    const double whole = 2 * (n + 1) * (n + 1) / (2 * n + 1);
    return exact_count(lobe, whole, tolerance,
                       static_cast<int>(std::max(kCreaseCap, std::ceil(smooth))));
}

// cos(theta/2)^N is cos(theta)^(N/4) near the axis; the cosine and the sphere add to the exponent.
int blinn_phong_count(const Lobe& lobe, double tolerance) {
    const double exponent = lobe.parameter / 4 + 1;
    const double jump = detail::LobeKernel(lobe)(1) * std::exp2(-lobe.parameter / 2);
    const double sum = whole(lobe);
    return least_count(
        [&](double bands) {
            const double smooth = std::exp(-bands * bands / exponent);
            return smooth + (bands < kCreaseCap ? crease_share(jump, sum, bands) : 0);
        },
        tolerance);
}

// Near the axis k ~ 1 / (a^2 + theta^2)^2, a = 2 atanh(alpha) by the place of its poles, and
// lambda_l ~ x K1(x) with x = a (l + 1/2). The sum of (2l+1) lambda_l^2 becomes the integral of
// x^3 K1^2, 2/3 from 0, and from x up by K1's expansion for large x,
// pi / 4 e^-2x (x^2 + 7/4 x + 31/32 + ...).
int ggx_count(const Lobe& lobe, double tolerance) {
    const double alpha = lobe.parameter * lobe.parameter;
    const double a = 2 * std::atanh(std::min(alpha, 1 - 1e-12));
    const double at_horizon = (1 + alpha * alpha) / 2;
    const double jump =
        detail::LobeKernel(lobe)(1) * std::pow(alpha, 4) / (at_horizon * at_horizon);
    const double sum = whole(lobe);
    return least_count(
        [&](double bands) {
            const double x = a * bands;
            const double smooth =
                std::exp(-2 * x) * 3 * kPi / 8 * (x * x + 7.0 / 4 * x + 31.0 / 32);
            return smooth + (bands < kCreaseCap ? crease_share(jump, sum, bands) : 0);
        },
        tolerance);
}

// A ring at the horizon, e^(-q d) d at d below it: its transform is 1 / (q + i l)^2, the share the
// integral of 1 / (q^2 + l^2)^2.
int charlie_count(const Lobe& lobe, double tolerance) {
    const double q = 1 / (2 * lobe.parameter * lobe.parameter);
    const double jump = (q + 1) * (q + 2) / (2 * kPi), sum = whole(lobe);
    const double cap = std::max(kCreaseCap, 24 * q);
    return least_count(
        [&](double bands) {
            if (bands >= cap) return 0.0;
            const double x = bands / q;
            // atan(1/x) - x / (1 + x^2), 2 / 3x^3 where that cancels
            const double rest = x < 100 ? std::atan(1 / x) - x / (1 + x * x) : 2 / (3 * cube(x));
            return 8 * kPi * jump * jump / sum * rest / (2 * cube(q));
        },
        tolerance);
}

}  // namespace

int band_count(const Lobe& lobe, double tolerance) {
    assert(!lobe.is_delta() && tolerance > 0 && tolerance < 1);
    switch (lobe.kind) {
        case Lobe::Kind::phong:
            return phong_count(lobe, tolerance);
        case Lobe::Kind::blinn_phong:
            return blinn_phong_count(lobe, tolerance);
        case Lobe::Kind::ggx:
            return ggx_count(lobe, tolerance);
        case Lobe::Kind::charlie:
            return charlie_count(lobe, tolerance);
        case Lobe::Kind::tabulated:
            return exact_count(lobe, whole(lobe), tolerance, kTableCap);
        default:
            return exact_count(lobe, 8 * kPi * kPi / 3, tolerance, static_cast<int>(kCreaseCap));
    }
}

}  // namespace mirrorball
