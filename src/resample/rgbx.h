// A texel in one register: red, green, blue and one lane that means nothing.
#pragma once

#include <cstring>

namespace mirrorball::detail {

using Rgbx = float __attribute__((vector_size(16)));
using Mask = int __attribute__((vector_size(16)));

// One instruction; the choice of a lane by a comparison, which says the same, takes four.
inline Rgbx smaller(Rgbx a, Rgbx b) {
#if defined(__SSE__)
    return __builtin_ia32_minps(a, b);
#else
    return a < b ? a : b;
#endif
}
inline Rgbx larger(Rgbx a, Rgbx b) {
#if defined(__SSE__)
    return __builtin_ia32_maxps(a, b);
#else
    return a > b ? a : b;
#endif
}
inline float smaller(float a, float b) {
    return a < b ? a : b;
}
inline float larger(float a, float b) {
    return a > b ? a : b;
}
inline Rgbx magnitude(Rgbx v) {
    return (Rgbx)((Mask)v & 0x7fffffff);
}

inline Rgbx load_rgbx(const float* rgb) {
    Rgbx value;
    std::memcpy(&value, rgb, sizeof value);
    return value;
}
inline void store_rgbx(Rgbx value, float* to) {
    std::memcpy(to, &value, sizeof value);
}

/// Twice the slope of the parabola through three neighbours, from the two differences beside the
/// middle one, as far as monotone: never more than three times the smaller of them (twice that
/// here), and level at a peak (Fritsch and Carlson 1980).
template <class T>
inline T doubled_slope(T left, T right) {
    const T zero{};
    const T most = larger(zero, 6.0f * smaller(left, right)),
            least = smaller(zero, 6.0f * larger(left, right));
    return larger(smaller(left + right, most), least);
}

/// Cubic Hermite interpolation between b and c by weights of their values and doubled slopes, in
/// the order b, c, slope at b, slope at c. The curve stays between b and c; a plain cubic would
/// swing below zero beside a sun.
inline Rgbx monotone_cubic(Rgbx a, Rgbx b, Rgbx c, Rgbx d, const float* weights) {
    const Rgbx step = c - b;
    const Rgbx at_b = doubled_slope(b - a, step), at_c = doubled_slope(step, d - c);
    return b * weights[0] + c * weights[1] + at_b * weights[2] + at_c * weights[3];
}

}  // namespace mirrorball::detail
