// Water: rings from a few places, and a sea of waves that all fit the tile.
#include "../environments/noise.h"
#include "tile.h"

namespace mirrorball {

double WaterWave::omega() const {
    return detail::water_omega(std::hypot(kx, ky));
}

double WaterWave::height(double x, double y, double time) const {
    return amplitude * std::cos(kx * x + ky * y - omega() * time + phase);
}

double WaterWave::velocity(double x, double y, double time) const {
    return amplitude * omega() * std::sin(kx * x + ky * y - omega() * time + phase);
}

// Lengths fall evenly by ratio from half the tile's shorter side to a 64th of it, and all waves are
// equally steep on average: the saturated part of a wind sea's spectrum (Phillips 1958), which
// looks the same at any scale. Directions spread about the wind's.
std::vector<WaterWave> water_waves(double width, double height) {
    constexpr int kCount = 60;
    constexpr double kWind = 0.5, kSpread = 1.1;  // radians
    constexpr double kSteepness = 0.025;          // of one wave: slopes of 0.14, rms, all together
    constexpr std::uint32_t kSeed = 7;
    const double side = std::min(width, height);
    std::vector<WaterWave> waves;
    for (int i = 0; i < kCount; ++i) {
        const auto number = [&](int which) { return detail::lattice_number(i, which, kSeed); };
        const double length = side / 2 * std::pow(32.0, -i / (kCount - 1.0));
        // The mean of two numbers: more waves near the wind's direction than far from it.
        const double angle = kWind + 2 * kSpread * ((number(0) + number(1)) / 2 - 0.5);
        const double cycles_x = std::round(width / length * std::cos(angle));
        const double cycles_y = std::round(height / length * std::sin(angle));
        WaterWave wave{2 * kPi * cycles_x / width, 2 * kPi * cycles_y / height, 0,
                       2 * kPi * number(2)};
        const double k = std::hypot(wave.kx, wave.ky);
        if (k == 0) continue;
        wave.amplitude = kSteepness / k * (0.5 + number(3));
        waves.push_back(wave);
    }
    return waves;
}

namespace detail {

// cos(a + b) from tables of a by column and b by row: no cosine per texel and wave.
Image draw_waves(const Tile& tile) {
    struct Drawn {
        double amplitude, row_step, row_phase;
        std::vector<double> cosines, sines;  // by column
    };
    std::vector<Drawn> waves;
    for (const WaterWave& wave : water_waves(tile.width, tile.height)) {
        const double across = wave.kx * tile.width, down = wave.ky * tile.height;
        const double visible =
            tile.visible(std::abs(across) / (2 * kPi), std::abs(down) / (2 * kPi));
        if (visible == 0) continue;
        Drawn drawn{wave.amplitude * visible,
                    down,
                    std::remainder(wave.phase - wave.omega() * tile.time, 2 * kPi),
                    {},
                    {}};
        for (int x = 0; x < tile.columns; ++x) {
            const double angle = across * (x + 0.5) / tile.columns;
            drawn.cosines.push_back(std::cos(angle));
            drawn.sines.push_back(std::sin(angle));
        }
        waves.push_back(std::move(drawn));
    }

    Image image(tile.columns, tile.rows, 1);
    parallel_for(tile.rows, [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        const double v = 1 - (y + 0.5) / tile.rows;
        std::vector<double> heights(tile.columns);
        for (const Drawn& wave : waves) {
            const double angle = wave.row_step * v + wave.row_phase;
            const double c = wave.amplitude * std::cos(angle);
            const double s = wave.amplitude * std::sin(angle);
            for (int x = 0; x < tile.columns; ++x)
                heights[x] += wave.cosines[x] * c - wave.sines[x] * s;
        }
        std::copy(heights.begin(), heights.end(), image.row(y).begin());
    });
    return image;
}

// Rings cos(k r - omega t) inside a window that is 0 at its middle, where rings would have a tip,
// and at its rim, and smooth in between.
Image draw_ripples(const Tile& tile) {
    constexpr int kDrops = 5;
    constexpr double kRingsPerSide = 24, kRadius = 0.48, kAmplitude = 0.0015;
    const double side = tile.side();
    const double k = 2 * kPi * kRingsPerSide / side, radius = kRadius * side;
    const double visible =
        tile.visible(kRingsPerSide * tile.width / side, kRingsPerSide * tile.height / side);
    const double turned = std::remainder(water_omega(k) * tile.time, 2 * kPi);

    struct Drop {
        Vec2 at;
        double phase;
    };
    Drop drops[kDrops];
    for (int i = 0; i < kDrops; ++i) drops[i] = {even_point(i), 2 * kPi * lattice_number(i, 0, 11)};
    return draw(tile, [&](double u, double v) {
        double sum = 0;
        for (const Drop& drop : drops) {
            // The nearest of the tile's repetitions: a radius is less than half of it.
            const double x = std::remainder(u - drop.at.x, 1.0) * tile.width;
            const double y = std::remainder(v - drop.at.y, 1.0) * tile.height;
            const double r = std::hypot(x, y);
            if (r >= radius) continue;
            const double window = std::sin(kPi * r / radius);
            sum += window * window * std::cos(k * r - turned + drop.phase);
        }
        return kAmplitude * side * visible * sum;
    });
}

}  // namespace detail
}  // namespace mirrorball
