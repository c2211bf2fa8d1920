// The order of work is in Plan::run: analyse, then each target by itself.
#include <mirrorball/prefilter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/resample.h>
#include <mirrorball/zonal.h>

#include "core/parallel.h"
#include "harmonics/transforms.h"
#include "image/map_size.h"
#include "prefilter/band_split.h"
#include "prefilter/error_estimate.h"
#include "prefilter/near_pass.h"
#include "prefilter/source_light.h"
#include "prefilter/zonal_series.h"

namespace mirrorball {
namespace {

using namespace detail;

// Lobes that need more bands have the whole source in their near part, which does not grow much
// from fewer bands on.
constexpr int kMostBands = 1024, kBandsBesideWholeSource = 512;

// Texels that are this many times as bright as the mean are lights: the near part puts them right
// one by one. Where there are so many that this would cost more than all else, for a lobe with a
// wide near part, fewer are; where the spectrum says that it is not enough, more.
constexpr float kLights[] = {0, 1.5, 6, 24, 48, 96, 192, 384};
constexpr std::size_t kUsualLights = 3;
constexpr double kMostPairs = 5e5;  // of lights and texels, about a nanosecond each
constexpr std::size_t kMostLights = 2000;
constexpr double kEnough = 1.5;  // tolerances, as estimated, which is on the safe side

// What harmonics alone are asked for of a single lit texel, in tolerances: such a texel is put
// right in space, and the spectra of all else fall, so that the error comes out far below.
constexpr double kSlack = 10;

// Between the texels of a small source a lobe much narrower than they are is all tail, and that
// lies below what single precision holds next to its peak. And what a handful of texels adds up to
// has steps. Both are summed as the reference does.
constexpr double kNarrowest = 0.125;  // half of the lobe's light, in texels
constexpr double kFewTexels = 64;
constexpr double kMostSummedPairs = 1e9;

// Lobes that hold half of their light within so many texels have sums, over the texels around them,
// that change from texel to texel: they have the whole source in their near part, too.
constexpr double kWholeSource = 2.5;

// What is estimated is a mean over the sphere; maps of few texels show up to thrice as much. And
// what single precision adds: of directions, next to lobes that are nearly deltas, and of sums.
constexpr double kShown = 3, kNearDelta = 5e-4, kRounding = 2e-6;

// Sums over a lobe that differ by less than this, in tolerances, count as equal.
constexpr double kEvenness = 0.05;

// So do all of them where half of the lobe's light takes more texels than this: they differ by the
// square of that ratio, 3e-5 here.
constexpr double kEvenFrom = 5;

constexpr float kUnbounded = std::numeric_limits<float>::max();

/// What is known of a source before its targets are made.
struct Source {
    SourceRange range;
    Harmonics harmonics;
    std::vector<double> spectrum;
    double deviation = 0;  // from the mean over the sphere, over the mean
    // The texels above each of kLights that a target needs, and the deviation of what they leave
    // over the mean.
    struct Lights {
        NearField field;
        double rest;
    };
    std::array<std::optional<Lights>, std::size(kLights)> lights;
    std::vector<std::optional<std::size_t>> choices;  // of each target, among them
    std::optional<NearField> whole;                   // every texel, if a target needs them
};

/// One target that is not a mere resampling.
struct Filtered {
    BandSplit split;
    std::vector<double> lambda;  // of the analysed bands
    double beyond = 0;           // sum over all others of (2l+1) lambda_l^2
    std::vector<float> far;
    std::vector<double> waves;
    bool whole_source_near = false;  // for lobes that harmonics do not carry
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

// Is it what an earlier run made for this target?
bool is_for(const EnvironmentMap& map, const PrefilterTarget& target) {
    return map.levels.size() == 1 && map.levels[0].lobe == target.lobe &&
           shape_of(map) == MapShape{target.projection, target.size, target.axes};
}

// Are all used texels this near to `value`, relatively?
bool is_even(const EnvironmentMap& map, double value, double tolerance) {
    const LevelStatistics s = statistics(map);
    return s.minimum.x >= value * (1 - tolerance) && s.maximum.x <= value * (1 + tolerance);
}

// Texels over the lobe's own sum around them, times its integral.
void divide_by_sums(const EnvironmentMap& sums, float integral, const Vec3f& lowest,
                    const Vec3f& highest, EnvironmentMap& map) {
    const int height = map.height();
    parallel_for(
        static_cast<std::int64_t>(map.levels[0].faces.size()) * height, [&](std::int64_t row) {
            const auto face = static_cast<std::size_t>(row / height);
            const int y = static_cast<int>(row % height);
            const std::span<const float> by = sums.levels[0].faces[face].row(y);
            const std::span<float> values = map.levels[0].faces[face].row(y);
            for (std::size_t i = 0; i < values.size(); ++i) {
                if (by[i] == 0) continue;  // unused
                const int c = static_cast<int>(i % 3);
                values[i] = std::clamp(values[i] * (integral / by[i]), lowest[c], highest[c]);
            }
        });
}

std::vector<double> squares(std::span<const double> values) {
    std::vector<double> result;
    for (const double v : values) result.push_back(v * v);
    return result;
}

double texel_count(const MapShape& shape) {
    return static_cast<double>(environment_map_bytes(shape.projection, shape.size)) /
           (3 * sizeof(float));
}

// Typical angle between texels of a map, in radians.
double texel_angle(const MapShape& shape) {
    return std::sqrt(4 * kPi / texel_count(shape));
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
    [[nodiscard]] double spectral_error(const Filtered& f, std::span<const double> spectrum) const {
        return estimated_error(spectrum, {f.lambda, f.split.far, f.waves, f.beyond});
    }
    // Of what the near part has nothing to do with.
    [[nodiscard]] double wave_error(const Filtered& f, std::span<const double> spectrum) const {
        return estimated_error(spectrum, {f.split.far, f.split.far, f.waves, 0});
    }
    void find_lights(const EnvironmentMap& source, Source& s) const;
    void run_target(std::size_t i, const Source& source, Prefiltered& result) const;

    double tolerance_;

    // Of each target one or the other, or neither where the reference's sum is made.
    std::vector<std::optional<Filtered>> filtered_;
    std::vector<std::optional<Resampler>> resampled_;
    std::vector<double> solid_angles_;
    std::optional<AnalysisPlan> analysis_;
};

PrefilterPlan::Plan::Plan(const MapShape& source, std::span<const PrefilterTarget> targets,
                          const PrefilterOptions& options)
    : source_(source),
      targets_(targets.begin(), targets.end()),
      tolerance_(options.tolerance),
      filtered_(targets.size()),
      resampled_(targets.size()) {
    if (!(options.tolerance > 0 && options.tolerance <= 0.1)) {
        throw Error(Errc::usage,
                    fmt::format("the tolerance must be above 0 and at most 0.1, found {}",
                                options.tolerance));
    }
    for (const PrefilterTarget& target : targets_) {
        check_map_size(target.projection, target.size);
        (void)target.lobe.value(1);  // refuses tables that have no values
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
        const PrefilterTarget& target = targets_[i];
        const double pair_count =
            texel_count(source_) * texel_count({target.projection, target.size, target.axes});
        const bool beyond_harmonics =
            lobe.angle_holding(0.5) < kNarrowest * texel || texel_count(source_) <= kFewTexels;
        if (beyond_harmonics && pair_count <= kMostSummedPairs) return;
        Filtered& f = filtered_[i].emplace();
        f.whole_source_near = band_count(lobe, tolerance) > kMostBands ||
                              lobe.angle_holding(0.5) < kWholeSource * texel;
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
        f->waves = f->synthesis->wave_errors();
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
    bool is_uneven = analysis_->on_rings();
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        if (!filtered_[i]) continue;
        const double half = targets_[i].lobe.angle_holding(0.5);
        is_uneven = is_uneven || half < kEvenFrom * texel_angle(source_);
    }
    if (!is_uneven) return;
    EnvironmentMap white = make_environment_map(source_.projection, source_.size);
    for (Image& face : white.levels[0].faces) std::ranges::fill(face.values(), 1.0f);
    Harmonics ones(analysis_->band_count());
    analysis_->run(white.levels[0].faces, ones);
    parallel_for(static_cast<std::int64_t>(targets_.size()), [&](std::int64_t i) {
        if (!filtered_[i]) return;
        Filtered& f = *filtered_[i];
        // with fewer columns than bands it depends on the longitude too
        const bool by_latitude =
            analysis_->on_rings() && static_cast<std::size_t>(source_.size) >= f.far.size();
        if (f.whole_source_near || !by_latitude) {
            f.far_weights = make_target(targets_[i]);
            f.synthesis->run(ones, f.far, {}, Vec3f(-kUnbounded, -kUnbounded, -kUnbounded),
                             Vec3f(kUnbounded, kUnbounded, kUnbounded),
                             f.far_weights->levels[0].faces);
            // a lobe that is wide next to the source's texels has even sums
            if (!f.whole_source_near &&
                is_even(*f.far_weights, targets_[i].lobe.integral(), kEvenness * tolerance_))
                f.far_weights.reset();
            return;
        }
        const std::vector<double> colatitudes = f.synthesis->pair_colatitudes();
        std::vector<double> x, sums(colatitudes.size()), series;
        for (const double theta : colatitudes) x.push_back(1 - std::cos(theta));
        for (std::size_t l = 0; l < f.far.size(); ++l) {
            const double norm = std::sqrt((2 * static_cast<double>(l) + 1) / (4 * kPi));
            series.push_back(norm * f.split.far[l] * ones.coefficient(static_cast<int>(l), 0).x);
        }
        legendre_series(series, x, sums, {});
        for (const double sum : sums)
            f.ring_weights.push_back(static_cast<float>(targets_[i].lobe.integral() / sum));
    });
}

void PrefilterPlan::Plan::find_lights(const EnvironmentMap& source, Source& s) const {
    s.choices.resize(targets_.size());
    const float brightest = std::max({s.range.highest.x, s.range.highest.y, s.range.highest.z});
    const Vec3f first = s.harmonics.coefficient(0, 0);
    const float mean =
        (first.x + first.y + first.z) / 3 * static_cast<float>(std::sqrt(1 / (4 * kPi)));
    if (!(mean > 0)) return;
    double square = 0;
    for (std::size_t l = 1; l < s.spectrum.size(); ++l) square += s.spectrum[l];
    s.deviation = std::sqrt(square / (3 * 4 * kPi)) / mean;
    std::array<std::vector<Light>, std::size(kLights)> found;
    const auto lights = [&](std::size_t level) -> const std::vector<Light>& {
        if (found[level].empty())
            found[level] = lights_above(source, solid_angles_, s.range, kLights[level] * mean);
        return found[level];
    };
    std::array<std::optional<double>, std::size(kLights)> rests;
    const auto rest = [&](std::size_t level) {
        if (!rests[level])
            rests[level] = deviation_below(source, solid_angles_, kLights[level] * mean) / mean;
        return *rests[level];
    };
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        if (!filtered_[i] || filtered_[i]->whole_source_near) continue;
        const Filtered& f = *filtered_[i];
        const double pairs_per_light = f.split.near.support() * texel_count(f.synthesis->shape());
        if (pairs_per_light == 0) continue;
        std::optional<std::size_t> choice;
        for (std::size_t level = kUsualLights; level < std::size(kLights) && !choice; ++level) {
            if (brightest <= kLights[level] * mean) break;
            const std::size_t count = lights(level).size();
            if (count <= kMostLights && static_cast<double>(count) * pairs_per_light <= kMostPairs)
                choice = level;
        }
        const double unlit = spectral_error(f, s.spectrum);
        if (unlit > tolerance_) {
            std::size_t level = choice.value_or(kUsualLights);
            while (level > 0 && unlit * rest(level) > kEnough * tolerance_ * s.deviation) --level;
            if (brightest > kLights[level] * mean) choice = level;
        }
        s.choices[i] = choice;
        if (choice && !s.lights[*choice])
            s.lights[*choice].emplace(Source::Lights{NearField(lights(*choice)), rest(*choice)});
    }
}

void PrefilterPlan::Plan::run_target(std::size_t i, const Source& source,
                                     Prefiltered& result) const {
    const Filtered& f = *filtered_[i];
    EnvironmentMap& map = result.maps[i];
    const float integral = static_cast<float>(targets_[i].lobe.integral());
    const Vec3f lowest = source.range.lowest * integral, highest = source.range.highest * integral;
    const bool has_near = f.whole_source_near || source.choices[i];
    const Vec3f bound(kUnbounded, kUnbounded, kUnbounded);
    const bool unfinished = has_near || f.far_weights;
    f.synthesis->run(source.harmonics, f.far, f.ring_weights, unfinished ? -bound : lowest,
                     unfinished ? bound : highest, map.levels[0].faces);
    double& error = result.errors[i];
    error = spectral_error(f, source.spectrum);
    if (f.whole_source_near) {
        add_near_normalised(*source.whole, f.split.near, *f.far_weights, integral, lowest, highest,
                            map);
        error = kShown * wave_error(f, source.spectrum) + kNearDelta;
        return;
    }
    if (f.far_weights) {
        divide_by_sums(*f.far_weights, integral, has_near ? -bound : lowest,
                       has_near ? bound : highest, map);
    }
    if (source.choices[i]) {
        const Source::Lights& lights = *source.lights[*source.choices[i]];
        add_near(lights.field, f.split.near, lowest, highest, map);
        // what is left has less of everything, of fine detail even more so, and cannot be off by
        // more than the lobe's tail of it
        error = wave_error(f, source.spectrum) +
                std::min(error * lights.rest / source.deviation, f.split.tail * lights.rest);
    }
    error = kShown * error + kRounding;
}

void PrefilterPlan::Plan::run(const EnvironmentMap& source, Prefiltered& result,
                              const Progress& progress) const {
    if (shape_of(source) != source_)
        throw Error(Errc::usage, "the map to prefilter is not of the shape that was planned for");
    result.maps.resize(targets_.size());
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        if (!is_for(result.maps[i], targets_[i])) result.maps[i] = make_target(targets_[i]);
    }
    result.errors.assign(targets_.size(), 0);

    Source s{range_of(source, solid_angles_),
             Harmonics(analysis_ ? analysis_->band_count() : 0),
             {},
             0,
             {},
             {},
             {}};
    if (analysis_) {
        analysis_->run(source.levels[0].faces, s.harmonics);
        s.spectrum = power_spectrum(s.harmonics);
        find_lights(source, s);
    }
    const auto needs_whole = [](const auto& f) { return f && f->whole_source_near; };
    if (std::ranges::any_of(filtered_, needs_whole))
        s.whole.emplace(all_lights(source, solid_angles_));

    parallel_for(
        static_cast<std::int64_t>(targets_.size()),
        [&](std::int64_t i) {
            if (resampled_[i])
                (*resampled_[i])(source, result.maps[i]);
            else if (filtered_[i])
                run_target(static_cast<std::size_t>(i), s, result);
            else
                result.maps[i] = prefilter_reference(source, targets_[i]);
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
