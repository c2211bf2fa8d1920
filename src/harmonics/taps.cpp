#include "harmonics/taps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <mirrorball/vector.h>

namespace mirrorball::detail {
namespace {

constexpr int kNodeCount = 16;     // of the polynomial that the weights are in the fraction
constexpr int kEntryCount = 1024;  // of the table, between which it is linear

using Row = std::array<double, kTapCount>;

// sum over l of power times cos(l x), by Clenshaw's recurrence
double cosine_sum(std::span<const double> power, double x) {
    const double twice = 2 * std::cos(x);
    double b1 = 0, b2 = 0;
    for (std::size_t l = power.size(); l-- > 1;) {
        const double b = power[l] + twice * b1 - b2;
        b2 = b1, b1 = b;
    }
    return power[0] + twice / 2 * b1 - b2;
}

// L of the Cholesky factorisation A = L L^T.
std::array<Row, kTapCount> factorised(std::array<Row, kTapCount> a) {
    for (int j = 0; j < kTapCount; ++j) {
        for (int k = 0; k < j; ++k) a[j][j] -= a[j][k] * a[j][k];
        a[j][j] = std::sqrt(a[j][j]);
        for (int i = j + 1; i < kTapCount; ++i) {
            for (int k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
            a[i][j] /= a[j][j];
        }
    }
    return a;
}

Row solved(const std::array<Row, kTapCount>& l, Row b) {
    for (int i = 0; i < kTapCount; ++i) {
        for (int k = 0; k < i; ++k) b[i] -= l[i][k] * b[k];
        b[i] /= l[i][i];
    }
    for (int i = kTapCount; i-- > 0;) {
        for (int k = i + 1; k < kTapCount; ++k) b[i] -= l[k][i] * b[k];
        b[i] /= l[i][i];
    }
    return b;
}

}  // namespace

TapDesign::TapDesign(std::span<const double> power, double step)
    : table_(static_cast<std::size_t>(kEntryCount + 1) * kTapCount) {
    std::vector<double> waves(power.begin(), power.end());
    double total = 0;
    for (const double p : waves) total += p;
    // Constants matter most; and a little of everything keeps the equations apart from singular.
    waves[0] += 1e2 * total;
    const double noise = 1e-12 * total;

    std::array<Row, kTapCount> a{};
    for (int distance = 0; distance < kTapCount; ++distance) {
        const double sum = cosine_sum(waves, distance * step);
        for (int i = distance; i < kTapCount; ++i) a[i][i - distance] = sum;
    }
    for (int i = 0; i < kTapCount; ++i) a[i][i] += noise;
    const auto l = factorised(a);

    // At Chebyshev's nodes in [0, 1], then by the barycentric formula at the table's entries.
    std::array<Row, kNodeCount> at_nodes;
    std::array<double, kNodeCount> nodes, shares;
    for (int n = 0; n < kNodeCount; ++n) {
        const double angle = (n + 0.5) * kPi / kNodeCount;
        nodes[n] = (1 + std::cos(angle)) / 2;
        shares[n] = (n % 2 == 0 ? 1 : -1) * std::sin(angle);
        Row b;
        for (int i = 0; i < kTapCount; ++i) b[i] = cosine_sum(waves, (i - 3 - nodes[n]) * step);
        at_nodes[n] = solved(l, b);
    }
    for (int entry = 0; entry <= kEntryCount; ++entry) {
        const double x = static_cast<double>(entry) / kEntryCount;
        Row sum{};
        for (int n = 0; n < kNodeCount; ++n) {
            const double weight = shares[n] / (x - nodes[n]);  // no entry is a node
            for (int i = 0; i < kTapCount; ++i) sum[i] += weight * at_nodes[n][i];
        }
        double total_weight = 0;
        for (const double s : sum) total_weight += s;
        for (int i = 0; i < kTapCount; ++i) {
            table_[static_cast<std::size_t>(entry) * kTapCount + i] =
                static_cast<float>(sum[i] / total_weight);
        }
    }
}

void TapDesign::weights(double fraction, float* to) const {
    const double x = fraction * kEntryCount;
    const int entry = std::clamp(static_cast<int>(x), 0, kEntryCount - 1);
    const float share = static_cast<float>(x - entry);
    const float* const from = table_.data() + static_cast<std::size_t>(entry) * kTapCount;
    for (int i = 0; i < kTapCount; ++i) to[i] = from[i] + share * (from[kTapCount + i] - from[i]);
}

std::vector<double> TapDesign::wave_errors(double step, int count) const {
    const auto error_of = [&](int l) {
        double sum = 0;
        const int fraction_count = 6;
        for (int f = 0; f < fraction_count; ++f) {
            const double fraction = (f + 0.5) / fraction_count;
            float w[kTapCount];
            weights(fraction, w);
            double re = -1, im = 0;
            for (int i = 0; i < kTapCount; ++i) {
                const double angle = l * step * (i - 3 - fraction);
                re += w[i] * std::cos(angle), im += w[i] * std::sin(angle);
            }
            sum += re * re + im * im;
        }
        return std::sqrt(sum / fraction_count);
    };
    // smooth in l: every eighth, and straight lines between
    std::vector<double> errors(count);
    double left = error_of(0);
    for (int l = 0; l < count; l += 8) {
        const double right = error_of(l + 8);
        for (int i = l; i < std::min(l + 8, count); ++i)
            errors[i] = left + (right - left) * (i - l) / 8;
        left = right;
    }
    return errors;
}

void TapList::set(std::size_t point, double position, const TapDesign& design) {
    const double whole = std::floor(position);
    first[point] = static_cast<std::int32_t>(whole) - 3;
    design.weights(position - whole, weights.data() + point * kTapCount);
}

}  // namespace mirrorball::detail
