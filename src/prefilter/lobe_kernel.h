// A lobe made ready for many evaluations: its normalisation worked out once.
#pragma once

#include <cmath>

#include <mirrorball/lobe.h>

namespace mirrorball::detail {

class LobeKernel {
  public:
    /// \pre !lobe.is_delta()
    explicit LobeKernel(const Lobe& lobe);

    /// The weight at t = cos(theta), per steradian; see Lobe.
    double operator()(double t) const {
        if (t <= 0) return 0;
        switch (kind_) {
            case Lobe::Kind::diffuse:
                return t;
            case Lobe::Kind::phong:
                return scale_ * std::pow(t, exponent_);
            case Lobe::Kind::blinn_phong:
                return scale_ * std::pow((1 + t) / 2, exponent_) * t;
            default: {
                // (alpha^2 - 1) cos^2(theta/2) + 1, without cancelling near the axis
                const double denominator = alpha2_ + (1 - alpha2_) * (1 - t) / 2;
                return scale_ * t / (denominator * denominator);
            }
        }
    }

    /// The integral over the cap of directions with cos(theta) >= t, in closed form.
    [[nodiscard]] double cap(double t) const;

  private:
    [[nodiscard]] double unscaled_cap(double t) const;

    Lobe::Kind kind_;
    double exponent_ = 0;  // of cos(theta), or of cos^2(theta/2) for blinn_phong
    double alpha2_ = 1;    // ggx
    double scale_ = 1;
};

}  // namespace mirrorball::detail
