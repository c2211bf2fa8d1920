// The transform by its definition, in long double, term by term; and what tests measure it by.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <mirrorball/harmonics.h>

namespace mirrorball {

/// d^k/dx^k of P_l, with its norm, as a polynomial: factors of x^(l-k), x^(l-k-2), ...
/// \pre l < 32
inline const std::vector<long double>& polynomial(int l, int k) {
    static std::vector<std::vector<long double>> known(32 * 32);
    std::vector<long double>& terms = known[32 * l + k];
    if (!terms.empty()) return terms;
    const auto log_factorial = [](int n) { return std::lgamma(n + 1.0L); };
    const long double pi = 3.14159265358979323846L;
    const long double norm = std::sqrt((2 * l + 1) / (4 * pi) * (k > 0 ? 2 : 1) *
                                       std::exp(log_factorial(l - k) - log_factorial(l + k)));
    for (int j = 0; 2 * j <= l - k; ++j) {
        const long double size =
            std::exp(log_factorial(2 * l - 2 * j) - log_factorial(j) - log_factorial(l - j) -
                     log_factorial(l - 2 * j - k) - l * std::log(2.0L));
        terms.push_back((j % 2 == 0 ? norm : -norm) * size);
    }
    return terms;
}

/// Y_lm of harmonics.h from the closed sum of Legendre's polynomials: no recurrence in common with
/// the library. Loses digits with l; good to 1e-12 up to 20.
inline long double harmonic(int l, int m, const Vec3d& d) {
    const int k = std::abs(m);
    const long double x = d.y, z = d.z;
    const long double sine = std::hypot(static_cast<long double>(d.x), z);
    long double sum = 0;
    for (const long double term : polynomial(l, k)) sum = sum * x * x + term;
    if ((l - k) % 2 == 1) sum *= x;
    const long double psi = std::atan2(static_cast<long double>(d.x), z);
    const long double wave = m > 0 ? std::cos(k * psi) : m < 0 ? std::sin(k * psi) : 1;
    return sum * std::pow(sine, static_cast<long double>(k)) * wave;
}

/// Calls f(direction, solid angle, face, x, y) for every used texel.
template <class F>
void for_each_used_texel(const MapShape& shape, const F& f) {
    const EnvironmentMap map = make_environment_map(shape.projection, shape.size);
    const int width = map.width(), height = map.height();
    const auto solid_angles = solid_angle_table(shape.projection, width, height);
    visit(shape.projection, [&](auto p) {
        using P = decltype(p);
        for (int face = 0; face < P::face_count; ++face)
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    const double solid_angle =
                        solid_angles[static_cast<std::size_t>(y) * width + x];
                    if (solid_angle == 0) continue;
                    const FacePoint<double> centre{face, (x + 0.5) / width, (y + 0.5) / height};
                    f(shape.axes.to_world(P::direction(centre)), solid_angle, face, x, y);
                }
    });
}

/// Every texel by itself: a flat spectrum, the harshest.
inline EnvironmentMap noise_map(const MapShape& shape, unsigned seed = 1) {
    EnvironmentMap map = make_environment_map(shape.projection, shape.size);
    map.axes = shape.axes;
    std::mt19937 random(seed);
    std::normal_distribution<float> value;
    for (Image& face : map.levels[0].faces) {
        for (float& v : face.values()) v = value(random);
    }
    return map;
}

/// All coefficients drawn from one distribution, as strong at the last degree as at the first.
inline Harmonics noise_harmonics(int band_count, unsigned seed = 1) {
    Harmonics result(band_count);
    std::mt19937 random(seed);
    std::normal_distribution<float> value;
    const auto draw = [&] {
        const float r = value(random), g = value(random), b = value(random);
        return Vec3f(r, g, b);
    };
    for (int l = 0; l < band_count; ++l) {
        for (int m = -l; m <= l; ++m) result.set_coefficient(l, m, draw());
    }
    return result;
}

inline Harmonics analysed_by_sums(const EnvironmentMap& map, int band_count) {
    std::vector<std::array<long double, 3>> sums(static_cast<std::size_t>(band_count) * band_count);
    for_each_used_texel(shape_of(map),
                        [&](const Vec3d& d, double solid_angle, int face, int x, int y) {
                            const Vec3f rgb = map.levels[0].faces[face].rgb(x, y);
                            for (int l = 0; l < band_count; ++l) {
                                for (int m = -l; m <= l; ++m) {
                                    const long double weight = solid_angle * harmonic(l, m, d);
                                    for (int c = 0; c < 3; ++c)
                                        sums[l * l + l + m][c] += weight * rgb[c];
                                }
                            }
                        });
    Harmonics result(band_count);
    for (int l = 0; l < band_count; ++l) {
        for (int m = -l; m <= l; ++m) {
            const auto& sum = sums[l * l + l + m];
            result.set_coefficient(l, m,
                                   Vec3f(static_cast<float>(sum[0]), static_cast<float>(sum[1]),
                                         static_cast<float>(sum[2])));
        }
    }
    return result;
}

inline Vec3d evaluated_by_sums(const Harmonics& harmonics, const Vec3d& d) {
    Vec3d sum(0, 0, 0);
    for (int l = 0; l < harmonics.band_count(); ++l) {
        for (int m = -l; m <= l; ++m)
            sum += Vec3d(harmonics.coefficient(l, m)) * static_cast<double>(harmonic(l, m, d));
    }
    return sum;
}

/// Root of the summed squares of all coefficients, or of those that differ.
inline double magnitude(const Harmonics& harmonics) {
    double sum = 0;
    for (const double power : power_spectrum(harmonics)) sum += power;
    return std::sqrt(sum);
}
inline double relative_difference(const Harmonics& found, const Harmonics& expected) {
    return magnitude(found + expected * -1) / magnitude(expected);
}

inline std::vector<Vec3d> random_directions(int count, unsigned seed = 1) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<Vec3d> result;
    for (int i = 0; i < count; ++i) {
        const double x = normal(random), y = normal(random), z = normal(random);
        result.push_back(Vec3d(x, y, z).normalized());
    }
    return result;
}

/// What the light of harmonics is, in root mean square over the sphere and three channels.
inline double light_rms(const Harmonics& harmonics) {
    return magnitude(harmonics) / std::sqrt(4 * kPi);
}

}  // namespace mirrorball
