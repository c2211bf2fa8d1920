#include "prefilter/target_rules.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/zonal.h>

#include "image/map_size.h"
#include "prefilter/target.h"

namespace mirrorball::detail {
namespace {

// Lobes that need more bands have the whole source in their near part, which does not grow much
// from fewer bands on.
constexpr int kMostBands = 1024, kBandsBesideWholeSource = 512;

// What a lobe may need that is to be made within a frame.
constexpr int kQuickBands = 512;

// What harmonics alone are asked for of a single lit texel, in tolerances: such a texel is put
// right in space, and the spectra of all else fall, so that the error comes out far below. Where it
// does not, and too many lights would have to be put right, more bands are taken.
constexpr double kSlack = 10, kDenseSlack = 1;

// Lights are put right as far as they are fewer than this, and fewer pairs of them and texels, at
// about a nanosecond each; and beyond where the error says that it is not enough.
constexpr std::size_t kMostLights = 2000;
constexpr double kMostPairs = 5e5;

// Between the texels of a small source a lobe much narrower than they are is all tail, and that
// lies below what single precision holds next to its peak. And what a handful of texels adds up to
// has steps. Both are summed as the reference does.
constexpr double kNarrowest = 0.125;  // half of the lobe's light, in texels
constexpr double kFewTexels = 64;
constexpr double kMostSummedPairs = 1e9;

// Lobes that hold half of their light within so many texels have sums, over the texels around them,
// that change from texel to texel: they have the whole source in their near part, too. Where it
// takes more texels than the second number, sums differ by the square of that ratio, 3e-5 here.
constexpr double kWholeSource = 2.5, kEvenFrom = 5;

// Sums over a lobe that differ by less than this, in tolerances, count as equal.
constexpr double kEvenness = 0.05;

// What is estimated is a mean over the sphere: maps of few texels show up to so many times as much.
// And what single precision adds: of directions, next to lobes that are nearly deltas, and of sums.
constexpr double kShown = 4.5, kNearDelta = 5e-4, kRounding = 5e-6;

// An estimate without that margin is good enough, for no more lights to be put right, if it is
// below this, in tolerances; and below this with all that were.
constexpr double kGoodUnlit = 2.0 / 3, kGood = 1;

double texel_count(const MapShape& shape) {
    return static_cast<double>(environment_map_bytes(shape.projection, shape.size)) /
           (3 * sizeof(float));
}

// Typical angle between texels of a map, in radians.
double texel_angle(const MapShape& shape) {
    return std::sqrt(4 * kPi / texel_count(shape));
}

}  // namespace

TargetRules::TargetRules(const MapShape& source, const PrefilterOptions& options)
    : source_(source),
      tolerance_(options.tolerance) {
    if (!(options.tolerance > 0 && options.tolerance <= 0.1)) {
        throw Error(Errc::usage,
                    fmt::format("the tolerance must be above 0 and at most 0.1, found {}",
                                options.tolerance));
    }
    check_map_size(source.projection, source.size);
}

void TargetRules::check(const PrefilterTarget& target) {
    check_map_size(target.projection, target.size);
    (void)target.lobe.value(1);  // refuses tables that have no values
}

bool TargetRules::takes_whole_source(const Lobe& lobe) const {
    return band_count(lobe, tolerance_) > kMostBands ||
           lobe.angle_holding(0.5) < kWholeSource * texel_angle(source_);
}

std::optional<BandSplit> TargetRules::split(const PrefilterTarget& target) const {
    const Lobe& lobe = target.lobe;
    if (lobe.is_delta()) return {};
    const double source_count = texel_count(source_);
    const bool beyond_harmonics =
        lobe.angle_holding(0.5) < kNarrowest * texel_angle(source_) || source_count <= kFewTexels;
    if (beyond_harmonics && source_count * texel_count(shape_of(target)) <= kMostSummedPairs)
        return {};
    return split_bands(lobe, std::min(0.1, kSlack * tolerance_),
                       takes_whole_source(lobe) ? kBandsBesideWholeSource : kMostBands);
}

BandSplit TargetRules::dense_split(const Lobe& lobe, int most_bands) const {
    return split_bands(lobe, kDenseSlack * tolerance_, most_bands);
}

bool TargetRules::is_quick(const Lobe& lobe) const {
    return !takes_whole_source(lobe) && band_count(lobe, tolerance_) <= kQuickBands;
}

bool TargetRules::sums_evenly(const Lobe& lobe) const {
    return lobe.angle_holding(0.5) >= kEvenFrom * texel_angle(source_);
}

double TargetRules::evenness() const {
    return kEvenness * tolerance_;
}

bool TargetRules::has_many_pairs(const Choice& choice) {
    return choice.pair_count > kMostPairs;
}

Choice TargetRules::choose_lights(const FilteredTarget& target, std::span<const double> spectrum,
                                  LightLevels* light_levels) const {
    Choice choice{&target};
    const double unlit = target.spectral_error(spectrum);
    const double waves = target.wave_error(spectrum);
    choice.error = kShown * unlit + kRounding;
    if (target.whole_source_near()) {
        choice.error = kShown * waves + kNearDelta;
        return choice;
    }
    const double texels = target.texels_per_light();
    if (light_levels == nullptr || texels == 0) return choice;
    LightLevels& lights = *light_levels;
    for (std::size_t level = LightLevels::kUsual; level < LightLevels::kThresholds.size();
         ++level) {
        if (!lights.any(level)) break;
        const auto count = static_cast<double>(lights.count(level));
        if (count > kMostLights || count * texels > kMostPairs) continue;
        choice.light_level = level;
        break;
    }
    if (unlit > kGoodUnlit * tolerance_) {
        std::size_t level = choice.light_level.value_or(LightLevels::kThresholds.size() - 1);
        while (level > 0 && unlit * lights.rest(level) > kGood * tolerance_ * lights.deviation())
            --level;
        if (lights.any(level)) choice.light_level = level;
    }
    if (!choice.light_level) return choice;
    const std::size_t level = *choice.light_level;
    choice.pair_count = static_cast<double>(lights.count(level)) * texels;
    // what is left has less of everything, of fine detail even more so, and cannot be off by more
    // than the lobe's tail of it
    const double rest = lights.rest(level);
    const double left = std::min(unlit * rest / lights.deviation(), target.tail() * rest);
    choice.error = kShown * (waves + left) + kRounding;
    return choice;
}

}  // namespace mirrorball::detail
