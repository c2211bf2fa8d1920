// Reflectances of smooth surfaces.
//
// Everything but Eq. 19 goes by complex amplitudes of the two polarisations, from which a metal, a
// dielectric and their coating follow alike.
#include <mirrorball/fresnel.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include <fmt/format.h>
#include <mirrorball/error.h>

#include "brdf/parameters.h"
#include "prefilter/gauss_legendre.h"

namespace mirrorball {
namespace {

using Complex = std::complex<double>;

struct Polarised {
    double s, p;  // share of power reflected
};

// Of a face between indices `front` and `back`, along a ray whose index times sine is `sine`
// (conserved through all layers) and whose cosine in front is `front_cosine`.
Polarised face(Complex front, Complex front_cosine, Complex back, double sine) {
    const Complex ratio = sine / back;
    const Complex back_cosine = std::sqrt(1.0 - ratio * ratio);
    const Complex s =
        (front * front_cosine - back * back_cosine) / (front * front_cosine + back * back_cosine);
    const Complex p =
        (back * front_cosine - front * back_cosine) / (back * front_cosine + front * back_cosine);
    return {std::norm(s), std::norm(p)};
}

double sine_of(double cosine) {
    return std::sqrt(std::max(0.0, 1 - cosine * cosine));
}

// Light between two faces, summed over all of its ways out.
double both_faces(double upper, double lower) {
    const double through = 1 - upper;
    // at grazing incidence the upper face mirrors all, and 0/0 would be left for a perfect base
    if (through <= 0) return 1;
    return upper + through * through * lower / (1 - upper * lower);
}

void check_colour(std::string_view name, const Vec3d& value, double least, double most) {
    for (int c = 0; c < 3; ++c) detail::check_parameter(name, value[c], least, most);
}

constexpr double kLeastIndex = 0.01, kMostIndex = 100, kMostCoat = 3;

// 2 * integral of f(c) c dc from `from` to 1. The pieces double in length away from the lower end
// and the variable there is a square root, for what F has at grazing incidence and at the critical
// angle.
template <class F>
double flux_mean(double from, F&& f) {
    double sum = 0, low = 0;
    for (double high = 1.0 / 1024; low < 1; low = high, high *= 2) {
        sum += detail::integrate(low, high, [&](double x) {
            const double c = from + (1 - from) * x * x;
            return 2 * f(c) * c * (1 - from) * 2 * x;
        });
    }
    return sum;
}

}  // namespace

double fresnel_dielectric(double cos_theta, double index) {
    const double n = cos_theta < 0 ? 1 / index : index, c = std::abs(cos_theta);
    const double g2 = n * n + c * c - 1;
    if (g2 <= 0) return 1;
    const double g = std::sqrt(g2);
    const double s = (g - c) / (g + c), p = (c * (g + c) - 1) / (c * (g - c) + 1);
    return 0.5 * s * s * (1 + p * p);
}

double fresnel_conductor(double cos_theta, double index, double extinction) {
    const Polarised r = face(1, cos_theta, Complex(index, extinction), sine_of(cos_theta));
    return (r.s + r.p) / 2;
}

double fresnel_schlick(double cos_theta, double f0, double f90) {
    const double x = 1 - cos_theta;
    return f0 + (f90 - f0) * x * x * x * x * x;
}

double fresnel_coated(double cos_theta, double coat, double index, double extinction) {
    const double sine = sine_of(cos_theta), ratio = sine / coat;
    if (ratio >= 1) return 1;
    const Polarised upper = face(1, cos_theta, coat, sine);
    const Polarised lower =
        face(coat, std::sqrt(1 - ratio * ratio), Complex(index, extinction), sine);
    return (both_faces(upper.s, lower.s) + both_faces(upper.p, lower.p)) / 2;
}

Fresnel Fresnel::dielectric(double index) {
    detail::check_parameter("index", index, kLeastIndex, kMostIndex);
    return {Kind::dielectric, Vec3d(index), Vec3d(0)};
}

Fresnel Fresnel::conductor(const Vec3d& index, const Vec3d& extinction) {
    check_colour("n", index, kLeastIndex, kMostIndex);
    check_colour("k", extinction, 0, kMostIndex);
    return {Kind::conductor, index, extinction};
}

Fresnel Fresnel::conductor(std::string_view name) {
    const Metal& found = metal(name);
    return conductor(found.index, found.extinction);
}

Fresnel Fresnel::schlick(const Vec3d& f0, const Vec3d& f90) {
    check_colour("f0", f0, 0, 1);
    check_colour("f90", f90, 0, 1);
    return {Kind::schlick, f0, f90};
}

Fresnel Fresnel::coated(double coat) const {
    detail::check_parameter("coat", coat, 1, kMostCoat);
    if (coat != 1 && kind_ != Kind::dielectric && kind_ != Kind::conductor)
        throw Error(Errc::usage, "coat needs an index, a metal, or n and k to lie on");
    Fresnel result = *this;
    result.coat_ = coat;
    return result;
}

double Fresnel::channel(double c, int i) const {
    if (kind_ == Kind::schlick) return fresnel_schlick(c, first_[i], second_[i]);
    if (coat_ != 1) return fresnel_coated(c, coat_, first_[i], second_[i]);
    if (kind_ == Kind::conductor) return fresnel_conductor(c, first_[i], second_[i]);
    return fresnel_dielectric(c, first_[i]);
}

Vec3d Fresnel::operator()(double cos_theta) const {
    if (kind_ == Kind::ideal) return Vec3d(1);
    const double c = std::clamp(cos_theta, 0.0, 1.0);
    if (kind_ == Kind::dielectric) return Vec3d(channel(c, 0));
    return {channel(c, 0), channel(c, 1), channel(c, 2)};
}

Vec3d Fresnel::average() const {
    if (kind_ == Kind::ideal) return Vec3d(1);
    Vec3d result;
    for (int i = 0; i < 3; ++i) {
        // beyond the critical angle, cosines below this, all is reflected
        const double n = first_[i];
        const double critical =
            kind_ != Kind::schlick && second_[i] == 0 && n < 1 ? std::sqrt(1 - n * n) : 0;
        result[i] =
            critical * critical + flux_mean(critical, [&](double c) { return channel(c, i); });
    }
    return result;
}

LayerWeights layer_weights(Coating coating, const Fresnel& fresnel, double n_dot_v) {
    const Vec3d mirror = fresnel(n_dot_v);
    return {mirror, coating == Coating::off ? Vec3d(1) : Vec3d(1) - mirror};
}

Vec3d diffuse_coupling(const Vec3d& albedo_light, const Vec3d& albedo_view,
                       const Vec3d& mean_albedo) {
    Vec3d factor(0);
    for (int i = 0; i < 3; ++i) {
        // under a layer that mirrors all there is no light to couple
        if (mean_albedo[i] < 1)
            factor[i] = (1 - albedo_light[i]) * (1 - albedo_view[i]) / (1 - mean_albedo[i]);
    }
    return factor;
}

}  // namespace mirrorball
