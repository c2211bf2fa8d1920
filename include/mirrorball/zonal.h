// Lobes in spherical harmonics: a zonal kernel k is a number lambda_l per band l, and filtering by
// it multiplies each of a map's coefficients by its band's (Funk and Hecke):
//
//     lambda_l = 2 pi  integral from -1 to 1 of  k(t) P_l(t) dt
//     k(t)     = sum over l of  (2l+1)/(4 pi) lambda_l P_l(t)
//
// docs/theory/spectral-prefiltering.md derives what is used here.
#pragma once

#include <vector>

#include <mirrorball/lobe.h>

namespace mirrorball {

/// lambda_l for l < band_count, within 1e-12 of lambda_0: in closed form for diffuse and phong,
/// else by Gauss-Legendre quadrature on panels that follow the lobe and the polynomials. 0.1 ms for
/// 600 bands of ggx:0.1. \pre !lobe.is_delta(); 1 <= band_count <= kLargestBandCount
[[nodiscard]] std::vector<double> zonal_coefficients(const Lobe& lobe, int band_count);

inline constexpr int kLargestBandCount = 4096;

/// How many bands carry a lobe: the least L for which what the bands from L up hold of a single lit
/// texel's image is at most `tolerance` of it, in root mean square:
///
///     sqrt( sum_{l >= L} (2l+1) lambda_l^2 / sum_l (2l+1) lambda_l^2 ) <= tolerance
///
/// By closed rules, within 3 % or 2 bands of the exact count (but for tables, which have none).
/// A crease, like that of every clamped lobe at its horizon, has an algebraic tail that no
/// affordable count would carry: its part is carried up to 128 bands (charlie: up to 12/alpha,
/// tables: 512) and left to a correction in space, however small the tolerance. So diffuse at 128
/// bands stands at 4e-4. May exceed kLargestBandCount: then harmonics alone do not carry the lobe.
/// \pre !lobe.is_delta(), 0 < tolerance < 1
[[nodiscard]] int band_count(const Lobe& lobe, double tolerance);

/// Factors that soften a cut after few bands, which rings around bright lights, at the price of
/// blur (Sloan 2008, "Stupid Spherical Harmonics Tricks"):
///
///     none       1
///     hanning    (1 + cos(pi l / L)) / 2
///     lanczos    sin(pi l / L) / (pi l / L)
enum class Window { none, hanning, lanczos };

/// One factor per band l < L = band_count; 1 at l = 0, and 0 where l = L would be.
[[nodiscard]] std::vector<double> window_coefficients(Window window, int band_count);

}  // namespace mirrorball
