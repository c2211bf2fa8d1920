#include <mirrorball/harmonics.h>

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <functional>
#include <utility>

#include <mirrorball/zonal.h>

namespace mirrorball {

Harmonics::Harmonics(int band_count)
    : band_count_(band_count),
      values_(band_count > 0 ? begin(band_count) : 0) {}

Vec3f Harmonics::coefficient(int l, int m) const {
    assert(l >= 0 && l < band_count_ && std::abs(m) <= l);
    const int k = std::abs(m);
    const float* value = &order(k)[6 * static_cast<std::size_t>(l - k) + (m < 0 ? 3 : 0)];
    return {value[0], value[1], value[2]};
}

void Harmonics::set_coefficient(int l, int m, const Vec3f& value) {
    assert(l >= 0 && l < band_count_ && std::abs(m) <= l);
    const int k = std::abs(m);
    float* to = &order(k)[6 * static_cast<std::size_t>(l - k) + (m < 0 ? 3 : 0)];
    to[0] = value.x, to[1] = value.y, to[2] = value.z;
}

std::vector<double> power_spectrum(const Harmonics& harmonics) {
    std::vector<double> power(harmonics.band_count());
    for (int m = 0; m < harmonics.band_count(); ++m) {
        const std::span<const float> order = harmonics.order(m);
        for (std::size_t i = 0; i < order.size(); i += 6) {
            double sum = 0;
            for (std::size_t k = 0; k < 6; ++k) {
                const double value = order[i + k];
                sum += value * value;
            }
            power[m + i / 6] += sum;
        }
    }
    return power;
}

Harmonics operator+(Harmonics a, const Harmonics& b) {
    assert(a.band_count() == b.band_count());
    for (int m = 0; m < a.band_count(); ++m) {
        std::transform(a.order(m).begin(), a.order(m).end(), b.order(m).begin(), a.order(m).begin(),
                       std::plus<>());
    }
    return a;
}

Harmonics operator*(Harmonics harmonics, float factor) {
    for (int m = 0; m < harmonics.band_count(); ++m) {
        for (float& value : harmonics.order(m)) value *= factor;
    }
    return harmonics;
}

Harmonics with_bands(const Harmonics& harmonics, int band_count) {
    Harmonics result(band_count);
    for (int m = 0; m < std::min(band_count, harmonics.band_count()); ++m) {
        const std::span<const float> from = harmonics.order(m);
        const std::span<float> to = result.order(m);
        std::copy_n(from.begin(), std::min(from.size(), to.size()), to.begin());
    }
    return result;
}

Harmonics convolved(Harmonics harmonics, std::span<const double> factors) {
    for (int m = 0; m < harmonics.band_count(); ++m) {
        const std::span<float> order = harmonics.order(m);
        for (std::size_t i = 0; i < order.size(); ++i) {
            const std::size_t degree = m + i / 6;
            const double factor = degree < factors.size() ? factors[degree] : 0;
            order[i] = static_cast<float>(order[i] * factor);
        }
    }
    return harmonics;
}

Harmonics convolved(Harmonics harmonics, const Lobe& lobe) {
    const int band_count = harmonics.band_count();
    if (lobe.is_delta() || band_count == 0) return harmonics;
    return convolved(std::move(harmonics), zonal_coefficients(lobe, band_count));
}

}  // namespace mirrorball
