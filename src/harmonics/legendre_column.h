// Associated Legendre functions at one angle, degree by degree.
//
// For sums at single points, where the vectors of legendre.h have nothing to work on: the
// three-term recurrence in the degree, in double.
#pragma once

#include <cmath>

#include <mirrorball/vector.h>

namespace mirrorball::detail {

/// P_l^m for l = m, m+1, ... with the normalisation of harmonics.h.
///
/// Where sin^m theta lies below the least double, so does everything until degrees of about
/// m / sin theta; values are carried times a power of 2^512 meanwhile. Going up in l the recurrence
/// follows the larger of its two solutions there, and both equally after: errors do not grow.
class LegendreColumn {
  public:
    /// `log_first` is ln P_m^m without its sin^m theta. \pre sine > 0 unless order is 0
    LegendreColumn(int order, double log_first, double cosine, double sine)
        : degree_(order),
          order_(order),
          cosine_(cosine) {
        const double log_value = log_first + (order > 0 ? order * std::log(sine) : 0);
        scale_ = static_cast<int>(std::fmax(0.0, std::ceil((-600 - log_value) / kLogScale)));
        now_ = std::exp(log_value + scale_ * kLogScale);
    }

    /// Zero where it is next to nothing.
    [[nodiscard]] double value() const { return scale_ > 0 ? 0 : now_; }

    /// On to the next degree: x P_l = eps_{l+1} P_{l+1} + eps_l P_{l-1}.
    void advance() {
        ++degree_;
        const double l = degree_, m = order_;
        const double above = std::sqrt((l * l - m * m) / (4 * l * l - 1));
        const double next = (cosine_ * now_ - epsilon_ * before_) / above;
        before_ = now_, now_ = next, epsilon_ = above;
        if (scale_ > 0 && std::abs(now_) > 0x1p256) {
            now_ *= 0x1p-512, before_ *= 0x1p-512;
            --scale_;
        }
    }

  private:
    static constexpr double kLogScale = 512 * 0.693147180559945309;

    int degree_, order_, scale_;
    double cosine_, now_, before_ = 0, epsilon_ = 0;
};

/// ln P_m^m without its sin^m theta, for m = 0, 1, ...
class FirstLegendre {
  public:
    [[nodiscard]] double log() const { return (log_product_ - std::log(4 * kPi)) / 2; }
    // P_m^m = sqrt((2m+1)!! / (4 pi (2m)!!)) sin^m, times sqrt 2 for m > 0
    void advance() {
        ++order_;
        log_product_ += std::log1p(1.0 / (2.0 * order_)) + (order_ == 1 ? std::log(2.0) : 0);
    }

  private:
    int order_ = 0;
    double log_product_ = 0;
};

}  // namespace mirrorball::detail
