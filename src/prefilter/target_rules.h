// How a target is made of a source: what of its lobe harmonics carry, and which lights of the
// source are put right in space.
#pragma once

#include <optional>
#include <span>

#include <mirrorball/prefilter.h>

#include "prefilter/band_split.h"
#include "prefilter/filtered_target.h"
#include "prefilter/source_light.h"

namespace mirrorball::detail {

// So many bands of a source cost next to nothing.
inline constexpr int kFewBands = 192;

/// How a target is made for a source.
struct Choice {
    const FilteredTarget* target;
    std::optional<std::size_t> light_level = {};
    double pair_count = 0;  // of lights and texels
    double error = 0;       // as estimated
};

/// For sources of one shape.
class TargetRules {
  public:
    /// \throws Error(Errc::usage) for a size or tolerance out of range
    TargetRules(const MapShape& source, const PrefilterOptions& options);

    /// \throws Error(Errc::usage) for a size out of range, and a table known by name only
    static void check(const PrefilterTarget& target);

    /// None if harmonics are no use: the lobe is a delta, or so narrow that the reference's sum is
    /// what is wanted.
    [[nodiscard]] std::optional<BandSplit> split(const PrefilterTarget& target) const;
    /// With more bands and fewer lights, for sources with too many.
    [[nodiscard]] BandSplit dense_split(const Lobe& lobe, int most_bands) const;
    /// Is every texel of the source in the near part of this lobe?
    [[nodiscard]] bool takes_whole_source(const Lobe& lobe) const;
    /// Does it take neither that nor many bands? Costs nothing to ask.
    [[nodiscard]] bool is_quick(const Lobe& lobe) const;
    /// Do sums over the lobe hardly change from texel to texel?
    [[nodiscard]] bool sums_evenly(const Lobe& lobe) const;
    /// What sums over lobes may differ by and count as equal.
    [[nodiscard]] double evenness() const;

    /// For a source with this spectrum, and these lights if there is light at all: they are taken
    /// from the brightest on as long as they are cheap, and then as long as the
    /// error is too large.
    [[nodiscard]] Choice choose_lights(const FilteredTarget& target,
                                       std::span<const double> spectrum, LightLevels* lights) const;
    /// Are there more lights and texels than more bands would cost?
    [[nodiscard]] static bool has_many_pairs(const Choice& choice);

  private:
    MapShape source_;
    double tolerance_;
};

}  // namespace mirrorball::detail
