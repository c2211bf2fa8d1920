#include "prefilter/gauss_legendre.h"

#include <array>
#include <cmath>

#include <mirrorball/vector.h>

namespace mirrorball::detail {
namespace {

// The roots of P_n by Newton's method from Tricomi's estimates, which are good to 1e-3.
template <int kCount>
std::array<QuadraturePoint, kCount> make_rule() {
    std::array<QuadraturePoint, kCount> rule;
    for (int i = 0; i < kCount; ++i) {
        double x = -std::cos(kPi * (i + 0.75) / (kCount + 0.5)), slope = 1;
        for (int step = 0; step < 6; ++step) {
            double p = 1, before = 0;
            for (int l = 0; l < kCount; ++l) {
                const double next = ((2 * l + 1) * x * p - l * before) / (l + 1);
                before = p;
                p = next;
            }
            slope = kCount * (before - x * p) / (1 - x * x);
            x -= p / slope;
        }
        rule[i] = {x, 2 / ((1 - x * x) * slope * slope)};
    }
    return rule;
}

}  // namespace

std::span<const QuadraturePoint> gauss_legendre(int count) {
    static const auto rule8 = make_rule<8>();
    static const auto rule16 = make_rule<16>();
    static const auto rule32 = make_rule<32>();
    if (count == 8) return rule8;
    if (count == 16) return rule16;
    return rule32;
}

}  // namespace mirrorball::detail
