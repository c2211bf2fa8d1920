// Discrete Fourier transforms of any length, one in each lane of a vector.
//
// The rings of a map are transformed sixteen (or eight, or four) at a time, one in each lane: no
// shuffles, and the output lies as the Legendre stage wants it. Stockham's form, which needs no
// bit reversal; radices 4, 2, 3 and 5, and any other prime by its definition, which costs its
// square.
#pragma once

#include <vector>

namespace mirrorball::detail {

/// What depends on the length alone.
class FourierPlan {
  public:
    explicit FourierPlan(int length);

    struct Pass {
        int radix;
        int length;  ///< of the transforms that are left
        int stride;  ///< how many of them lie interleaved
        int twiddles;
        int roots;  ///< for radices without code of their own
    };
    struct Complex {
        float re, im;
    };

    [[nodiscard]] int length() const { return length_; }
    [[nodiscard]] const std::vector<Pass>& passes() const { return passes_; }
    /// exp(-2 pi i p k / pass.length) at [p * (radix - 1) + k - 1], for p < length / radix
    [[nodiscard]] const Complex* twiddles(const Pass& pass) const {
        return numbers_.data() + pass.twiddles;
    }
    /// exp(-2 pi i k / radix)
    [[nodiscard]] const Complex* roots(const Pass& pass) const {
        return numbers_.data() + pass.roots;
    }

  private:
    int length_;
    std::vector<Pass> passes_;
    std::vector<Complex> numbers_;
};

/// The least length >= `least` that is a multiple of 4 and has no prime factor above 5.
[[nodiscard]] int good_fourier_length(int least);

/// The largest prime factor: what a transform of this length costs at worst, per value.
[[nodiscard]] int largest_prime_factor(int length);

}  // namespace mirrorball::detail
