#include <mirrorball/lobe.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>
#include <mirrorball/error.h>
#include <mirrorball/vector.h>

#include "prefilter/gauss_legendre.h"
#include "prefilter/lobe_kernel.h"

namespace mirrorball {
namespace detail {

LobeKernel::LobeKernel(const Lobe& lobe)
    : kind_(lobe.kind),
      widest_angle_(kPi / 2),
      table_(lobe.table) {
    if (kind_ == Lobe::Kind::tabulated) {
        if (!table_ || table_->angles.empty())
            throw Error(Errc::usage,
                        fmt::format("lobe \"{}\": its table is known by name only; read it from "
                                    "its file",
                                    to_string(lobe)));
        widest_angle_ = table_->angles.back();
        return;
    }
    if (kind_ == Lobe::Kind::phong) exponent_ = lobe.parameter;
    if (kind_ == Lobe::Kind::blinn_phong) exponent_ = lobe.parameter / 2;
    if (kind_ == Lobe::Kind::ggx) alpha2_ = std::pow(lobe.parameter, 4);
    if (kind_ == Lobe::Kind::charlie) exponent_ = 1 / (2 * lobe.parameter * lobe.parameter);
    scale_ = lobe.integral() / unscaled_cap(0);
}

double LobeKernel::cap(double t) const {
    if (kind_ != Lobe::Kind::tabulated) t = std::fmax(t, 0.0);
    return scale_ * unscaled_cap(std::fmin(t, 1.0));
}

double LobeKernel::peak_cosine() const {
    if (kind_ == Lobe::Kind::charlie) return 1 / (exponent_ + 1);
    if (kind_ != Lobe::Kind::tabulated) return 1;
    const auto peak = std::max_element(table_->weights.begin(), table_->weights.end());
    return peak == table_->weights.begin()
               ? 1
               : std::cos(table_->angles[peak - table_->weights.begin()]);
}

double LobeKernel::table_weight(double angle) const {
    const auto& [name, angles, weights] = *table_;
    const auto after = std::upper_bound(angles.begin(), angles.end(), angle);
    if (after == angles.begin()) return weights.front();
    const std::size_t i = after - angles.begin();
    if (after == angles.end()) return angle == angles.back() ? weights.back() : 0;
    return weights[i - 1] +
           (weights[i] - weights[i - 1]) * (angle - angles[i - 1]) / (angles[i] - angles[i - 1]);
}

namespace {

// The integral over the cap to `angle`, segment by segment: each is a line times a sine.
double table_cap(const LobeTable& table, double angle) {
    const auto& angles = table.angles;
    const double first = std::min(angle, angles.front());
    const double sine = std::sin(first / 2);
    double sum = table.weights.front() * 2 * sine * sine;  // 1 - cos
    for (std::size_t i = 1; i < angles.size() && angles[i - 1] < angle; ++i) {
        const double w0 = table.weights[i - 1],
                     slope = (table.weights[i] - w0) / (angles[i] - angles[i - 1]);
        sum += integrate(angles[i - 1], std::min(angle, angles[i]), [&](double a) {
            return std::sin(a) * (w0 + slope * (a - angles[i - 1]));
        });
    }
    return 2 * kPi * sum;
}

}  // namespace

// With u = cos^2(theta/2) = (1 + t) / 2, dw = 2 pi dt = 4 pi du; integrals from u to 1.
double LobeKernel::unscaled_cap(double t) const {
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
        case Lobe::Kind::charlie: {
            // of v^q (1 - v) with v = 1 - t, dw = 2 pi dv
            const double n = exponent_ + 1, v = 1 - t;
            return 2 * kPi * std::pow(v, n) * (1 / n - v / (n + 1));
        }
        case Lobe::Kind::tabulated:
            return table_cap(*table_, std::acos(std::fmax(t, -1.0)));
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
    double smallest, largest;
};
constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr KindName kKinds[] = {
    {Lobe::Kind::mirror, "mirror", "", 0, 0},
    {Lobe::Kind::diffuse, "diffuse", "", 0, 0},
    {Lobe::Kind::phong, "phong", "exponent", 0, kUnbounded},
    {Lobe::Kind::blinn_phong, "blinn-phong", "exponent", 0, kUnbounded},
    {Lobe::Kind::ggx, "ggx", "roughness", 0, 1},
    {Lobe::Kind::charlie, "charlie", "roughness", kLeastCharlieRoughness, 1},
};
constexpr std::string_view kTable = "table";
constexpr std::size_t kMostPoints = 4096;

// Lobes are listed with commas between them, on the command line and in metadata.
bool can_be_name(std::string_view name) {
    return !name.empty() && std::none_of(name.begin(), name.end(), [](unsigned char c) {
        return c == ',' || c < 0x20 || c == 0x7f;
    });
}

double parse_parameter(std::string_view text, const KindName& kind, std::string_view number) {
    const std::string copy(number);
    char* end = nullptr;
    const double value = std::strtod(copy.c_str(), &end);
    const bool whole = !copy.empty() && end == copy.c_str() + copy.size();
    if (!whole || !(value >= kind.smallest && value <= kind.largest) || std::isinf(value))
        throw Error(
            Errc::usage,
            fmt::format("lobe \"{}\": the {} must be a number from {} {}", text, kind.parameter,
                        kind.smallest,
                        std::isinf(kind.largest) ? "up" : fmt::format("to {}", kind.largest)));
    return value;
}

}  // namespace

// 1 - cos(theta) falls below a double's resolution at 1 where theta does below 1e-8
bool Lobe::is_delta() const {
    switch (kind) {
        case Kind::mirror:
            return true;
        case Kind::ggx:
            return parameter < 1e-4;
        case Kind::phong:
        case Kind::blinn_phong:
            return parameter > 1e16;
        default:
            return false;
    }
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
    double narrow = 0, wide = kernel.widest_angle();
    for (int i = 0; i < 60; ++i) {
        const double middle = (narrow + wide) / 2;
        (kernel.cap(std::cos(middle)) < wanted ? narrow : wide) = middle;
    }
    return wide;
}

std::string to_string(const Lobe& lobe) {
    if (lobe.kind == Lobe::Kind::tabulated)
        return fmt::format("{}:{}", kTable, lobe.table ? lobe.table->name : "");
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
    if (kind_name == kTable) {
        const std::string name(colon == std::string_view::npos ? "" : text.substr(colon + 1));
        if (!can_be_name(name))
            throw Error(Errc::usage, fmt::format("lobe \"{}\": expected {}:NAME", text, kTable));
        return {Lobe::Kind::tabulated, 0,
                std::make_shared<const LobeTable>(LobeTable{name, {}, {}})};
    }
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
                            "(exponents), ggx:R, charlie:R (perceptual roughness, to 1) and "
                            "table:NAME",
                            text));
}

Lobe tabulated_lobe(std::string name, std::vector<double> angles, std::vector<double> weights) {
    const auto refuse = [&](const std::string& what) {
        throw Error(Errc::usage, fmt::format("table \"{}\": {}", name, what));
    };
    if (!can_be_name(name)) refuse("its name must be printable and without commas");
    if (angles.size() != weights.size())
        refuse(fmt::format("{} angles and {} weights", angles.size(), weights.size()));
    if (angles.size() < 2 || angles.size() > kMostPoints)
        refuse(fmt::format("found {} points, expected 2 to {}", angles.size(), kMostPoints));
    double largest = 0;
    for (std::size_t i = 0; i < angles.size(); ++i) {
        if (!(angles[i] >= 0 && angles[i] <= kPi))
            refuse(fmt::format("the angle of point {} is {} degrees, expected 0 to 180", i + 1,
                               angles[i] * 180 / kPi));
        if (i > 0 && angles[i] <= angles[i - 1])
            refuse(fmt::format("the angle of point {}, {} degrees, is not above the one before it",
                               i + 1, angles[i] * 180 / kPi));
        if (!(weights[i] >= 0) || std::isinf(weights[i]))
            refuse(fmt::format("the weight of point {} is {}, expected a number from 0 up", i + 1,
                               weights[i]));
        largest = std::max(largest, weights[i]);
    }
    if (largest == 0) refuse("all weights are 0");
    LobeTable table{std::move(name), std::move(angles), std::move(weights)};
    for (double& weight : table.weights) weight /= largest;  // so that no sum overflows
    const double integral = detail::table_cap(table, kPi);
    if (!(integral > std::numeric_limits<double>::min()))
        refuse("it is too narrow to have an integral");
    for (double& weight : table.weights) weight /= integral;
    return {Lobe::Kind::tabulated, 0, std::make_shared<const LobeTable>(std::move(table))};
}

}  // namespace mirrorball
