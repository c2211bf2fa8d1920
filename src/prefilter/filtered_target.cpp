#include "prefilter/filtered_target.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <mirrorball/zonal.h>

#include "core/parallel.h"
#include "prefilter/error_estimate.h"
#include "prefilter/near_pass.h"
#include "prefilter/target.h"
#include "prefilter/zonal_series.h"

namespace mirrorball::detail {
namespace {

constexpr float kUnbounded = std::numeric_limits<float>::max();
const Vec3f kMost(kUnbounded, kUnbounded, kUnbounded);

double norm(std::size_t l) {
    return std::sqrt((2 * static_cast<double>(l) + 1) / (4 * kPi));
}

std::vector<double> squares(std::span<const double> values) {
    std::vector<double> result;
    for (const double v : values) result.push_back(v * v);
    return result;
}

// Of an upright panorama that is one everywhere: sums over rings, of degrees that do not turn as
// often as there are columns.
std::vector<double> zonal_ones(int height, int band_count) {
    std::vector<double> x, weights;
    for (int j = 0; j < (height + 1) / 2; ++j) {
        const double theta = kPi * (j + 0.5) / height;
        const bool on_equator = 2 * j + 1 == height;
        x.push_back(on_equator ? 1 : 1 - std::cos(theta));
        weights.push_back((on_equator ? 1 : 2) * 4 * kPi * std::sin(theta) *
                          std::sin(kPi / (2 * height)));
    }
    std::vector<double> sums(band_count);
    legendre_sums(x, weights, sums);
    for (std::size_t l = 0; l < sums.size(); ++l) sums[l] *= l % 2 == 0 ? norm(l) : 0;
    return sums;
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

}  // namespace

Ones::Ones(const AnalysisPlan& analysis) : harmonics_(analysis.band_count()) {
    const MapShape& shape = analysis.shape();
    if (analysis.on_rings() && shape.size >= analysis.band_count()) {
        const std::vector<double> sums = zonal_ones(shape.size / 2, analysis.band_count());
        for (std::size_t l = 0; l < sums.size(); ++l) {
            const auto sum = static_cast<float>(sums[l]);
            harmonics_.set_coefficient(static_cast<int>(l), 0, Vec3f(sum, sum, sum));
        }
        zonal_count_ = analysis.band_count();
        return;
    }
    EnvironmentMap white = make_environment_map(shape);
    for (Image& face : white.levels[0].faces)
        std::fill(face.values().begin(), face.values().end(), 1.0f);
    analysis.run(white.levels[0].faces, harmonics_);
    // with fewer columns than bands it depends on the longitude too
    if (analysis.on_rings()) zonal_count_ = shape.size;
}

FilteredTarget::FilteredTarget(const PrefilterTarget& target, const BandSplit& split,
                               bool whole_source_near, std::shared_ptr<const LegendreTable> table,
                               std::shared_ptr<ScratchPool> scratch)
    : lobe_(target.lobe),
      split_(split),
      whole_source_near_(whole_source_near),
      zonal_(split.far.begin(), split.far.end()),
      lambda_(zonal_coefficients(target.lobe, table->band_count())),
      synthesis_(shape_of(target), table, static_cast<int>(split.far.size()), squares(split.far),
                 std::move(scratch)) {
    waves_ = synthesis_.wave_errors();
    double kept = 0;
    for (std::size_t l = 0; l < lambda_.size(); ++l)
        kept += (2 * static_cast<double>(l) + 1) * lambda_[l] * lambda_[l];
    beyond_ = std::max(0.0, split.whole - kept);
}

void FilteredTarget::divide_by_sums_over(const Ones& ones, double evenness) {
    if (whole_source_near_ || !ones.is_zonal(static_cast<int>(zonal_.size()))) {
        far_sums_ = make_environment_map(synthesis_.shape());
        synthesis_.run(ones.harmonics(), zonal_, {}, -kMost, kMost, far_sums_->levels[0].faces);
        // a lobe that is wide next to the source's texels has even sums
        if (!whole_source_near_ && is_even(*far_sums_, lobe_.integral(), evenness))
            far_sums_.reset();
        return;
    }
    std::vector<double> x, series;
    for (const double theta : synthesis_.pair_colatitudes()) x.push_back(1 - std::cos(theta));
    for (std::size_t l = 0; l < split_.far.size(); ++l) {
        series.push_back(norm(l) * split_.far[l] *
                         ones.harmonics().coefficient(static_cast<int>(l), 0).x);
    }
    std::vector<double> sums(x.size());
    legendre_series(series, x, sums, {});
    for (const double sum : sums)
        ring_weights_.push_back(static_cast<float>(lobe_.integral() / sum));
}

double FilteredTarget::texels_per_light() const {
    const MapShape& shape = synthesis_.shape();
    return split_.near.support() *
           static_cast<double>(environment_map_bytes(shape.projection, shape.size) / 12);
}

double FilteredTarget::spectral_error(std::span<const double> spectrum) const {
    return relative_error(spectrum, {lambda_, split_.far, waves_, beyond_});
}

double FilteredTarget::wave_error(std::span<const double> spectrum) const {
    return relative_error(spectrum, {split_.far, split_.far, waves_, 0});
}

void FilteredTarget::make_map(const Harmonics& source, const SourceRange& range,
                              const NearField* near, EnvironmentMap& map,
                              const Progress& progress) const {
    const auto integral = static_cast<float>(lobe_.integral());
    const Vec3f lowest = range.lowest * integral, highest = range.highest * integral;
    const bool far_only = near == nullptr, done = far_only && !far_sums_;
    synthesis_.run(source, zonal_, ring_weights_, done ? lowest : -kMost, done ? highest : kMost,
                   map.levels[0].faces);
    if (whole_source_near_) {
        add_near_normalised(*near, split_.near, *far_sums_, integral, lowest, highest, map,
                            progress);
        return;
    }
    if (far_sums_) {
        divide_by_sums(*far_sums_, integral, far_only ? lowest : -kMost, far_only ? highest : kMost,
                       map);
    }
    if (near != nullptr) add_near(*near, split_.near, lowest, highest, map, progress);
}

}  // namespace mirrorball::detail
