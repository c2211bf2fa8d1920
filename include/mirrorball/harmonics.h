// Spherical harmonics: light as waves on the sphere, of any fineness.
//
// A function on the sphere with `band_count` bands is a sum over degrees l < band_count and orders
// -l <= m <= l of coefficients times the real, orthonormal harmonics about +Y,
//
//     Y_l,0  = P_l^0(cos theta)             theta the angle to +Y
//     Y_l,m  = P_l^m(cos theta) cos m psi   psi = atan2(x, z), m > 0
//     Y_l,-m = P_l^m(cos theta) sin m psi
//
// with P_l^m >= 0 next to the pole (no Condon-Shortley sign). Degree l has features of about
// 180 / l degrees. Filtering with a lobe multiplies degree l by a number (zonal.h):
//
//     const Harmonics light = analyse(map, 128);
//     const HarmonicSynthesis show({Projection::cube, 64, axes}, 128, parse_lobe("ggx:0.25"));
//     show(light, zonal_coefficients(parse_lobe("ggx:0.3"), 128), blurred);   // half a millisecond
//
// How it works, and why it is stable: docs/theory/spectral-prefiltering.md.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <mirrorball/environment_map.h>

namespace mirrorball {

/// Coefficients of RGB light in the world's frame. Single precision: 1e-7 of the map's own rms.
class Harmonics {
  public:
    /// All zero. \pre band_count >= 0
    explicit Harmonics(int band_count = 0);

    [[nodiscard]] int band_count() const { return band_count_; }

    /// The coefficient of Y_l,m. \pre 0 <= l < band_count(), -l <= m <= l
    [[nodiscard]] Vec3f coefficient(int l, int m) const;
    void set_coefficient(int l, int m, const Vec3f& value);

    /// All coefficients of orders m and -m, m >= 0: for each degree l from m on six values, RGB of
    /// Y_l,m and RGB of Y_l,-m (zero for m = 0).
    [[nodiscard]] std::span<float> order(int m) { return {values_.data() + begin(m), size(m)}; }
    [[nodiscard]] std::span<const float> order(int m) const {
        return {values_.data() + begin(m), size(m)};
    }

  private:
    [[nodiscard]] std::size_t size(int m) const {
        return 6 * static_cast<std::size_t>(band_count_ - m);
    }
    [[nodiscard]] std::size_t begin(int m) const {
        const std::size_t order = m, bands = band_count_;
        return 6 * (order * bands - order * (order - 1) / 2);
    }

    int band_count_;
    std::vector<float> values_;
};

/// Sums over orders and channels of squared coefficients, per degree. Added up, they are the
/// integral of the squared light over the sphere (Parseval).
[[nodiscard]] std::vector<double> power_spectrum(const Harmonics& harmonics);

// Arithmetic -------------------------------------------------------------------------------------

/// \pre a and b have as many bands
[[nodiscard]] Harmonics operator+(Harmonics a, const Harmonics& b);
[[nodiscard]] Harmonics operator*(Harmonics harmonics, float factor);

/// Cut to fewer bands, or with zeros for more.
[[nodiscard]] Harmonics with_bands(const Harmonics& harmonics, int band_count);

/// Degree l times factors[l]: zonal_coefficients() of a lobe, window_coefficients(), or products
/// of them. Degrees without a factor become zero.
[[nodiscard]] Harmonics convolved(Harmonics harmonics, std::span<const double> factors);
/// Filtered with a lobe: its value at n is then the integral of lobe(n.l) times the light from l.
/// \throws Error(Errc::usage) for a table known by name only
[[nodiscard]] Harmonics convolved(Harmonics harmonics, const Lobe& lobe);

/// The light turned with its frame: what was along the world's x, y and z comes to lie along the
/// directions `axes`, which may also mirror it. evaluate(rotated(h, a), a.to_world(d)) is
/// evaluate(h, d), within 1e-6 of the light's rms. Two products with Wigner's matrices of a quarter
/// turn, in double; two thirds of the cube of the bands in multiplications by 3 channels, spread
/// over threads by degree (0.11 s for 512 bands on one thread). Turns about +Y alone take no time.
/// Trapani and Navaza 2006, "Calculation of spherical harmonics and Wigner d functions by FFT".
[[nodiscard]] Harmonics rotated(const Harmonics& harmonics, const Axes& axes);

/// The light from one direction, in double (the coefficients are floats). Any number of bands:
/// functions of high orders are carried below the least double near the poles. Takes the square of
/// the bands: 4 ms for 1024. \pre |direction| == 1
[[nodiscard]] Vec3d evaluate(const Harmonics& harmonics, const Vec3d& direction);

// Transforms -------------------------------------------------------------------------------------

/// Maps of one shape to coefficients: texels as points at their centres, times their exact solid
/// angles,
///
///     a_lm = sum over used texels of  radiance * solid_angle * Y_lm(centre)
///
/// so uniform light is sqrt(4 pi) times itself in a_00. As a quadrature it is good to about
/// (l texel)^2 / 24, the texel in radians; more bands than half the texels around the map repeat
/// what is there.
///
/// The sums are exact to float (1e-6 of the spectrum) for a panorama that stands upright and whose
/// width has no prime factor above 61. Texels of all others are first spread to such a grid, by
/// weights good for all degrees: 1e-5 of the spectrum in root mean square, 5e-5 in the last
/// degrees.
///
/// Everything but the pixels' own work is done once; a plan may be used by many threads at once.
/// Through a grid, a plan holds up to 300 bytes per coefficient: 0.3 GB for 1024 bands.
class HarmonicAnalysis {
  public:
    /// \throws Error(Errc::usage) unless 1 <= band_count <= kLargestBandCount (zonal.h) and maps
    /// can have that shape
    HarmonicAnalysis(const MapShape& shape, int band_count);

    /// Of level 0. \throws Error(Errc::usage) for a map of another shape, Error(Errc::cannot_read)
    /// if a used texel is NaN or infinite
    [[nodiscard]] Harmonics operator()(const EnvironmentMap& map) const;
    /// Into coefficients that are there. Working memory is kept from call to call.
    void operator()(const EnvironmentMap& map, Harmonics& harmonics) const;

    [[nodiscard]] const MapShape& shape() const;
    [[nodiscard]] int band_count() const;

  private:
    class Plan;
    std::shared_ptr<const Plan> plan_;
};

/// What every channel of a texel is clamped to; by default not at all.
struct TexelRange {
    Vec3f lowest = Vec3f(-std::numeric_limits<float>::max());
    Vec3f highest = Vec3f(std::numeric_limits<float>::max());
};

/// Coefficients to the texels of maps of one shape: the values at their centres, as evaluate()
/// gives them, off by 1e-5 of the light's rms where all degrees are equally strong (and by 5e-5 of
/// what the last degrees hold). Light filtered with a lobe has little there: 1e-6.
class HarmonicSynthesis {
  public:
    /// For up to `band_count` bands. \throws Error(Errc::usage) as HarmonicAnalysis
    HarmonicSynthesis(const MapShape& shape, int band_count);

    /// For light that is filtered with `narrowest` or a wider lobe. Last degrees then hold little,
    /// and a grid of half as many values each way serves: three times as fast, within 2e-5 of the
    /// rms of what comes out. (Not smaller where the bands cut the lobe off, band_count(narrowest,
    /// 1e-3) > band_count.)
    HarmonicSynthesis(const MapShape& shape, int band_count, const Lobe& narrowest);

    /// A new map of one level.
    [[nodiscard]] EnvironmentMap operator()(const Harmonics& harmonics) const;

    /// Degree l times factors[l], those without a factor left out, to level 0 of a map of this
    /// shape, every texel of which is written. This is what a slider calls for each frame, with a
    /// lobe's zonal_coefficients(): 0.5 ms for a cube of 64 x 64 x 6 at 128 bands, 1 ms at 200, on
    /// two threads. Clamping to the source's own
    /// range takes away what a cut after few bands lets ring. Bands that are zero cost time: fewer
    /// factors are faster. Working memory is kept from call to call.
    /// \throws Error(Errc::usage) for a map of another shape
    void operator()(const Harmonics& harmonics, std::span<const double> factors,
                    EnvironmentMap& map, const TexelRange& range = {}) const;

    [[nodiscard]] const MapShape& shape() const;
    [[nodiscard]] int band_count() const;

  private:
    class Plan;
    std::shared_ptr<const Plan> plan_;
};

/// Both at once, for one map.
[[nodiscard]] Harmonics analyse(const EnvironmentMap& map, int band_count);
[[nodiscard]] EnvironmentMap synthesise(const Harmonics& harmonics, const MapShape& shape);

}  // namespace mirrorball
