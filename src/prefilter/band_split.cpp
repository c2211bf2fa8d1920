#include "prefilter/band_split.h"

#include <algorithm>
#include <cmath>

#include <mirrorball/vector.h>
#include <mirrorball/zonal.h>

#include "prefilter/legendre.h"
#include "prefilter/lobe_kernel.h"
#include "prefilter/zonal_quadrature.h"

namespace mirrorball::detail {
namespace {

// The roll-off is an integrated Gaussian, cut off where what is left of it, times what the bands
// there hold, is this share of the lobe: what it rings by afar.
constexpr double kRinging = 5e-8;

// The near part is left out where it is below this share of the lobe, or of a hundredth of its root
// mean square: so a fifth of the 1e-3 that a bright light may be off, which leaves room for many.
constexpr double kNegligible = 2e-4, kFloor = 1e-2;

// What phong and blinn-phong are carried to: nothing is left to correct.
constexpr double kGaussianTolerance = 2e-7;

// Where band_count() stops following a crease; the fewest and the most bands for what has one and
// needs few: the near part's ring at the horizon is as narrow as they are many.
constexpr int kCreaseCount = 128, kFewestCreased = 64, kMostCreased = 192;

// The roll-off begins no earlier than this share of the bands: as far as bands are concerned, the
// near part is as compact as can be.
constexpr double kEarliest = 0.25;

struct Plan {
    int hard_count;    // of bands, cut off at once, for the tolerance
    int count;         // with a roll-off
    double tolerance;  // for the roll-off to keep to
};

bool is_gaussian(const Lobe& lobe) {
    return lobe.kind == Lobe::Kind::phong || lobe.kind == Lobe::Kind::blinn_phong;
}

Plan plan_for(const Lobe& lobe, double tolerance) {
    if (is_gaussian(lobe)) {
        const double finer = std::min(tolerance, kGaussianTolerance);
        const int hard = band_count(lobe, finer);
        if (hard != kCreaseCount) return {hard, static_cast<int>(std::ceil(1.1 * hard)), finer};
    }
    const int hard = band_count(lobe, tolerance);
    const double creased = std::clamp<double>(1.5 * hard, kFewestCreased, kMostCreased);
    const double count = std::max(1.2 * hard, creased);
    return {hard, static_cast<int>(std::min(std::ceil(count), 1e9)), tolerance};
}

double square(double x) {
    return x * x;
}

// 1 up to l = start, 0 from l = end, between them an integrated Gaussian: erfc from -deviations to
// deviations.
struct RollOff {
    double start, end, deviations;

    [[nodiscard]] double operator()(double l) const {
        if (l <= start) return 1;
        if (l >= end) return 0;
        const double u = 2 * (l - start) / (end - start) - 1, edge = std::erfc(deviations);
        return (std::erfc(deviations * u) - edge) / (2 - 2 * edge);
    }
};

// erfc(x) = kRinging / loss, by erfc(x) ~ e^-(x + 0.3)^2 for x from 1 to 4.
double deviations_for(double loss) {
    return std::clamp(std::sqrt(std::log(std::max(loss / kRinging, 1.0))) - 0.3, 1.0, 4.0);
}

// lambda_l to the cut, and the sum over all bands of (2l+1) lambda_l^2.
struct Spectrum {
    std::vector<double> lambda;
    double whole;

    // What the bands from `count` up hold, of the whole; to 1e-16, the root of which is what a
    // tolerance can be.
    [[nodiscard]] double beyond(int count) const {
        double rest = whole;
        for (int l = 0; l < count; ++l) rest -= (2 * l + 1) * square(lambda[l]);
        return std::max(rest, 0.0);
    }

    // What is lost by a roll-off.
    [[nodiscard]] double lost(const RollOff& roll_off) const {
        const int count = static_cast<int>(lambda.size());
        double sum = beyond(count);
        for (int l = static_cast<int>(roll_off.start); l < count; ++l)
            sum += (2 * l + 1) * square(lambda[l] * (1 - roll_off(l)));
        return sum;
    }
};

// The roll-off that starts the earliest and loses no more than the tolerance allows, or than a hard
// cut would.
RollOff best_roll_off(const Spectrum& spectrum, const Plan& plan) {
    const int count = static_cast<int>(spectrum.lambda.size());
    const double end = count, early = kEarliest * end, whole = spectrum.whole;
    if (plan.hard_count > count) {
        const double loss = spectrum.beyond(static_cast<int>((early + end) / 2));
        return {early, end, deviations_for(std::sqrt(loss / whole))};
    }
    const double most = std::max(square(plan.tolerance) * whole, spectrum.beyond(plan.hard_count));
    RollOff best{end, end, deviations_for(std::sqrt(most / whole))};
    for (double low = early; best.start - low > 0.25;) {
        const RollOff middle{(low + best.start) / 2, end, best.deviations};
        if (spectrum.lost(middle) <= most)
            best = middle;
        else
            low = middle.start;
    }
    return best;
}

// The width of the lobe's peak, which the near part may have to resolve.
double peak_width(const Lobe& lobe) {
    switch (lobe.kind) {
        case Lobe::Kind::ggx:
            return 2 * square(lobe.parameter);
        case Lobe::Kind::phong:
            return std::sqrt(2 / (lobe.parameter + 1));
        case Lobe::Kind::blinn_phong:
            return std::sqrt(8 / (lobe.parameter + 1));
        case Lobe::Kind::charlie:
            return 1e-4;  // a cone at its axis, at worst
        default:
            return 1;
    }
}

class NearPartOf {
  public:
    NearPartOf(const Lobe& lobe, const BandSplit& split) : kernel_(lobe) {
        for (std::size_t l = 0; l < split.far.size(); ++l)
            series_.push_back((2 * static_cast<double>(l) + 1) / (4 * kPi) * split.far[l]);
    }

    /// k - far at squared chords in [0, 4].
    [[nodiscard]] std::vector<double> at(std::span<const double> chords2) const {
        std::vector<double> x, values(chords2.size()), opposite(chords2.size());
        for (const double chord2 : chords2) x.push_back(std::min(chord2, 4 - chord2) / 2);
        legendre_series(series_, x, values, opposite);
        for (std::size_t i = 0; i < chords2.size(); ++i)
            values[i] = kernel_.at(chords2[i] / 4) - (chords2[i] <= 2 ? values[i] : opposite[i]);
        return values;
    }

    /// Is it more than may be left out, at this chord?
    [[nodiscard]] bool matters(double chord2, double value, double rms) const {
        return std::abs(value) > kNegligible * std::max(kernel_.at(chord2 / 4), kFloor * rms);
    }

  private:
    LobeKernel kernel_;
    std::vector<double> series_;
};

struct Interval {
    double start, end;  // angles
};

// Where the near part matters: intervals of angles, seen at six points per wavelength of the last
// band and widened by one. A gap is a wavelength or more, and there are at most two intervals.
std::vector<Interval> support(const NearPartOf& near, int band_count, double rms) {
    const int count = std::max(64, static_cast<int>(std::ceil(kPi * band_count)));
    std::vector<double> chords2;
    for (int i = 0; i <= count; ++i) chords2.push_back(4 * square(std::sin(kPi * i / count / 2)));
    const std::vector<double> values = near.at(chords2);
    std::vector<Interval> intervals;
    for (int i = 0; i <= count; ++i) {
        if (!near.matters(chords2[i], values[i], rms)) continue;
        const double start = kPi * std::max(i - 1, 0) / count,
                     end = kPi * std::min(i + 1, count) / count;
        if (!intervals.empty() && start - intervals.back().end < 2 * kPi / band_count)
            intervals.back().end = end;
        else
            intervals.push_back({start, end});
    }
    while (intervals.size() > 2) {
        std::size_t closest = 1;
        const auto gap = [&](std::size_t i) { return intervals[i].start - intervals[i - 1].end; };
        for (std::size_t i = 2; i < intervals.size(); ++i)
            if (gap(i) < gap(closest)) closest = i;
        intervals[closest - 1].end = intervals[closest].end;
        intervals.erase(intervals.begin() + static_cast<std::ptrdiff_t>(closest));
    }
    return intervals;
}

// Steps of a fortieth of a radian of the last band's wave, and 1/512 of a peak's width: straight
// lines between are within 1e-4 of the wave and 3e-6 of the peak.
int step_bits(double farthest, int band_count) {
    return std::clamp(static_cast<int>(std::ceil(std::log2(farthest * band_count * 20))), 9, 15);
}

NearKernel tabulate(const NearPartOf& near, const std::vector<Interval>& intervals, int band_count,
                    double width) {
    NearKernel kernel;
    for (const auto& [start, end] : intervals) {
        const double nearest = 2 * std::sin(start / 2), farthest = 2 * std::sin(end / 2);
        const double offset = nearest > 0 ? 0 : square(std::min(width, 1.0 / band_count));
        kernel.add_part(nearest, farthest, offset, step_bits(farthest, band_count),
                        [&](std::span<const double> chords2) { return near.at(chords2); });
    }
    return kernel;
}

}  // namespace

BandSplit split_bands(const Lobe& lobe, double tolerance, int max_band_count) {
    const Plan plan = plan_for(lobe, tolerance);
    const int count = std::min(plan.count, max_band_count);
    const Spectrum spectrum{zonal_coefficients(lobe, count),
                            4 * kPi * ZonalQuadrature(lobe, 1).square()};
    const RollOff roll_off = best_roll_off(spectrum, plan);
    BandSplit split;
    for (int l = 0; l < count; ++l) split.far.push_back(spectrum.lambda[l] * roll_off(l));
    split.whole = spectrum.whole;
    split.tail = std::sqrt(spectrum.lost(roll_off) / spectrum.whole);
    const NearPartOf near(lobe, split);
    const double rms = std::sqrt(spectrum.whole) / (4 * kPi);
    split.near = tabulate(near, support(near, count, rms), count, peak_width(lobe));
    return split;
}

}  // namespace mirrorball::detail
