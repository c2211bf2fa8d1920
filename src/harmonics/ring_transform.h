// The spherical-harmonic transform between coefficients and rings of latitude.
//
// A grid has `ring_count` rings at theta_j = (j + 1/2) pi / ring_count from the +y pole of its
// frame and `column_count` equally spaced values on each. A transform is a Fourier transform along
// each ring and a sum over rings (analysis) or degrees (synthesis) for each order m:
//
//     a_lm = sum_j P_l^m(cos theta_j) sum_k f_jk e^{-i m psi_k},    f the same backwards
//
// Rings j and ring_count - 1 - j, one north and one south of the equator, have the same P up to a
// sign, so they are folded into one pair; pairs lie in the lanes of vectors, a `group` at a time.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <mirrorball/harmonics.h>

#include "core/aligned.h"
#include "core/scratch.h"
#include "harmonics/fourier.h"
#include "harmonics/legendre.h"

namespace mirrorball::detail {

/// Rings that one vector of this processor holds.
[[nodiscard]] int ring_lane_count();

/// Where the columns of a grid are: azimuth psi_k = first + direction * 2 pi k / column_count,
/// about +y from +z towards +x.
struct Columns {
    double first = 0;
    int direction = 1;  ///< or -1
};

/// Working memory between the two halves of a transform: what each pair of rings holds at each
/// order, [group][order][part][lane]. The parts are three channels of cosines and of sines, of the
/// even and of the odd part in analysis, of north and of south in synthesis.
using RingSpectra = ScratchArray;
inline constexpr int kParts = 12;

/// Planar values on a group of rings, [column][north, south][lane].
using GroupValues = ScratchArray;

class RingTransform {
  public:
    /// Orders and degrees below `band_count` of those that the table has. Any ring count; column
    /// counts without large prime factors are fast.
    RingTransform(std::shared_ptr<const LegendreTable> table, int band_count, int ring_count,
                  int column_count,
                  std::shared_ptr<ScratchPool> scratch = std::make_shared<ScratchPool>());

    [[nodiscard]] int band_count() const { return band_count_; }
    [[nodiscard]] int ring_count() const { return ring_count_; }
    [[nodiscard]] int column_count() const { return fourier_.length(); }
    [[nodiscard]] int lane_count() const { return lane_count_; }
    [[nodiscard]] int group_count() const { return group_count_; }

    /// What all working memory of this and of what works with it comes from.
    [[nodiscard]] const std::shared_ptr<ScratchPool>& scratch() const { return scratch_; }
    [[nodiscard]] RingSpectra make_spectra() const;
    [[nodiscard]] GroupValues make_values() const;

    // Analysis: values of every group, then all orders.

    /// Interleaved rows of RGB, top row (north) first, into three planes of a group.
    void load_rows(int group, const float* rows, std::array<GroupValues, 3>& planes) const;
    /// Fourier transform of one group; `ring_weights` multiplies each pair of rings. Overwrites
    /// the planes.
    void to_spectra(int group, std::array<GroupValues, 3>& planes, GroupValues& scratch,
                    const Columns& columns, std::span<const float> ring_weights,
                    RingSpectra& spectra) const;
    void analyse(const RingSpectra& spectra, Harmonics& harmonics) const;

    // Synthesis: all orders, then values of any group.

    /// Degree l is multiplied by zonal[l]; those without a factor are left out.
    /// \pre zonal.size() is at most band_count() and harmonics.band_count()
    void synthesise(const Harmonics& harmonics, std::span<const float> zonal,
                    RingSpectra& spectra) const;
    /// With columns from +z on, of the `order_count` orders that were synthesised; `ring_weights`
    /// as above, or empty.
    void from_spectra(int group, const RingSpectra& spectra, int order_count,
                      std::span<const float> ring_weights, std::array<GroupValues, 3>& planes,
                      GroupValues& scratch) const;

  private:
    void make_seeds();
    [[nodiscard]] LegendreOrder legendre_order(int m, int band_count) const;

    std::shared_ptr<const LegendreTable> table_;
    int band_count_, ring_count_, lane_count_, group_count_;
    FourierPlan fourier_;
    std::shared_ptr<ScratchPool> scratch_;
    // Where the functions of an order begin to matter on a group, and their two values there.
    std::vector<std::int32_t> starts_;  // [order][group]
    AlignedArray<double> seeds_;        // [order][group][p_n, p_{n-1}][lane]
    AlignedArray<double> x_;            // cos theta, [group][lane]
};

}  // namespace mirrorball::detail
