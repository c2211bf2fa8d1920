#include <mirrorball/harmonics.h>

#include <cassert>
#include <cstdlib>

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

}  // namespace mirrorball
