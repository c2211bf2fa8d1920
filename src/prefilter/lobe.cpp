#include <mirrorball/lobe.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>
#include <mirrorball/error.h>
#include <mirrorball/vector.h>

#include "prefilter/lobe_kernel.h"

namespace mirrorball {
namespace detail {

LobeKernel::LobeKernel(const Lobe& lobe) : kind_(lobe.kind) {
    if (kind_ == Lobe::Kind::phong) exponent_ = lobe.parameter;
    if (kind_ == Lobe::Kind::blinn_phong) exponent_ = lobe.parameter / 2;
    if (kind_ == Lobe::Kind::ggx) alpha2_ = std::pow(lobe.parameter, 4);
    scale_ = lobe.integral() / unscaled_cap(0);
}

double LobeKernel::cap(double t) const {
    return scale_ * unscaled_cap(t);
}

// With u = cos^2(theta/2) = (1 + t) / 2, dw = 2 pi dt = 4 pi du; integrals from u to 1.
double LobeKernel::unscaled_cap(double t) const {
    t = std::fmin(std::fmax(t, 0.0), 1.0);
    const double u = (1 + t) / 2;
    switch (kind_) {
        case Lobe::Kind::diffuse:
            return kPi * (1 - t * t);
        case Lobe::Kind::phong: {
            const double n = exponent_ + 1;
            return 2 * kPi / n * (t > 0 ? -std::expm1(n * std::log(t)) : 1);
        }
        case Lobe::Kind::blinn_phong: {
            const double n = exponent_ + 1;  // of u^(N/2) (2u - 1)
            const double power = std::pow(u, n);
            return 4 * kPi * (2 * (1 - power * u) / (n + 1) - (1 - power) / n);
        }
        default:
            break;
    }
    // (2u - 1) / (1 - b u)^2, with w = 1 - b u; near b = 0 the closed form cancels and the
    // integrand is next to a polynomial, for which Simpson's rule on 8 panels is exact to rounding
    const double b = 1 - alpha2_;
    if (b < 0.01) {
        const auto f = [b](double v) { return (2 * v - 1) / ((1 - b * v) * (1 - b * v)); };
        const int panel_count = 8;
        const double h = (1 - u) / panel_count;
        double sum = 0;
        for (int i = 0; i < panel_count; ++i) {
            const double left = u + i * h;
            sum += f(left) + 4 * f(left + h / 2) + f(left + h);
        }
        return 4 * kPi * sum * h / 6;
    }
    const double w0 = alpha2_, w1 = 1 - b * u;
    return 4 * kPi / b * ((2 / b - 1) * (1 / w0 - 1 / w1) - 2 / b * std::log(w1 / w0));
}

}  // namespace detail

namespace {

struct KindName {
    Lobe::Kind kind;
    std::string_view name, parameter;
    double largest;
};
constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr KindName kKinds[] = {
    {Lobe::Kind::mirror, "mirror", "", 0},
    {Lobe::Kind::diffuse, "diffuse", "", 0},
    {Lobe::Kind::phong, "phong", "exponent", kUnbounded},
    {Lobe::Kind::blinn_phong, "blinn-phong", "exponent", kUnbounded},
    {Lobe::Kind::ggx, "ggx", "roughness", 1},
};

double parse_parameter(std::string_view text, const KindName& kind, std::string_view number) {
    const std::string copy(number);
    char* end = nullptr;
    const double value = std::strtod(copy.c_str(), &end);
    const bool whole = !copy.empty() && end == copy.c_str() + copy.size();
    if (!whole || !(value >= 0 && value <= kind.largest) || std::isinf(value))
        throw Error(
            Errc::usage,
            fmt::format("lobe \"{}\": the {} must be a number from 0 {}", text, kind.parameter,
                        std::isinf(kind.largest) ? "up" : fmt::format("to {}", kind.largest)));
    return value;
}

}  // namespace

bool Lobe::is_delta() const {
    return kind == Kind::mirror || (kind == Kind::ggx && parameter == 0);
}

double Lobe::integral() const {
    return kind == Kind::diffuse ? kPi : 1;
}

double Lobe::value(double cos_theta) const {
    if (is_delta()) return cos_theta >= 1 ? std::numeric_limits<double>::infinity() : 0;
    return detail::LobeKernel(*this)(cos_theta);
}

double Lobe::angle_holding(double share) const {
    if (is_delta()) return 0;
    const detail::LobeKernel kernel(*this);
    const double wanted = share * integral();
    // the cap grows with its angle: bisect, in the angle so that narrow lobes keep their digits
    double narrow = 0, wide = kPi / 2;
    for (int i = 0; i < 60; ++i) {
        const double middle = (narrow + wide) / 2;
        (kernel.cap(std::cos(middle)) < wanted ? narrow : wide) = middle;
    }
    return wide;
}

std::string to_string(const Lobe& lobe) {
    for (const KindName& kind : kKinds) {
        if (kind.kind != lobe.kind) continue;
        if (kind.parameter.empty()) return std::string(kind.name);
        return fmt::format("{}:{}", kind.name, lobe.parameter);
    }
    return {};
}

Lobe parse_lobe(std::string_view text) {
    const std::size_t colon = text.find(':');
    const std::string_view kind_name = text.substr(0, colon);
    for (const KindName& kind : kKinds) {
        if (kind.name != kind_name) continue;
        if (kind.parameter.empty() && colon == std::string_view::npos) return {kind.kind, 0};
        if (kind.parameter.empty())
            throw Error(Errc::usage,
                        fmt::format("lobe \"{}\": {} has no parameter", text, kind.name));
        if (colon == std::string_view::npos)
            throw Error(Errc::usage, fmt::format("lobe \"{}\": expected {}:{}", text, kind.name,
                                                 kind.parameter));
        return {kind.kind, parse_parameter(text, kind, text.substr(colon + 1))};
    }
    throw Error(Errc::usage,
                fmt::format("no lobe \"{}\"; there are mirror, diffuse, phong:N, blinn-phong:N "
                            "(exponents) and ggx:R (perceptual roughness, 0 to 1)",
                            text));
}

}  // namespace mirrorball
