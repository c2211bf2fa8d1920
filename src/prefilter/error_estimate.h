// How far off a prefiltered map is, from the spectrum of what it was made from.
#pragma once

#include <span>

#include "prefilter/band_split.h"

namespace mirrorball::detail {

struct ErrorTerms {
    std::span<const double> lambda;  ///< the whole lobe's, for as many degrees as are known
    std::span<const double> far;     ///< what was summed
    std::span<const double> waves;   ///< relative error of the grid's interpolation, per degree
    double beyond;                   ///< sum over the degrees not in lambda of (2l+1) lambda_l^2
};

/// The error's rms over the result's, over the whole sphere and before rounding.
[[nodiscard]] double relative_error(std::span<const double> spectrum, const ErrorTerms& terms);

}  // namespace mirrorball::detail
