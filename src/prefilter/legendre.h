// Sums over Legendre polynomials, many nodes at a time: both ways between a zonal function's values
// and its bands.
#pragma once

#include <span>

namespace mirrorball::detail {

/// sums[l] = sum over i of weights[i] P_l(1 - x[i]), for x in [0, 1]. Error: about 1e-15 of the sum
/// of |weights|, however close the nodes are to the axis.
void legendre_sums(std::span<const double> x, std::span<const double> weights,
                   std::span<double> sums);

/// values[i] = sum over l of coefficients[l] P_l(1 - x[i]), for x in [0, 1]; and the same at the
/// opposite latitudes, opposite[i] with P_l(x[i] - 1), unless `opposite` is empty.
void legendre_series(std::span<const double> coefficients, std::span<const double> x,
                     std::span<double> values, std::span<double> opposite);

}  // namespace mirrorball::detail
