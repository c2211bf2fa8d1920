// Associated Legendre functions, two degrees for every step of one recurrence.
//
// With x = cos(theta) and P_l^m orthonormal over the sphere, multiplying by x couples neighbours,
//
//     x P_l = eps_{l+1} P_{l+1} + eps_l P_{l-1},      eps_l = sqrt((l^2 - m^2) / (4 l^2 - 1))
//
// and multiplying by x^2 couples next neighbours but one. The degrees of odd l - m, divided by x,
//
//     q_n = P_{m+2n+1} / x = s_n p_n                  (even polynomials of x, times sin^m theta)
//
// obey a recurrence of three terms in x^2 alone; the scale s_n is chosen such that its last
// coefficient is 1,
//
//     p_{n+1} = (alpha_n x^2 + beta_n) p_n - p_{n-1}
//
// and from the first identity the degrees of even l - m are sums of two neighbours:
//
//     P_{m+2n} = eps_{m+2n+1} q_n + eps_{m+2n} q_{n-1},        P_{m+2n+1} = x q_n
//
// So p_n serves two degrees, and what is left is banded work on coefficients, once per order and
// not once per ring. After Ishioka 2018, "A New Recurrence Formula for Efficient Computation of
// Spherical Harmonic Transform". Why it is stable: docs/theory/spectral-prefiltering.md.
#pragma once

#include <cstdint>
#include <vector>

#include "core/aligned.h"

namespace mirrorball::detail {

/// The numbers of the recurrence for all orders and degrees below a band count. They do not depend
/// on rings, and those of fewer bands are among them.
class LegendreTable {
  public:
    explicit LegendreTable(int band_count);

    [[nodiscard]] int band_count() const { return band_count_; }
    /// How many p_n the degrees m <= l < band_count need.
    [[nodiscard]] static int step_count(int order, int band_count) {
        return (band_count - order + 1) / 2;
    }

    struct Step {
        double alpha, beta;
    };
    struct Scale {
        float own;   ///< s_n:                    of degree m+2n+1
        float even;  ///< s_n eps_{m+2n+1}:       p_n's share in degree m+2n
        float next;  ///< s_n eps_{m+2n+2}:       p_n's share in degree m+2n+2
    };
    [[nodiscard]] const Step* steps(int order) const { return steps_.data() + offsets_[order]; }
    [[nodiscard]] const Scale* scales(int order) const { return scales_.data() + offsets_[order]; }

    /// ln p_0 at sin theta = 1; a ring has p_0 = exp(that) sin^m theta. For orders above 0 the
    /// functions carry a factor sqrt 2, so that P cos(m psi) and P sin(m psi) are orthonormal.
    [[nodiscard]] double log_first(int order) const { return log_first_[order]; }

  private:
    int band_count_;
    std::vector<std::size_t> offsets_;
    std::vector<Step> steps_;
    std::vector<Scale> scales_;
    std::vector<double> log_first_;
};

/// What a Legendre stage reads of one order, and the groups of rings it runs over.
struct LegendreOrder {
    const LegendreTable::Step* steps;
    const LegendreTable::Scale* scales;
    int step_count;
    int degree_count;
    int group_count;
    const std::int32_t* starts;  ///< [group], the step at which a group begins to matter
    const double* seeds;         ///< [group][p_n, p_{n-1}][lane], there
    const double* x;             ///< cos theta, [group][lane]
    std::size_t group_stride;    ///< from one group to the next in the spectra
};

}  // namespace mirrorball::detail
