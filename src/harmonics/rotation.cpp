// Turning coefficients: Wigner's matrices, of a quarter turn alone.
//
// Any rotation is turns about the polar axis with two quarter turns about an axis across it
// between,
//
//     R = Z(alpha) Y(beta) Z(gamma) = Z(alpha + pi/2) Q Z(beta + pi) Q Z(gamma + pi/2)
//
// with Q = Y(pi/2). Turns Z are two-by-two. Q's matrices d^l_km = d^l_km(pi/2) hold for every
// rotation; in the basis of real harmonics half of their entries cancel: cosines of orders k and m
// meet where l + k + m is even, sines where it is odd. They obey, from the eigenvalues of the
// angular momentum across the axis,
//
//     sqrt((l+k)(l-k+1)) d_{k-1,m} = 2 m d_{k,m} - sqrt((l-k)(l+k+1)) d_{k+1,m}
//
// and run down from d_{l,m} = (-1)^(l-m) 2^-l sqrt(binomial(2l, l+m)), each l and m by itself. In
// that direction the sought solution is the growing one until k^2 + m^2 < l^2, and neither grows
// after: rounding errors add up to 1e-13 at 1024 bands.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <mirrorball/harmonics.h>

#include "core/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "harmonics/rotation.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "harmonics/rotation_row.h"

HWY_BEFORE_NAMESPACE();
namespace mirrorball::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D>
HWY_INLINE void advance_columns(D d, const RowSteps& steps, std::size_t i,
                                const double* HWY_RESTRICT now, double* HWY_RESTRICT before) {
    const auto p = hn::LoadU(d, now + i);
    const auto entry = hn::Mul(p, hn::LoadU(d, steps.counts + i));
    for (std::size_t c = 0; c < 3; ++c) {
        double* const sum = steps.sums[c] + i;
        hn::StoreU(hn::MulAdd(entry, hn::Set(d, steps.values[c]), hn::LoadU(d, sum)), d, sum);
    }
    const auto factor = hn::Mul(hn::LoadU(d, steps.twice_m + i), hn::Set(d, steps.share));
    const auto loss = hn::Mul(hn::Set(d, steps.loss), hn::LoadU(d, before + i));
    hn::StoreU(hn::MulSub(factor, p, loss), d, before + i);
}

// `before` becomes the row after `now`.
void advance_row(const RowSteps& steps, const double* now, double* before) {
    const hn::ScalableTag<double> d;
    std::size_t i = 0;
    for (; i + hn::Lanes(d) <= steps.count; i += hn::Lanes(d))
        advance_columns(d, steps, i, now, before);
    for (; i < steps.count; ++i) advance_columns(hn::CappedTag<double, 1>(), steps, i, now, before);
}

}  // namespace HWY_NAMESPACE
}  // namespace mirrorball::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mirrorball::detail {
namespace {

HWY_EXPORT(advance_row);

void advance_row_here(const RowSteps& steps, const double* now, double* before) {
    HWY_DYNAMIC_DISPATCH(advance_row)(steps, now, before);
}

}  // namespace
}  // namespace mirrorball::detail

namespace mirrorball {
namespace {

using namespace detail;

// Turns --------------------------------------------------------------------------------------

struct Turns {
    double alpha, beta, gamma;  ///< about the pole, across it, about the pole; the last comes first
};

// The frame that harmonics are polar in: its x, y and z axes are the world's z, x and y.
Turns turns_of(const Axes& axes) {
    const auto in_frame = [](const Vec3d& v) { return Vec3d(v.z, v.x, v.y); };
    const Vec3d x = in_frame(axes.z), z = in_frame(axes.y);
    const double alpha = std::atan2(z.y, z.x);
    const double beta = std::atan2(std::hypot(z.x, z.y), z.z);
    // What is left when alpha and beta are undone is a turn about z, also where they are uncertain.
    const double c = std::cos(alpha), s = std::sin(alpha);
    const Vec3d y = z.cross(x);
    const auto undone_x = [&](const Vec3d& v) {
        return std::cos(beta) * (c * v.x + s * v.y) - std::sin(beta) * v.z;
    };
    return {alpha, beta, std::atan2(-undone_x(y), undone_x(x))};
}

// One degree of three channels: cosines, then sines, by order.
struct Degree {
    std::array<std::vector<double>, 6> parts;

    explicit Degree(int l) {
        for (auto& part : parts) part.assign(static_cast<std::size_t>(l) + 1, 0.0);
    }
    [[nodiscard]] int degree() const { return static_cast<int>(parts[0].size()) - 1; }
};

void turn_about_pole(double angle, Degree& degree) {
    for (int m = 1; m <= degree.degree(); ++m) {
        const double c = std::cos(m * angle), s = std::sin(m * angle);
        for (int channel = 0; channel < 3; ++channel) {
            double& cosine = degree.parts[channel][m];
            double& sine = degree.parts[3 + channel][m];
            const double turned = cosine * c - sine * s;
            sine = cosine * s + sine * c;
            cosine = turned;
        }
    }
}

// Quarter turns ------------------------------------------------------------------------------

// Columns m of one parity, side by side: two rows of d, the power of 2^512 that they carry because
// they began below the least double, and what they add up to.
struct Columns {
    std::vector<double> twice_m, now, before, scale, counts;
    std::array<std::vector<double>, 6> sums;

    Columns(int l, int parity) {
        constexpr double kLogScale = 512 * 0.693147180559945309;
        for (int m = parity; m <= l; m += 2) {
            const double log_value =
                (std::lgamma(2.0 * l + 1) - std::lgamma(l + m + 1.0) - std::lgamma(l - m + 1.0)) /
                    2 -
                l * std::log(2.0);
            const double power = std::max(0.0, std::ceil((-600 - log_value) / kLogScale));
            const double value = std::exp(log_value + power * kLogScale);
            twice_m.push_back(2.0 * m);
            now.push_back((l - m) % 2 == 0 ? value : -value);
            scale.push_back(power);
            counts.push_back(power > 0 ? 0 : 1);
        }
        before.assign(now.size(), 0.0);
        for (auto& sum : sums) sum.assign(now.size(), 0.0);
    }
};

// Adds row k to the sums, and goes on to row k - 1 (to one that nobody reads, below 0).
void advance(Columns& columns, int l, int k, int first_part, const std::array<double, 3>& values) {
    const double below = std::sqrt(std::max(1.0, static_cast<double>(l + k) * (l - k + 1)));
    const double above = std::sqrt(static_cast<double>(l - k) * (l + k + 1));
    const RowSteps steps{columns.twice_m.data(),
                         columns.counts.data(),
                         {columns.sums[first_part].data(), columns.sums[first_part + 1].data(),
                          columns.sums[first_part + 2].data()},
                         values,
                         1 / below,
                         above / below,
                         columns.now.size()};
    advance_row_here(steps, columns.now.data(), columns.before.data());
    columns.now.swap(columns.before);
}

// A step multiplies by less than sqrt(2 l) < 2^7: thirty go from 2^64 nowhere near overflow, and
// what is not yet counted then is below 2^-238.
constexpr int kStepsPerRescaling = 30;

void rescale(Columns& columns) {
    for (std::size_t i = 0; i < columns.now.size(); ++i) {
        if (columns.scale[i] == 0 || std::abs(columns.now[i]) < 0x1p64) continue;
        columns.now[i] *= 0x1p-512, columns.before[i] *= 0x1p-512;
        columns.scale[i] -= 1;
        columns.counts[i] = columns.scale[i] == 0 ? 1 : 0;
    }
}

// Sums over rows k of 2 d_km times order k's coefficients, to order m; order 0 counts half, shared
// between both of its sides.
void quarter_turn(Degree& degree) {
    const int l = degree.degree();
    std::array<Columns, 2> columns = {Columns(l, 0), Columns(l, 1)};
    const auto side = [](int m) { return m == 0 ? std::sqrt(0.5) : 1.0; };
    for (int k = l; k >= 0; --k) {
        for (int parity = 0; parity < 2; ++parity) {
            const int first_part = (l + k + parity) % 2 == 0 ? 0 : 3;
            std::array<double, 3> values;
            for (int c = 0; c < 3; ++c) values[c] = 2 * side(k) * degree.parts[first_part + c][k];
            advance(columns[parity], l, k, first_part, values);
            if (k % kStepsPerRescaling == 0) rescale(columns[parity]);
        }
    }
    for (int part = 0; part < 6; ++part) {
        for (int m = 0; m <= l; ++m)
            degree.parts[part][m] = side(m) * columns[m % 2].sums[part][m / 2];
    }
}

// Degrees ------------------------------------------------------------------------------------

Degree load(const Harmonics& harmonics, int l, double sign) {
    Degree degree(l);
    for (int m = 0; m <= l; ++m) {
        const float* const from = &harmonics.order(m)[6 * static_cast<std::size_t>(l - m)];
        for (int part = 0; part < 6; ++part) degree.parts[part][m] = sign * from[part];
    }
    return degree;
}

void store(const Degree& degree, Harmonics& harmonics) {
    const int l = degree.degree();
    for (int m = 0; m <= l; ++m) {
        float* const to = &harmonics.order(m)[6 * static_cast<std::size_t>(l - m)];
        for (int part = 0; part < 6; ++part) to[part] = static_cast<float>(degree.parts[part][m]);
    }
}

}  // namespace

Harmonics rotated(const Harmonics& harmonics, const Axes& axes) {
    // a mirrored frame is a turned one seen through the middle, where degree l changes by (-1)^l
    const bool mirrored = axes.mirrored();
    const Turns turns = turns_of(mirrored ? Axes{-axes.x, -axes.y, -axes.z} : axes);
    Harmonics result(harmonics.band_count());
    parallel_for(harmonics.band_count(), [&](std::int64_t i) {
        const int l = harmonics.band_count() - 1 - static_cast<int>(i);  // the longest first
        Degree degree = load(harmonics, l, mirrored && l % 2 == 1 ? -1 : 1);
        if (turns.beta == 0) {
            turn_about_pole(turns.alpha + turns.gamma, degree);
        } else {
            turn_about_pole(turns.gamma + kPi / 2, degree);
            quarter_turn(degree);
            turn_about_pole(turns.beta + kPi, degree);
            quarter_turn(degree);
            turn_about_pole(turns.alpha + kPi / 2, degree);
        }
        store(degree, result);
    });
    return result;
}

}  // namespace mirrorball
#endif
