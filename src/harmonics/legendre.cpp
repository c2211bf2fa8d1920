#include "harmonics/legendre.h"

#include <cmath>

#include <mirrorball/vector.h>

#include "core/parallel.h"

namespace mirrorball::detail {
namespace {

double epsilon(double l, double m) {
    return std::sqrt((l * l - m * m) / (4 * l * l - 1));
}

}  // namespace

LegendreTable::LegendreTable(int band_count)
    : band_count_(band_count),
      offsets_(static_cast<std::size_t>(band_count) + 1) {
    for (int m = 0; m < band_count; ++m) offsets_[m + 1] = offsets_[m] + step_count(m, band_count);
    steps_.resize(offsets_.back() + 1);  // analysis takes them in twos, one past the last at most
    scales_.resize(offsets_.back());
    log_first_.resize(band_count);

    // P_m^m = sqrt((2m+1)!! / (4 pi (2m)!!)) sin^m, and P_{m+1}^m = x sqrt(2m+3) P_m^m
    double log_product = 0;
    for (int m = 0; m < band_count; ++m) {
        if (m > 0) log_product += std::log1p(1.0 / (2.0 * m));
        const double doubled = m > 0 ? std::log(2.0) : 0;
        log_first_[m] = (log_product - std::log(4 * kPi) + std::log(2.0 * m + 3) + doubled) / 2;
    }

    parallel_for(band_count, [this](std::int64_t order) {
        const double m = static_cast<double>(order);
        Step* const steps = steps_.data() + offsets_[order];
        Scale* const scales = scales_.data() + offsets_[order];
        const int count = static_cast<int>(offsets_[order + 1] - offsets_[order]);
        // with l = m+2n+1:  x^2 P_l = a_n P_{l+2} + b_n P_l + a_{n-1} P_{l-2}
        double scale = 1, next_scale = 1, a_before = 0;
        double eps0 = epsilon(m + 1, m), eps1 = epsilon(m + 2, m), eps2 = epsilon(m + 3, m);
        for (int n = 0; n < count; ++n) {
            const double a = eps1 * eps2, b = eps1 * eps1 + eps0 * eps0;
            if (n > 0) {
                const double after = scale * a_before / a;
                scale = next_scale, next_scale = after;
            }
            const double alpha = scale / (a * next_scale);
            steps[n] = {alpha, -b * alpha};
            scales[n] = {static_cast<float>(scale), static_cast<float>(scale * eps0),
                         static_cast<float>(scale * eps1)};
            a_before = a;
            eps0 = eps2;
            eps1 = epsilon(m + 2 * n + 4, m);
            eps2 = epsilon(m + 2 * n + 5, m);
        }
    });
}

}  // namespace mirrorball::detail
