// A lobe made ready for many evaluations: its normalisation worked out once.
#pragma once

#include <cmath>
#include <memory>

#include <mirrorball/lobe.h>

namespace mirrorball::detail {

class LobeKernel {
  public:
    /// \pre !lobe.is_delta() \throws Error(Errc::usage) for a table known by name only
    explicit LobeKernel(const Lobe& lobe);

    /// The weight at t = cos(theta), per steradian; see Lobe.
    double operator()(double t) const { return weight(t, (1 - t) / 2); }

    /// The same at h2 = sin^2(theta/2), a quarter of the squared chord from the axis: keeps its
    /// digits however narrow the lobe.
    [[nodiscard]] double at(double h2) const { return weight(1 - 2 * h2, h2); }

    /// The integral over the cap of directions with cos(theta) >= t.
    [[nodiscard]] double cap(double t) const;

    /// The angle beyond which there is nothing: pi / 2, or the last of a table.
    [[nodiscard]] double widest_angle() const { return widest_angle_; }

    /// The cosine at which the weight is largest: 1 for all but rings.
    [[nodiscard]] double peak_cosine() const;

  private:
    double weight(double t, double h2) const {
        if (kind_ == Lobe::Kind::tabulated) return table_weight(2 * std::asin(std::sqrt(h2)));
        if (t <= 0) return 0;
        switch (kind_) {
            case Lobe::Kind::diffuse:
                return t;
            case Lobe::Kind::phong:
                return scale_ * std::exp(exponent_ * log_of(t, 2 * h2));
            case Lobe::Kind::blinn_phong:
                return scale_ * std::exp(exponent_ * std::log1p(-h2)) * t;
            case Lobe::Kind::charlie:
                // (2 h2)^(1/(2 alpha)): 1 at the horizon, where a narrow ring is
                return scale_ * std::exp(exponent_ * log_of(2 * h2, t)) * t;
            default: {
                // (alpha^2 - 1) cos^2(theta/2) + 1, without cancelling near the axis
                const double denominator = alpha2_ + (1 - alpha2_) * h2;
                return scale_ * t / (denominator * denominator);
            }
        }
    }

    // The logarithm of x = 1 - y, from whichever is the smaller.
    static double log_of(double x, double y) { return y < 0.5 ? std::log1p(-y) : std::log(x); }

    [[nodiscard]] double table_weight(double angle) const;
    [[nodiscard]] double unscaled_cap(double t) const;

    Lobe::Kind kind_;
    double exponent_ = 0;  // of t, of cos^2(theta/2) for blinn_phong, of 1 - t for charlie
    double alpha2_ = 1;    // ggx
    double scale_ = 1;
    double widest_angle_;
    std::shared_ptr<const LobeTable> table_;
};

}  // namespace mirrorball::detail
