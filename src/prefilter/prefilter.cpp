// The order of work is in Plan::run: analyse, then each target by itself.
#include <mirrorball/prefilter.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/resample.h>
#include <mirrorball/zonal.h>

#include "core/parallel.h"
#include "harmonics/transforms.h"
#include "prefilter/band_split.h"
#include "prefilter/error_estimate.h"
#include "prefilter/legendre.h"
#include "prefilter/near_pass.h"
#include "prefilter/source_light.h"

namespace mirrorball {
namespace {

using namespace detail;

// Lobes that need more bands have the whole source in their near part, which does not grow much
// from fewer bands on.
constexpr int kMostBands = 1024, kBandsBesideWholeSource = 512;

// Texels this much brighter than the mean are lights: the near part puts them right one by one.
constexpr float kLight = 24;

// What harmonics alone are asked for, in tolerances. Bright lights are put right in space, and the
// spectrum of what is left falls, so the error comes out below: tests/prefilter has the figures.
constexpr double kSlack = 3;

constexpr float kUnbounded = std::numeric_limits<float>::max();

/// One target that is not a mere resampling.
struct Filtered {
    BandSplit split;
    std::vector<double> lambda;        // of the analysed bands
    double beyond = 0;                 // sum over all others of (2l+1) lambda_l^2
    std::vector<float> far;
    std::vector<double> waves;
    bool whole_source_near = false;    // for lobes that harmonics do not carry
    std::optional<SynthesisPlan> synthesis;
    std::vector<float> ring_weights;
    std::optional<EnvironmentMap> far_weights;
};

EnvironmentMap make_target(const PrefilterTarget& target) {
    EnvironmentMap map = make_environment_map(target.projection, target.size);
    map.axes = target.axes;
    map.levels[0].lobe = target.lobe;
    return map;
}

std::vector<double> squares(std::span<const double> values) {
    std::vector<double> result;
    for (const double v : values) result.push_back(v * v);
    return result;
}

// Typical angle between texels of a map, in radians.
double texel_angle(const MapShape& shape) {
    const double texels = static_cast<double>(environment_map_bytes(shape.projection, shape.size)) /
                          (3 * sizeof(float));
    return std::sqrt(4 * kPi / texels);
}

}  // namespace

class PrefilterPlan::Plan {
  public:
    Plan(const MapShape& source, std::span<const PrefilterTarget> targets,
         const PrefilterOptions& options);

    void run(const EnvironmentMap& source, Prefiltered& result, const Progress& progress) const;

    MapShape source_;
    std::vector<PrefilterTarget> targets_;

  private:
    void split_lobes(double tolerance);
    void make_transforms();
    void normalise();
    void run_target(std::size_t i, const Harmonics& harmonics, std::span<const double> spectrum,
                    const SourceRange& range, const NearField* lights, double below_rms,
                    const NearField* whole, Prefiltered& result) const;

    std::vector<std::optional<Filtered>> filtered_;
    std::vector<std::optional<Resampler>> resampled_;
    std::vector<double> solid_angles_;
    std::optional<AnalysisPlan> analysis_;
};

PrefilterPlan::Plan::Plan(const MapShape& source, std::span<const PrefilterTarget> targets,
                          const PrefilterOptions& options)
    : source_(source),
      targets_(targets.begin(), targets.end()),
      filtered_(targets.size()),
      resampled_(targets.size()) {
    if (!(options.tolerance > 0 && options.tolerance <= 0.1)) {
        throw Error(Errc::usage,
                    fmt::format("the tolerance must be above 0 and at most 0.1, found {}",
                                options.tolerance));
    }
    const EnvironmentMap shape = make_environment_map(source.projection, source.size);
    solid_angles_ = solid_angle_table(source.projection, shape.width(), shape.height());
    parallel_for(static_cast<std::int64_t>(targets_.size()), [&](std::int64_t i) {
        const PrefilterTarget& target = targets_[i];
        if (target.lobe.is_delta())
            resampled_[i].emplace(source, MapShape{target.projection, target.size, target.axes});
    });
    split_lobes(options.tolerance);
    make_transforms();
    normalise();
}

void PrefilterPlan::Plan::split_lobes(double tolerance) {
    const double texel = texel_angle(source_);
    parallel_for(static_cast<std::int64_t>(targets_.size()), [&](std::int64_t i) {
        const Lobe& lobe = targets_[i].lobe;
        if (lobe.is_delta()) return;
        Filtered& f = filtered_[i].emplace();
        f.whole_source_near =
            band_count(lobe, tolerance) > kMostBands || lobe.angle_holding(0.5) < 2 * texel;
        f.split = split_bands(lobe, std::min(0.1, kSlack * tolerance),
                              f.whole_source_near ? kBandsBesideWholeSource : kMostBands);
        f.far.assign(f.split.far.begin(), f.split.far.end());
    });
}

void PrefilterPlan::Plan::make_transforms() {
    const Filtered* finest = nullptr;
    for (const auto& f : filtered_) {
        if (f && (finest == nullptr || f->far.size() > finest->far.size())) finest = &*f;
    }
    if (finest == nullptr) return;
    const int band_count = static_cast<int>(finest->far.size());
    const auto table = std::make_shared<const LegendreTable>(band_count);
    const auto scratch = std::make_shared<ScratchPool>();
    // the analysis and every target's synthesis, the analysis first
    parallel_for(static_cast<std::int64_t>(targets_.size()) + 1, [&](std::int64_t i) {
        if (i == 0) {
            analysis_.emplace(source_, table, band_count, squares(finest->split.far), scratch);
            return;
        }
        auto& f = filtered_[i - 1];
        if (!f) return;
        const PrefilterTarget& target = targets_[i - 1];
        const std::vector<double> power = squares(f->split.far);
        f->synthesis.emplace(MapShape{target.projection, target.size, target.axes}, table,
                             static_cast<int>(f->far.size()), power, scratch);
        f->waves = f->synthesis->wave_errors(power);
        f->lambda = zonal_coefficients(target.lobe, band_count);
        double kept = 0;
        for (int l = 0; l < band_count; ++l) kept += (2 * l + 1) * f->lambda[l] * f->lambda[l];
        f->beyond = std::max(0.0, f->split.whole - kept);
    });
}

// Divides by the lobes' own sums over the source, whose points and areas integrate no lobe quite to
// one. Where the source is a panorama that sum depends on the latitude alone.
void PrefilterPlan::Plan::normalise() {
    if (!analysis_) return;
    EnvironmentMap white = make_environment_map(source_.projection, source_.size);
    for (Image& face : white.levels[0].faces) std::ranges::fill(face.values(), 1.0f);
    Harmonics ones(analysis_->band_count());
    analysis_->run(white.levels[0].faces, ones);
    parallel_for(static_cast<std::int64_t>(targets_.size()), [&](std::int64_t i) {
        if (!filtered_[i]) return;
        Filtered& f = *filtered_[i];
        if (f.whole_source_near) {
            f.far_weights = make_target(targets_[i]);
            f.synthesis->run(ones, f.far, {}, Vec3f(-kUnbounded, -kUnbounded, -kUnbounded),
                             Vec3f(kUnbounded, kUnbounded, kUnbounded),
                             f.far_weights->levels[0].faces);
            return;
        }
        if (!analysis_->on_rings()) return;
        const std::vector<double> colatitudes = f.synthesis->pair_colatitudes();
        std::vector<double> x, sums(colatitudes.size()), series;
        for (const double theta : colatitudes) x.push_back(1 - std::cos(theta));
        for (std::size_t l = 0; l < f.far.size(); ++l) {
            const double norm = std::sqrt((2 * static_cast<double>(l) + 1) / (4 * kPi));
            series.push_back(norm * f.split.far[l] *
                             ones.coefficient(static_cast<int>(l), 0).x);
        }
        legendre_series(series, x, sums, {});
        for (const double sum : sums)
            f.ring_weights.push_back(static_cast<float>(targets_[i].lobe.integral() / sum));
    });
}

void PrefilterPlan::Plan::run_target(std::size_t i, const Harmonics& harmonics,
                                     std::span<const double> spectrum, const SourceRange& range,
                                     const NearField* lights, double below_rms,
                                     const NearField* whole, Prefiltered& result) const {
    const Filtered& f = *filtered_[i];
    EnvironmentMap& map = result.maps[i];
    const float integral = static_cast<float>(targets_[i].lobe.integral());
    const Vec3f lowest = range.lowest * integral, highest = range.highest * integral;
    const bool clamp_later = whole != nullptr || lights != nullptr;
    const Vec3f bound(kUnbounded, kUnbounded, kUnbounded);
    f.synthesis->run(harmonics, f.far, f.ring_weights, clamp_later ? -bound : lowest,
                     clamp_later ? bound : highest, map.levels[0].faces);
    if (f.whole_source_near)
        add_near_normalised(*whole, f.split.near, *f.far_weights, integral, lowest, highest, map);
    else if (clamp_later)
        add_near(lights != nullptr ? *lights : NearField({}), f.split.near, lowest, highest, map);
    double error = estimated_error(spectrum, {f.lambda, f.split.far, f.waves, f.beyond});
    if (f.whole_source_near) {
        error = estimated_error(spectrum, {f.split.far, f.split.far, f.waves, 0});
    } else if (lights != nullptr) {
        // with its lights put right, what is off is at most the lobe's tail of what is left
        const double waves = estimated_error(spectrum, {f.split.far, f.split.far, f.waves, 0});
        error = std::min(error, waves + f.split.tail * below_rms);
    }
    result.errors[i] = error;
}

void PrefilterPlan::Plan::run(const EnvironmentMap& source, Prefiltered& result,
                              const Progress& progress) const {
    if (shape_of(source) != source_)
        throw Error(Errc::usage, "the map to prefilter is not of the shape that was planned for");
    if (result.maps.size() != targets_.size()) {
        result.maps.resize(targets_.size());
        for (std::size_t i = 0; i < targets_.size(); ++i) result.maps[i] = make_target(targets_[i]);
    }
    result.errors.assign(targets_.size(), 0);

    const SourceRange range = range_of(source, solid_angles_);
    Harmonics harmonics(analysis_ ? analysis_->band_count() : 0);
    if (analysis_) analysis_->run(source.levels[0].faces, harmonics);
    const std::vector<double> spectrum = power_spectrum(harmonics);

    std::optional<NearField> lights, whole;
    double below_rms = 0;
    const float threshold = kLight * static_cast<float>(range.mean);
    const float brightest = std::max({range.highest.x, range.highest.y, range.highest.z});
    if (analysis_ && brightest > threshold) {
        lights.emplace(lights_above(source, solid_angles_, threshold));
        const double rms = std::sqrt(mean_square_below(source, solid_angles_, threshold));
        below_rms = range.mean > 0 ? rms / range.mean : 0;
    }
    for (const auto& f : filtered_) {
        if (f && f->whole_source_near && !whole)
            whole.emplace(all_lights(source, solid_angles_));
    }

    parallel_for(static_cast<std::int64_t>(targets_.size()), [&](std::int64_t i) {
        if (resampled_[i])
            (*resampled_[i])(source, result.maps[i]);
        else
            run_target(static_cast<std::size_t>(i), harmonics, spectrum, range,
                       lights ? &*lights : nullptr, below_rms, whole ? &*whole : nullptr, result);
    }, progress);
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
