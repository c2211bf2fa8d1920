// The order of work is in Plan::run: analyse, then each target by itself.
#include <mirrorball/prefilter.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/resample.h>
#include <mirrorball/zonal.h>

#include "core/parallel.h"
#include "harmonics/transforms.h"
#include "image/map_size.h"
#include "prefilter/filtered_target.h"
#include "prefilter/source_light.h"
#include "prefilter/target.h"

namespace mirrorball {
namespace {

using namespace detail;

// Lobes that need more bands have the whole source in their near part, which does not grow much
// from fewer bands on.
constexpr int kMostBands = 1024, kBandsBesideWholeSource = 512;

// What harmonics alone are asked for of a single lit texel, in tolerances: such a texel is put
// right in space, and the spectra of all else fall, so that the error comes out far below. Where it
// does not, and too many lights would have to be put right, more bands are taken.
constexpr double kSlack = 10, kDenseSlack = 1;

// So many bands of a source cost next to nothing.
constexpr int kFewBands = 192;

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

// Is it what an earlier run made for this target?
bool is_for(const EnvironmentMap& map, const PrefilterTarget& target) {
    return map.levels.size() == 1 && map.levels[0].lobe == target.lobe &&
           shape_of(map) == shape_of(target);
}

/// What is known of a source before its targets are made.
struct Source {
    SourceRange range;
    Harmonics harmonics;
    std::vector<double> spectrum;
    std::optional<LightLevels> lights;  // if there is light at all; refers to `range`
    std::optional<NearField> whole;     // every texel, if a target needs them
};

/// How a target is made for a source.
struct Choice {
    const FilteredTarget* target;
    std::optional<std::size_t> light_level = {};
    double pair_count = 0;  // of lights and texels
    double error = 0;       // as estimated
};

}  // namespace

class PrefilterPlan::Plan {
  public:
    Plan(const MapShape& source, std::span<const PrefilterTarget> targets,
         const PrefilterOptions& options);

    void run(const EnvironmentMap& source, Prefiltered& result, const Progress& progress) const;

    MapShape source_;
    std::vector<PrefilterTarget> targets_;

  private:
    // How a target is made: by the first of these that there is, or else as the reference does it.
    struct Way {
        std::optional<Resampler> resampler;
        std::optional<FilteredTarget> filtered;
        // The same with more bands, made when a source asks for it; or none, if that is no use.
        mutable std::once_flag dense_once;
        mutable std::optional<FilteredTarget> dense;
    };

    [[nodiscard]] std::optional<BandSplit> split_lobe(const PrefilterTarget& target) const;
    [[nodiscard]] bool takes_whole_source(const Lobe& lobe) const;
    void make_transforms();
    void find_ones();
    [[nodiscard]] const FilteredTarget* dense_target(std::size_t i) const;

    void look_at(const EnvironmentMap& map, Source& source) const;
    [[nodiscard]] Choice choose_lights(const FilteredTarget& target, Source& source) const;
    [[nodiscard]] Choice choose(std::size_t i, Source& source) const;

    double tolerance_;
    std::vector<Way> ways_;
    std::vector<double> solid_angles_;
    std::shared_ptr<const LegendreTable> table_;
    std::shared_ptr<ScratchPool> scratch_ = std::make_shared<ScratchPool>();
    std::optional<AnalysisPlan> analysis_;
    std::optional<Ones> ones_;  // where sums over lobes are uneven
};

PrefilterPlan::Plan::Plan(const MapShape& source, std::span<const PrefilterTarget> targets,
                          const PrefilterOptions& options)
    : source_(source),
      targets_(targets.begin(), targets.end()),
      tolerance_(options.tolerance),
      ways_(targets.size()) {
    if (!(options.tolerance > 0 && options.tolerance <= 0.1)) {
        throw Error(Errc::usage,
                    fmt::format("the tolerance must be above 0 and at most 0.1, found {}",
                                options.tolerance));
    }
    check_map_size(source.projection, source.size);
    for (const PrefilterTarget& target : targets_) {
        check_map_size(target.projection, target.size);
        (void)target.lobe.value(1);  // refuses tables that have no values
    }
    solid_angles_ =
        solid_angle_table(source.projection, source.size, source.size / aspect(source.projection));
    make_transforms();
}

bool PrefilterPlan::Plan::takes_whole_source(const Lobe& lobe) const {
    return band_count(lobe, tolerance_) > kMostBands ||
           lobe.angle_holding(0.5) < kWholeSource * texel_angle(source_);
}

std::optional<BandSplit> PrefilterPlan::Plan::split_lobe(const PrefilterTarget& target) const {
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

void PrefilterPlan::Plan::make_transforms() {
    const auto count = static_cast<std::int64_t>(targets_.size());
    std::vector<std::optional<BandSplit>> splits(targets_.size());
    parallel_for(count, [&](std::int64_t i) {
        splits[i] = split_lobe(targets_[i]);
        if (targets_[i].lobe.is_delta()) ways_[i].resampler.emplace(source_, shape_of(targets_[i]));
    });
    const Lobe* finest = nullptr;
    std::vector<double> zonal;
    bool has_near = false;
    for (std::size_t i = 0; i < splits.size(); ++i) {
        if (!splits[i]) continue;
        has_near = has_near || splits[i]->near.support() > 0;
        if (splits[i]->far.size() <= zonal.size()) continue;
        finest = &targets_[i].lobe;
        zonal = splits[i]->far;
    }
    if (finest == nullptr) return;
    if (has_near && zonal.size() < kFewBands) {
        // as many as a target may take instead of lights
        const std::vector<double> all = zonal_coefficients(*finest, kFewBands);
        zonal.insert(zonal.end(), all.begin() + static_cast<std::ptrdiff_t>(zonal.size()),
                     all.end());
    }
    const int bands = static_cast<int>(zonal.size());
    for (double& factor : zonal) factor *= factor;
    table_ = std::make_shared<const LegendreTable>(bands);
    // the analysis and every target's synthesis, the analysis first
    parallel_for(count + 1, [&](std::int64_t i) {
        if (i == 0) {
            analysis_.emplace(source_, table_, bands, zonal, scratch_);
        } else if (const auto& split = splits[i - 1]) {
            const PrefilterTarget& target = targets_[i - 1];
            ways_[i - 1].filtered.emplace(target, *split, takes_whole_source(target.lobe), table_,
                                          scratch_);
        }
    });
    find_ones();
}

void PrefilterPlan::Plan::find_ones() {
    bool is_uneven = analysis_->on_rings();
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        const double half = targets_[i].lobe.angle_holding(0.5);
        is_uneven = is_uneven || (ways_[i].filtered && half < kEvenFrom * texel_angle(source_));
    }
    if (!is_uneven) return;
    ones_.emplace(*analysis_);
    parallel_for(static_cast<std::int64_t>(targets_.size()), [&](std::int64_t i) {
        if (ways_[i].filtered)
            ways_[i].filtered->divide_by_sums_over(*ones_, kEvenness * tolerance_);
    });
}

const FilteredTarget* PrefilterPlan::Plan::dense_target(std::size_t i) const {
    const Way& way = ways_[i];
    std::call_once(way.dense_once, [&] {
        const BandSplit split =
            split_bands(targets_[i].lobe, kDenseSlack * tolerance_, analysis_->band_count());
        if (split.far.size() <= way.filtered->far().size()) return;
        way.dense.emplace(targets_[i], split, false, table_, scratch_);
        if (ones_) way.dense->divide_by_sums_over(*ones_, kEvenness * tolerance_);
    });
    return way.dense ? &*way.dense : nullptr;
}

// Lights are taken from the brightest on as long as they are cheap, and then as long as the error
// is too large.
Choice PrefilterPlan::Plan::choose_lights(const FilteredTarget& target, Source& source) const {
    Choice choice{&target};
    const double unlit = target.spectral_error(source.spectrum);
    const double waves = target.wave_error(source.spectrum);
    choice.error = kShown * unlit + kRounding;
    if (target.whole_source_near()) {
        choice.error = kShown * waves + kNearDelta;
        return choice;
    }
    const double texels = target.texels_per_light();
    if (!source.lights || texels == 0) return choice;
    LightLevels& lights = *source.lights;
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

Choice PrefilterPlan::Plan::choose(std::size_t i, Source& source) const {
    const Choice usual = choose_lights(*ways_[i].filtered, source);
    if (usual.pair_count <= kMostPairs) return usual;
    const FilteredTarget* const dense = dense_target(i);
    if (dense == nullptr) return usual;
    const Choice better = choose_lights(*dense, source);
    return better.pair_count < usual.pair_count ? better : usual;
}

void PrefilterPlan::Plan::look_at(const EnvironmentMap& map, Source& source) const {
    source.range = range_of(map, solid_angles_);
    if (!analysis_) return;
    source.harmonics = Harmonics(analysis_->band_count());
    analysis_->run(map.levels[0].faces, source.harmonics);
    source.spectrum = power_spectrum(source.harmonics);
    const Vec3f first = source.harmonics.coefficient(0, 0);
    const double mean = (first.x + first.y + first.z) / 3 * std::sqrt(1 / (4 * kPi));
    if (mean > 0) source.lights.emplace(map, solid_angles_, source.range, static_cast<float>(mean));
    const auto takes_all = [](const Way& w) {
        return w.filtered && w.filtered->whole_source_near();
    };
    if (std::any_of(ways_.begin(), ways_.end(), takes_all))
        source.whole.emplace(all_lights(map, solid_angles_));
}

void PrefilterPlan::Plan::run(const EnvironmentMap& map, Prefiltered& result,
                              const Progress& progress) const {
    if (shape_of(map) != source_)
        throw Error(Errc::usage, "the map to prefilter is not of the shape that was planned for");
    result.maps.resize(targets_.size());
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        if (!is_for(result.maps[i], targets_[i])) result.maps[i] = make_target(targets_[i]);
    }
    result.errors.assign(targets_.size(), 0);

    Source source;
    look_at(map, source);
    std::vector<std::optional<Choice>> choices(targets_.size());
    std::vector<const NearField*> near(targets_.size());
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        if (!ways_[i].filtered) continue;
        const Choice& choice = choices[i].emplace(choose(i, source));
        if (choice.target->whole_source_near())
            near[i] = &*source.whole;
        else if (choice.light_level)
            near[i] = &source.lights->field(*choice.light_level);
        result.errors[i] = choice.error;
    }
    parallel_for(
        static_cast<std::int64_t>(targets_.size()),
        [&](std::int64_t i) {
            if (ways_[i].resampler) {
                (*ways_[i].resampler)(map, result.maps[i]);
            } else if (choices[i]) {
                choices[i]->target->make_map(source.harmonics, source.range, near[i],
                                             result.maps[i]);
            } else {
                result.maps[i] = prefilter_reference(map, targets_[i]);
            }
        },
        progress);
}

PrefilterPlan::PrefilterPlan(const MapShape& source, std::span<const PrefilterTarget> targets,
                             const PrefilterOptions& options)
    : plan_(std::make_shared<const Plan>(source, targets, options)) {}

Prefiltered PrefilterPlan::operator()(const EnvironmentMap& source,
                                      const Progress& progress) const {
    Prefiltered result;
    plan_->run(source, result, progress);
    return result;
}

void PrefilterPlan::operator()(const EnvironmentMap& source, Prefiltered& result,
                               const Progress& progress) const {
    plan_->run(source, result, progress);
}

const MapShape& PrefilterPlan::source() const {
    return plan_->source_;
}

std::span<const PrefilterTarget> PrefilterPlan::targets() const {
    return plan_->targets_;
}

std::vector<EnvironmentMap> prefilter(const EnvironmentMap& source,
                                      std::span<const PrefilterTarget> targets,
                                      const Progress& progress) {
    return PrefilterPlan(shape_of(source), targets)(source, progress).maps;
}

}  // namespace mirrorball
