// The order of work is in Plan::run: analyse, then each target by itself.
#include <mirrorball/prefilter.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

#include <mirrorball/error.h>
#include <mirrorball/resample.h>
#include <mirrorball/zonal.h>

#include "core/parallel.h"
#include "harmonics/transforms.h"
#include "prefilter/filtered_target.h"
#include "prefilter/target.h"
#include "prefilter/target_rules.h"

namespace mirrorball {
namespace {

using namespace detail;

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

    void make_transforms();
    void find_ones();
    [[nodiscard]] const FilteredTarget* dense_target(std::size_t i) const;

    void look_at(const EnvironmentMap& map, Source& source) const;
    [[nodiscard]] Choice choose(std::size_t i, Source& source) const;

    TargetRules rules_;
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
      rules_(source, options),
      ways_(targets.size()) {
    for (const PrefilterTarget& target : targets_) TargetRules::check(target);
    solid_angles_ =
        solid_angle_table(source.projection, source.size, source.size / aspect(source.projection));
    make_transforms();
}

void PrefilterPlan::Plan::make_transforms() {
    const auto count = static_cast<std::int64_t>(targets_.size());
    std::vector<std::optional<BandSplit>> splits(targets_.size());
    parallel_for(count, [&](std::int64_t i) {
        splits[i] = rules_.split(targets_[i]);
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
            ways_[i - 1].filtered.emplace(target, *split, rules_.takes_whole_source(target.lobe),
                                          table_, scratch_);
        }
    });
    find_ones();
}

void PrefilterPlan::Plan::find_ones() {
    bool is_uneven = analysis_->on_rings();
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        is_uneven = is_uneven || (ways_[i].filtered && !rules_.sums_evenly(targets_[i].lobe));
    }
    if (!is_uneven) return;
    ones_.emplace(*analysis_);
    parallel_for(static_cast<std::int64_t>(targets_.size()), [&](std::int64_t i) {
        if (ways_[i].filtered) ways_[i].filtered->divide_by_sums_over(*ones_, rules_.evenness());
    });
}

const FilteredTarget* PrefilterPlan::Plan::dense_target(std::size_t i) const {
    const Way& way = ways_[i];
    std::call_once(way.dense_once, [&] {
        const BandSplit split = rules_.dense_split(targets_[i].lobe, analysis_->band_count());
        if (split.far.size() <= way.filtered->far().size()) return;
        way.dense.emplace(targets_[i], split, false, table_, scratch_);
        if (ones_) way.dense->divide_by_sums_over(*ones_, rules_.evenness());
    });
    return way.dense ? &*way.dense : nullptr;
}

Choice PrefilterPlan::Plan::choose(std::size_t i, Source& source) const {
    LightLevels* const lights = source.lights ? &*source.lights : nullptr;
    const Choice usual = rules_.choose_lights(*ways_[i].filtered, source.spectrum, lights);
    if (!TargetRules::has_many_pairs(usual)) return usual;
    const FilteredTarget* const dense = dense_target(i);
    if (dense == nullptr) return usual;
    const Choice better = rules_.choose_lights(*dense, source.spectrum, lights);
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
