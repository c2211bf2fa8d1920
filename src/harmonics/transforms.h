// From any map to coefficients and back: which grid each shape of map goes through.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include <mirrorball/harmonics.h>
#include <mirrorball/progress.h>

#include "harmonics/ring_transform.h"
#include "harmonics/texel_grid.h"

namespace mirrorball::detail {

/// Sums a map's texels, as points at their centres times their exact solid angles, into
/// coefficients about the world's +Y.
///
/// A panorama that stands upright is itself a grid of rings. Texels of all other maps are spread
/// onto one, so that its rings give the same sums: by the weights that would interpolate a function
/// with degrees' power `power` there (taps.h).
class AnalysisPlan {
  public:
    AnalysisPlan(const MapShape& shape, std::shared_ptr<const LegendreTable> table, int band_count,
                 std::span<const double> power, std::shared_ptr<ScratchPool> scratch,
                 std::optional<double> oversampling = {});

    /// \pre map has the plan's shape
    void run(const std::vector<Image>& faces, Harmonics& harmonics,
             const Progress& progress = {}) const;

    [[nodiscard]] const MapShape& shape() const { return shape_; }
    [[nodiscard]] int band_count() const { return band_count_; }
    /// Is the map itself the grid of rings?
    [[nodiscard]] bool on_rings() const { return !grid_; }

  private:
    MapShape shape_;
    int band_count_;
    std::optional<RingTransform> rings_;
    Columns columns_;
    std::vector<float> ring_weights_;
    std::unique_ptr<TexelGrid> grid_;  // none where the map is the grid
};

/// Coefficients to the texels of a map.
class SynthesisPlan {
  public:
    /// Degrees below `band_count`, with power `power`; the grid has `oversampling` values for each
    /// that the bands need, by default what the power asks for.
    SynthesisPlan(const MapShape& shape, std::shared_ptr<const LegendreTable> table, int band_count,
                  std::span<const double> power, std::shared_ptr<ScratchPool> scratch,
                  std::optional<double> oversampling = {});

    [[nodiscard]] const MapShape& shape() const { return shape_; }
    [[nodiscard]] int band_count() const { return rings_.band_count(); }
    /// Colatitudes of the pairs of rings that `ring_weights` of run() multiplies.
    [[nodiscard]] std::vector<double> pair_colatitudes() const;

    /// Of each degree, the relative error that interpolation on the grid makes of it, in root mean
    /// square.
    [[nodiscard]] std::vector<double> wave_errors() const;

    /// Degree l is multiplied by zonal[l]; those without a factor are left out, and cost nothing.
    /// Texels are clamped to [lowest, highest] per channel. \pre zonal.size() is at most
    /// band_count() and harmonics.band_count()
    void run(const Harmonics& harmonics, std::span<const float> zonal,
             std::span<const float> ring_weights, const Vec3f& lowest, const Vec3f& highest,
             std::vector<Image>& faces) const;

  private:
    MapShape shape_;
    RingTransform rings_;
    GridTaps taps_;
    std::unique_ptr<TexelGrid> grid_;
};

}  // namespace mirrorball::detail
