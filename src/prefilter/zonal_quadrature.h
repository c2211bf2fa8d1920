// Integrals over a lobe against Legendre polynomials, by Gauss-Legendre points on panels that are
// as fine as the lobe and the fastest polynomial need.
#pragma once

#include <vector>

#include <mirrorball/lobe.h>

namespace mirrorball::detail {

struct ZonalQuadrature {
    /// Fine enough for polynomials below `band_count`. \pre !lobe.is_delta()
    ZonalQuadrature(const Lobe& lobe, int band_count);

    /// lambda_l for l < band_count, of no more bands than it was made for.
    [[nodiscard]] std::vector<double> coefficients(int band_count) const;

    /// The integral of the lobe's square over the sphere.
    [[nodiscard]] double square() const;

    struct Nodes {
        std::vector<double> x;  // 1 - |cos(theta)|
        std::vector<double> weight, value;
    };
    Nodes front, back;  // to the lobe's horizon, and beyond it
};

}  // namespace mirrorball::detail
