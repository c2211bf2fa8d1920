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
// 180 / l degrees. Filtering with a lobe multiplies degree l by a number (zonal.h).
#pragma once

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

}  // namespace mirrorball
