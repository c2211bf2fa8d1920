// What PrefilterPlan does for targets that are known beforehand, for one after the other.
//
// How many bands a lobe needs differs by a hundred times, and what analysing them takes by more. So
// there are a few band counts to choose from, each with its own analysis, made when a lobe first
// asks for that many. Which one serves a lobe depends on nothing else: nor do, then, its bits.
#include <mirrorball/prefilter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <mirrorball/zonal.h>

#include "core/part_of.h"
#include "harmonics/transforms.h"
#include "prefilter/filtered_target.h"
#include "prefilter/source_light.h"
#include "prefilter/target.h"
#include "prefilter/target_rules.h"

namespace mirrorball {
namespace {

using namespace detail;

constexpr std::array kBandCounts = {kFewBands, 512, 1024};

constexpr double kAnalysisShare = 0.5;  // of the progress, where it is still to be done

// Of what lobes that need so many bands leave of each: GGX falls to 1e-3 there.
std::vector<double> power_for(int band_count) {
    const double alpha = 4.5 / band_count;
    std::vector<double> power = zonal_coefficients({Lobe::Kind::ggx, std::sqrt(alpha)}, band_count);
    for (double& factor : power) factor *= factor;
    return power;
}

// A source in so many bands.
struct Analysed {
    Analysed(const EnvironmentMap& source, int band_count, std::shared_ptr<ScratchPool> scratch,
             const Progress& progress)
        : table(std::make_shared<const LegendreTable>(band_count)),
          analysis(shape_of(source), table, band_count, power_for(band_count), std::move(scratch)),
          harmonics(band_count) {
        analysis.run(source.levels[0].faces, harmonics, progress);
        spectrum = power_spectrum(harmonics);
    }

    const Ones& ones() {
        if (!ones_) ones_.emplace(analysis);
        return *ones_;
    }

    std::shared_ptr<const LegendreTable> table;
    AnalysisPlan analysis;
    Harmonics harmonics;
    std::vector<double> spectrum;

  private:
    std::optional<Ones> ones_;
};

}  // namespace

class LobeFilter::Impl {
  public:
    Impl(std::shared_ptr<const EnvironmentMap> source, const PrefilterOptions& options)
        : source_(std::move(source)),
          rules_(shape_of(*source_), options),
          solid_angles_(
              solid_angle_table(source_->projection, source_->width(), source_->height())),
          range_(range_of(*source_, solid_angles_)) {}

    EnvironmentMap make(const PrefilterTarget& target, const Progress& progress);
    [[nodiscard]] bool is_quick(const PrefilterTarget& target) const;

    std::shared_ptr<const EnvironmentMap> source_;

  private:
    Analysed& analysed(std::size_t band_count, const Progress& progress = {});
    LightLevels* lights();
    const NearField& whole();
    FilteredTarget filtered(const PrefilterTarget& target, const BandSplit& split,
                            Analysed& analysed);

    TargetRules rules_;
    std::vector<double> solid_angles_;
    SourceRange range_;
    std::shared_ptr<ScratchPool> scratch_ = std::make_shared<ScratchPool>();
    std::array<std::optional<Analysed>, kBandCounts.size()> analysed_;
    std::optional<LightLevels> lights_;
    std::optional<NearField> whole_;
};

// The one with so many bands or the next more.
Analysed& LobeFilter::Impl::analysed(std::size_t band_count, const Progress& progress) {
    std::size_t i = 0;
    while (static_cast<std::size_t>(kBandCounts[i]) < band_count) ++i;
    if (!analysed_[i]) analysed_[i].emplace(*source_, kBandCounts[i], scratch_, progress);
    return *analysed_[i];
}

// None of a source without light.
LightLevels* LobeFilter::Impl::lights() {
    if (!lights_) {
        const Vec3f first = analysed(1).harmonics.coefficient(0, 0);
        const double mean = (first.x + first.y + first.z) / 3 * std::sqrt(1 / (4 * kPi));
        if (mean <= 0) return nullptr;
        lights_.emplace(*source_, solid_angles_, range_, static_cast<float>(mean));
    }
    return &*lights_;
}

const NearField& LobeFilter::Impl::whole() {
    if (!whole_) whole_.emplace(all_lights(*source_, solid_angles_));
    return *whole_;
}

FilteredTarget LobeFilter::Impl::filtered(const PrefilterTarget& target, const BandSplit& split,
                                          Analysed& analysed) {
    FilteredTarget result(target, split, rules_.takes_whole_source(target.lobe), analysed.table,
                          scratch_);
    if (analysed.analysis.on_rings() || !rules_.sums_evenly(target.lobe))
        result.divide_by_sums_over(analysed.ones(), rules_.evenness());
    return result;
}

EnvironmentMap LobeFilter::Impl::make(const PrefilterTarget& target, const Progress& progress) {
    TargetRules::check(target);
    if (target.lobe.is_delta()) return mirror_target(*source_, target, progress);
    const std::optional<BandSplit> split = rules_.split(target);
    if (!split) return prefilter_reference(*source_, target, progress);

    Analysed& source = analysed(split->far.size(), part_of(progress, 0, kAnalysisShare));
    const FilteredTarget usual = filtered(target, *split, source);
    Choice choice = rules_.choose_lights(usual, source.spectrum, lights());
    std::optional<FilteredTarget> dense;
    if (TargetRules::has_many_pairs(choice)) {
        const BandSplit denser = rules_.dense_split(target.lobe, source.analysis.band_count());
        if (denser.far.size() > usual.far().size()) {
            dense.emplace(filtered(target, denser, source));
            const Choice other = rules_.choose_lights(*dense, source.spectrum, lights());
            if (other.pair_count < choice.pair_count) choice = other;
        }
    }
    const NearField* near = nullptr;
    if (choice.target->whole_source_near()) {
        near = &whole();
    } else if (choice.light_level) {
        near = &lights()->field(*choice.light_level);
    }
    EnvironmentMap map = make_target(target);
    choice.target->make_map(source.harmonics, range_, near, map,
                            part_of(progress, kAnalysisShare, 1));
    return map;
}

bool LobeFilter::Impl::is_quick(const PrefilterTarget& target) const {
    return target.lobe.is_delta() || rules_.is_quick(target.lobe);
}

LobeFilter::LobeFilter(std::shared_ptr<const EnvironmentMap> source,
                       const PrefilterOptions& options)
    : impl_(std::make_unique<Impl>(std::move(source), options)) {}

LobeFilter::~LobeFilter() = default;

EnvironmentMap LobeFilter::operator()(const PrefilterTarget& target, const Progress& progress) {
    return impl_->make(target, progress);
}

bool LobeFilter::is_quick(const PrefilterTarget& target) const {
    return impl_->is_quick(target);
}

const EnvironmentMap& LobeFilter::source() const {
    return *impl_->source_;
}

}  // namespace mirrorball
