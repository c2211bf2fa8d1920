// What prefiltering needs to know of a source's texels besides their harmonics.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <mirrorball/environment_map.h>

#include "prefilter/near_field.h"

namespace mirrorball::detail {

struct SourceRange {
    Vec3f lowest, highest;    ///< per channel
    std::vector<float> rows;  ///< greatest value of each row, face after face
};

/// Over the used texels of level 0.
/// \throws Error(Errc::usage) if a value is not finite: one would be in every result
[[nodiscard]] SourceRange range_of(const EnvironmentMap& map,
                                   const std::vector<double>& solid_angles);

/// Every used texel.
[[nodiscard]] std::vector<Light> all_lights(const EnvironmentMap& map,
                                            const std::vector<double>& solid_angles);

/// A source's bright texels, above thresholds that rise from level to level, in multiples of its
/// mean. What of a texel is above the threshold is a light, in any channel: with that taken off,
/// what is left has no lights, and no new edges either. All is found when it is first asked for.
class LightLevels {
  public:
    static constexpr std::array<float, 9> kThresholds = {0, 1.5, 6, 24, 48, 96, 192, 384, 1536};
    /// Lights at this level and above take one pass over the source, all together.
    static constexpr std::size_t kUsual = 3;

    /// \pre mean > 0; all others live as long as this
    LightLevels(const EnvironmentMap& map, const std::vector<double>& solid_angles,
                const SourceRange& range, float mean);

    [[nodiscard]] bool any(std::size_t level) const { return brightest_ > threshold(level); }
    [[nodiscard]] const std::vector<Light>& lights(std::size_t level);
    [[nodiscard]] std::size_t count(std::size_t level) { return lights(level).size(); }
    [[nodiscard]] const NearField& field(std::size_t level);

    /// The standard deviation, over the sphere and the channels and over the mean, of the source
    /// and of what the lights of a level leave of it.
    [[nodiscard]] double deviation();
    [[nodiscard]] double rest(std::size_t level);

  private:
    // Integrals over the sphere, all channels together.
    struct Moments {
        double first = 0, second = 0;
    };

    [[nodiscard]] float threshold(std::size_t level) const { return kThresholds[level] * mean_; }
    [[nodiscard]] static double deviation_of(const Moments& moments);
    [[nodiscard]] Moments moments_below(float threshold) const;
    // With what is above the usual level's threshold cut off at `limit`.
    [[nodiscard]] double deviation_from_usual(float limit);

    const EnvironmentMap& map_;
    const std::vector<double>& solid_angles_;
    const SourceRange& range_;
    float mean_, brightest_;
    struct Level {
        std::optional<std::vector<Light>> lights;
        std::optional<NearField> field;
        std::optional<double> rest;
    };
    std::array<Level, kThresholds.size()> levels_;
    std::optional<Moments> usual_moments_;
    std::optional<double> deviation_;
};

}  // namespace mirrorball::detail
