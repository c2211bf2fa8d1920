// Interpolation on a regular grid by eight weights.
//
// The weights for a point between two grid values are those that reproduce a wave exp(i l x) best,
// in the least-squares sense, over the waves that are there: degrees l weighted by the power that
// they have (that of the lobe's own coefficients, the case of one lit texel), and constants
// exactly. Next to Lagrange's weights, which are exact for polynomials, that is three to ten times
// closer on the same grid; figures are in docs/theory/spectral-prefiltering.md.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/aligned.h"

namespace mirrorball::detail {

inline constexpr int kTapCount = 8;

/// Weights for any fraction of a step.
class TapDesign {
  public:
    /// `power[l]` of waves exp(i l x), on a grid of step `step` (radians).
    TapDesign(std::span<const double> power, double step);

    /// For the point `fraction` in [0, 1) after the fourth of eight grid values.
    void weights(double fraction, float* to) const;

    /// Of waves exp(i l x) for l < count: the rms over all fractions of what they come out wrong
    /// by.
    [[nodiscard]] std::vector<double> wave_errors(double step, int count) const;

  private:
    std::vector<float> table_;  // [entry][tap]
};

/// Taps of many points.
struct TapList {
    std::vector<std::int32_t> first;  ///< index of the first of eight grid values
    AlignedArray<float> weights;      ///< [point][tap], and room to read a vector from the last

    TapList() = default;
    explicit TapList(std::size_t count) : first(count), weights(count * kTapCount + 16) {}

    /// For the point at `position`, in steps from grid value 0.
    void set(std::size_t point, double position, const TapDesign& design);
};

}  // namespace mirrorball::detail
