// A lobe cut in two, after Ewald's way with lattice sums: a far part that a limited number of
// harmonics carries, and a near part that is nothing but over short distances, for bright lights to
// be put right in space.
#pragma once

#include <vector>

#include <mirrorball/lobe.h>

#include "prefilter/near_kernel.h"

namespace mirrorball::detail {

struct BandSplit {
    /// far_l = lambda_l w_l, w_l falling smoothly from 1 to 0 toward the last band.
    std::vector<double> far;

    /// k - sum of (2l+1)/(4 pi) far_l P_l, where it matters: elsewhere it is below 2e-4 of k and
    /// below 2e-6 of k's root mean square over the sphere.
    NearKernel near;

    /// What a single lit texel's image lacks without the near part, in root mean square, relative.
    double tail = 0;

    /// The whole lobe's sum over all bands of (2l+1) lambda_l^2.
    double whole = 0;
};

/// Enough bands for `tolerance`, which is what `tail` keeps to unless a crease at the horizon or
/// `max_band_count` is in the way: then the near part holds more, and the sum is as exact.
/// Gaussian lobes (phong, blinn-phong) are carried to 2e-7, which takes two fifths more
/// bands than 1e-4 and spares them a near part. \pre !lobe.is_delta(), 0 < tolerance < 1,
/// max_band_count >= 8
[[nodiscard]] BandSplit split_bands(const Lobe& lobe, double tolerance, int max_band_count);

}  // namespace mirrorball::detail
