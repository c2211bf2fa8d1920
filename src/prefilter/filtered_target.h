// One target as a plan has it: what of its lobe harmonics carry, what is put right in space, and
// how its map is put together from both.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <mirrorball/prefilter.h>

#include "harmonics/transforms.h"
#include "prefilter/band_split.h"
#include "prefilter/near_field.h"
#include "prefilter/source_light.h"

namespace mirrorball::detail {

/// A source that is one everywhere, in harmonics. Its texels' points and areas integrate no lobe
/// quite to one; results are divided by what they do.
class Ones {
  public:
    explicit Ones(const AnalysisPlan& analysis);

    [[nodiscard]] const Harmonics& harmonics() const { return harmonics_; }
    /// Do so many bands of it depend on the latitude alone?
    [[nodiscard]] bool is_zonal(int band_count) const { return band_count <= zonal_count_; }

  private:
    Harmonics harmonics_;
    int zonal_count_ = 0;
};

class FilteredTarget {
  public:
    /// If `whole_source_near`, every texel of the source is in the near part, for lobes that
    /// harmonics do not carry.
    FilteredTarget(const PrefilterTarget& target, const BandSplit& split, bool whole_source_near,
                   std::shared_ptr<const LegendreTable> table,
                   std::shared_ptr<ScratchPool> scratch);
    /// Sums over the lobe that differ by less than `evenness` count as equal.
    void divide_by_sums_over(const Ones& ones, double evenness);

    [[nodiscard]] const std::vector<double>& far() const { return split_.far; }
    [[nodiscard]] bool whole_source_near() const { return whole_source_near_; }
    /// Texels of the map that one light reaches.
    [[nodiscard]] double texels_per_light() const;

    /// Of the map by harmonics alone: its relative error in root mean square, from the spectrum of
    /// the source.
    [[nodiscard]] double spectral_error(std::span<const double> spectrum) const;
    /// Of that, what no light's near part puts right.
    [[nodiscard]] double wave_error(std::span<const double> spectrum) const;
    /// What harmonics lack of a single lit texel's image, in root mean square, relative.
    [[nodiscard]] double tail() const { return split_.tail; }

    /// `near` has the lights to be put right, or the whole source; or it is null. Results are
    /// clamped to the source's range.
    void make_map(const Harmonics& source, const SourceRange& range, const NearField* near,
                  EnvironmentMap& map, const Progress& progress = {}) const;

  private:
    Lobe lobe_;
    BandSplit split_;
    bool whole_source_near_;
    std::vector<float> zonal_;  // split_.far
    std::vector<double> lambda_, waves_;
    double beyond_ = 0;  // of (2l+1) lambda_l^2, what is not in lambda_
    SynthesisPlan synthesis_;
    // Of the sums over the lobe, one or the other, or neither where they are even.
    std::vector<float> ring_weights_;
    std::optional<EnvironmentMap> far_sums_;
};

}  // namespace mirrorball::detail
