// Gradient noise (Perlin 1985, "An Image Synthesizer"; quintic fade of Perlin 2002) with its
// analytic gradient, and sums of its octaves; on the whole plane, or on a tile. Lattice gradients
// come from an integer hash: no tables, no seed but the one passed, the same picture everywhere.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace mirrorball::detail {

/// A point or vector of the plane.
struct Vec2 {
    double x = 0, y = 0;
};

/// The unit vector at an angle from +x, in radians.
[[nodiscard]] inline Vec2 heading(double angle) {
    return {std::cos(angle), std::sin(angle)};
}

/// A noise value, about -1 to 1, and its derivatives.
struct NoiseSample {
    double value = 0, dx = 0, dy = 0;
};

namespace noise_detail {

inline std::uint32_t hash(std::int32_t x, std::int32_t y, std::uint32_t seed) {
    std::uint32_t h = seed * 0x9E3779B9u;
    h = (h ^ static_cast<std::uint32_t>(x)) * 0x85EBCA6Bu;
    h = (h ^ (h >> 15) ^ static_cast<std::uint32_t>(y)) * 0xC2B2AE35u;
    h = (h ^ (h >> 13)) * 0x27D4EB2Fu;
    return h ^ (h >> 16);
}

// One of 16 unit vectors, evenly around the circle: enough that no direction stands out.
inline Vec2 lattice_gradient(std::int32_t x, std::int32_t y, std::uint32_t seed) {
    static constexpr Vec2 kDirections[16] = {
        {1.0, 0.0},  {0.9238795, 0.3826834},   {0.7071068, 0.7071068},   {0.3826834, 0.9238795},
        {0.0, 1.0},  {-0.3826834, 0.9238795},  {-0.7071068, 0.7071068},  {-0.9238795, 0.3826834},
        {-1.0, 0.0}, {-0.9238795, -0.3826834}, {-0.7071068, -0.7071068}, {-0.3826834, -0.9238795},
        {0.0, -1.0}, {0.3826834, -0.9238795},  {0.7071068, -0.7071068},  {0.9238795, -0.3826834}};
    return kDirections[hash(x, y, seed) >> 28];
}

// gradient(ix, iy) is that of a point of the lattice.
template <class Gradient>
NoiseSample noise(const Vec2& p, const Gradient& gradient) {
    const double floor_x = std::floor(p.x), floor_y = std::floor(p.y);
    const auto ix = static_cast<std::int32_t>(floor_x), iy = static_cast<std::int32_t>(floor_y);
    const double x = p.x - floor_x, y = p.y - floor_y;

    const double u = x * x * x * (x * (x * 6 - 15) + 10), du = 30 * x * x * (x * (x - 2) + 1);
    const double v = y * y * y * (y * (y * 6 - 15) + 10), dv = 30 * y * y * (y * (y - 2) + 1);

    const Vec2 g00 = gradient(ix, iy), g10 = gradient(ix + 1, iy);
    const Vec2 g01 = gradient(ix, iy + 1), g11 = gradient(ix + 1, iy + 1);
    const double a = g00.x * x + g00.y * y;
    const double b = g10.x * (x - 1) + g10.y * y;
    const double c = g01.x * x + g01.y * (y - 1);
    const double d = g11.x * (x - 1) + g11.y * (y - 1);

    // value = a + u (b - a) + v (c - a) + u v k, and its derivatives by the product rule
    const double k = a - b - c + d;
    constexpr double kScale = 1.5;  // brings the usual extremes to about -1 and 1
    const auto blend = [&](double pa, double pb, double pc, double pd) {
        return pa + u * (pb - pa) + v * (pc - pa) + u * v * (pa - pb - pc + pd);
    };
    return {kScale * (a + u * (b - a) + v * (c - a) + u * v * k),
            kScale * (blend(g00.x, g10.x, g01.x, g11.x) + du * (b - a + v * k)),
            kScale * (blend(g00.y, g10.y, g01.y, g11.y) + dv * (c - a + u * k))};
}

}  // namespace noise_detail

/// Features are about one unit wide; 0 on average.
inline NoiseSample noise(const Vec2& p, std::uint32_t seed) {
    return noise_detail::noise(p, [seed](std::int32_t x, std::int32_t y) {
        return noise_detail::lattice_gradient(x, y, seed);
    });
}

/// The same, repeating after so many units each way. \pre both at least 1
inline NoiseSample tiling_noise(const Vec2& p, std::int32_t period_x, std::int32_t period_y,
                                std::uint32_t seed) {
    const auto within = [](std::int32_t i, std::int32_t period) {
        return (i % period + period) % period;
    };
    return noise_detail::noise(p, [=](std::int32_t x, std::int32_t y) {
        return noise_detail::lattice_gradient(within(x, period_x), within(y, period_y), seed);
    });
}

/// A number from 0 to 1 for a point of a lattice. Mixed further than gradients need it, so that the
/// numbers of neighbours can serve as coordinates of one point.
inline double lattice_number(std::int32_t x, std::int32_t y, std::uint32_t seed) {
    std::uint32_t h = noise_detail::hash(x, y, seed);
    h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12)) * 0x297A2D39u;
    return (h ^ (h >> 15)) / 4294967296.0;
}

/// Octaves of noise, each of half the size of the one before and `gain` times as strong. Octaves
/// that are not well wider than `footprint` fade out, so that samples that far apart never alias.
struct Fractal {
    int octaves;
    double gain;
    std::uint32_t seed;

    [[nodiscard]] NoiseSample operator()(Vec2 p, double footprint) const {
        // A turn by 37 degrees per octave keeps the lattices from lining up.
        constexpr double kCos = 0.79863551, kSin = 0.60181502;
        NoiseSample sum;
        double amplitude = 1, frequency = 1, turn_cos = 1, turn_sin = 0;
        for (int i = 0; i < octaves; ++i) {
            const double fade = std::clamp(2 - 4 * footprint * frequency, 0.0, 1.0);
            if (fade == 0) break;
            const NoiseSample n = noise(p, seed + static_cast<std::uint32_t>(i));
            const double weight = amplitude * fade;
            sum.value += weight * n.value;
            sum.dx += weight * frequency * (turn_cos * n.dx + turn_sin * n.dy);
            sum.dy += weight * frequency * (turn_cos * n.dy - turn_sin * n.dx);
            p = {2 * (kCos * p.x - kSin * p.y), 2 * (kSin * p.x + kCos * p.y)};
            const double next_cos = turn_cos * kCos - turn_sin * kSin;
            turn_sin = turn_sin * kCos + turn_cos * kSin;
            turn_cos = next_cos;
            amplitude *= gain;
            frequency *= 2;
        }
        return sum;
    }
};

/// Point i of a sequence that fills the unit square evenly (Roberts 2018, "R2": steps by powers of
/// the plastic number's inverse, modulo 1).
inline Vec2 even_point(int i) {
    constexpr double kStepX = 0.7548776662466927, kStepY = 0.5698402909980532;
    const double x = 0.5 + kStepX * i, y = 0.5 + kStepY * i;
    return {x - std::floor(x), y - std::floor(y)};
}

}  // namespace mirrorball::detail
