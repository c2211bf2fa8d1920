// Sources: tiles without seams at any size, the same bits each time, waves that move as water does.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include <mirrorball/bump.h>
#include <mirrorball/error.h>

namespace mirrorball {
namespace {

std::vector<float> values(const HeightMap& map) {
    return {map.heights.values().begin(), map.heights.values().end()};
}

// The largest third difference along rows or columns that begins at `from` and goes around the
// edges. Where a tile is torn, differences across the tear are of the heights' own size.
double roughest(const HeightMap& map, bool down, int from, int to) {
    const int width = map.heights.width(), height = map.heights.height();
    const int across = down ? width : height, length = down ? height : width;
    double most = 0;
    for (int j = 0; j < across; ++j)
        for (int i = from; i < to; ++i) {
            const auto at = [&](int k) -> double {
                const int m = ((i + k) % length + length) % length;
                return down ? *map.heights.at(j, m) : *map.heights.at(m, j);
            };
            most = std::max(most, std::abs(at(3) - 3 * at(2) + 3 * at(1) - at(0)));
        }
    return most;
}

TEST(BumpSources, TileWithoutASeam) {
    for (const BumpSource& source : bump_sources())
        for (const auto& [width, height] : {std::pair{192, 192}, {150, 97}, {64, 200}}) {
            const HeightMap map = make_bump(source.name, width, height, {.time = 1.7});
            EXPECT_EQ(map.heights.width(), width);
            EXPECT_EQ(map.heights.height(), height);
            EXPECT_DOUBLE_EQ(map.width, source.width);
            for (const bool down : {false, true}) {
                const int length = down ? height : width;
                const double inside = roughest(map, down, 0, length - 3);
                EXPECT_LE(roughest(map, down, length - 3, length), 1.2 * inside)
                    << source.name << " " << width << " x " << height << (down ? " down" : "");
            }
        }
}

TEST(BumpSources, AreFiniteAndNeitherFlatNorSteep) {
    for (const BumpSource& source : bump_sources()) {
        const HeightMap map = make_bump(source.name, 256, 256);
        const SlopeMap slope = slopes(map);
        double squares = 0;
        for (const float value : slope.slopes.values()) {
            ASSERT_TRUE(std::isfinite(value)) << source.name;
            squares += value * value;
        }
        const double rms = std::sqrt(squares / 65536);
        if (source.name == "flat") {
            EXPECT_EQ(rms, 0);
        } else {
            EXPECT_GT(rms, 0.01) << source.name;
            EXPECT_LT(rms, 1) << source.name;
        }
    }
}

TEST(BumpSources, AreTheSameBitsAtAnyNumberOfThreads) {
    for (const BumpSource& source : bump_sources()) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 4);
        std::vector<float> one, many;
        tbb::task_arena(1).execute([&] { one = values(make_bump(source.name, 100, 60)); });
        tbb::task_arena(4).execute([&] { many = values(make_bump(source.name, 100, 60)); });
        EXPECT_EQ(one, many) << source.name;
    }
}

TEST(BumpSources, AnySizeDownToOneTexelAndAnyShape) {
    for (const BumpSource& source : bump_sources())
        for (const auto& [width, height] :
             {std::pair{1, 1}, {2, 3}, {4000, 1}, {1, 4000}, {3, 300}}) {
            const HeightMap map = make_bump(source.name, width, height);
            const SlopeMap slope = slopes(map);
            EXPECT_TRUE(std::all_of(slope.slopes.values().begin(), slope.slopes.values().end(),
                                    [](float v) { return std::isfinite(v); }))
                << source.name << width << "x" << height;
        }
}

// What is too fine for the texels is gone, so that a small tile is smooth: of the energy of its
// neighbours' differences, alternation from texel to texel has little.
TEST(BumpSources, DoNotAlias) {
    for (const BumpSource& source : bump_sources()) {
        for (const int size : {16, 64, 256}) {
            const HeightMap map = make_bump(source.name, size, size);
            double alternating = 0, total = 0, mean = 0;
            for (const float h : map.heights.values()) mean += h;
            mean /= size * size;
            for (int y = 0; y < size; ++y) {
                double sum = 0;
                for (int x = 0; x < size; ++x) {
                    const double h = *map.heights.at(x, y) - mean;
                    sum += x % 2 == 0 ? h : -h;
                    total += h * h;
                }
                alternating += sum * sum / size;  // of the highest frequency, by Parseval
            }
            // One of `size` frequencies: white noise would have 1 / size of it all.
            EXPECT_LE(alternating, 0.3 * total / size) << source.name << " " << size;
        }
    }
}

// The same relief at twice the size of the tile, twice as high.
TEST(BumpSources, HeightsGrowWithTheTile) {
    for (const BumpSource& source : bump_sources()) {
        const HeightMap map = make_bump(source.name, 96, 96);
        const HeightMap twice = make_bump(source.name, 96, 96, {.width = 2 * source.width});
        const auto largest = [](const HeightMap& m) {
            double most = 0;
            for (const float h : m.heights.values()) most = std::max<double>(most, std::abs(h));
            return most;
        };
        EXPECT_NEAR(largest(twice), 2 * largest(map), 1e-5 * largest(twice)) << source.name;
        EXPECT_DOUBLE_EQ(twice.height, twice.width);
    }
}

// Water -------------------------------------------------------------------------------------------

// The coefficient of the tile's cosine of so many cycles to the right and up.
std::complex<double> coefficient(const HeightMap& map, double kx, double ky) {
    std::complex<double> sum = 0;
    const int columns = map.heights.width(), rows = map.heights.height();
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            sum += double{*map.heights.at(x, y)} *
                   std::polar(1.0, -(kx * (x + 0.5) / columns * map.width +
                                     ky * (1 - (y + 0.5) / rows) * map.height));
    return sum * 2.0 / static_cast<double>(columns * rows);
}

TEST(Waves, FitTheTileAndObeyDeepWater) {
    for (const WaterWave& wave : water_waves(16, 9)) {
        const double across = wave.kx * 16 / (2 * kPi), up = wave.ky * 9 / (2 * kPi);
        EXPECT_NEAR(across, std::round(across), 1e-9);
        EXPECT_NEAR(up, std::round(up), 1e-9);
        EXPECT_NEAR(wave.omega() * wave.omega(), 9.80665 * std::hypot(wave.kx, wave.ky), 1e-9);
        const double h = 1e-5;
        EXPECT_NEAR(wave.velocity(1.2, 3.4, 5.6),
                    (wave.height(1.2, 3.4, 5.6 + h) - wave.height(1.2, 3.4, 5.6 - h)) / (2 * h),
                    1e-6 * wave.amplitude * wave.omega());
    }
}

TEST(Waves, ArePicturedAsTheirSum) {
    constexpr double kTime = 12.3;
    const HeightMap map = make_bump("waves", 320, 256, {.width = 20, .height = 16, .time = kTime});
    const std::vector<WaterWave> waves = water_waves(20, 16);
    for (const auto& [column, row] : {std::pair{0, 0}, {17, 200}, {319, 255}, {160, 3}}) {
        const double x = (column + 0.5) / 320 * 20, y = (1 - (row + 0.5) / 256) * 16;
        double sum = 0;
        for (const WaterWave& wave : waves) sum += wave.height(x, y, kTime);
        EXPECT_NEAR(*map.heights.at(column, row), sum, 1e-7) << column << " " << row;
    }
}

// Phase at time t, measured in the pictures.
TEST(Waves, MoveByTheirDispersion) {
    constexpr double kStep = 0.31;
    const HeightMap before = make_bump("waves", 96, 96, {.time = 2});
    const HeightMap after = make_bump("waves", 96, 96, {.time = 2 + kStep});
    const std::vector<WaterWave> waves = water_waves(before.width, before.height);
    int measured = 0;
    for (const WaterWave& wave : waves) {
        const auto shares = [&](const WaterWave& other) {
            return std::abs(std::hypot(wave.kx - other.kx, wave.ky - other.ky)) < 1e-9;
        };
        const std::complex<double> a = coefficient(before, wave.kx, wave.ky);
        if (std::count_if(waves.begin(), waves.end(), shares) != 1) continue;
        const std::complex<double> b = coefficient(after, wave.kx, wave.ky);
        if (std::abs(a) < 0.5 * wave.amplitude) continue;  // fades, at 96 texels
        // Floats' rounding over the smallest of the amplitudes, 1e-3 m of a sea of 0.3 m.
        EXPECT_NEAR(std::remainder(std::arg(b / a) + wave.omega() * kStep, 2 * kPi), 0, 1e-4);
        ++measured;
    }
    EXPECT_GT(measured, 20);
}

TEST(Ripples, MoveOutwardByTheirDispersion) {
    // 24 rings a metre: a period later the picture is the same again.
    const double omega = std::sqrt(9.80665 * 2 * kPi * 24);
    const std::vector<float> now = values(make_bump("ripples", 128, 128, {.time = 1}));
    const std::vector<float> later =
        values(make_bump("ripples", 128, 128, {.time = 1 + 2 * kPi / omega}));
    const std::vector<float> half =
        values(make_bump("ripples", 128, 128, {.time = 1 + kPi / omega}));
    for (std::size_t i = 0; i < now.size(); ++i) {
        EXPECT_NEAR(now[i], later[i], 1e-9);
        EXPECT_NEAR(now[i], -half[i], 1e-9);
    }
}

TEST(BumpSources, WhatMakesNoSenseIsRefused) {
    try {
        (void)make_bump("wavs", 8, 8);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::usage);
        EXPECT_NE(std::string(error.what()).find("ripples, waves"), std::string::npos);
    }
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW((void)make_bump("waves", 8, 8, {.time = nan}), Error);
    EXPECT_THROW((void)make_bump("waves", 8, 8, {.width = nan}), Error);
    EXPECT_THROW((void)make_bump("waves", 8, 8, {.width = -1}), Error);
    EXPECT_THROW((void)make_bump("noise", 8, 8, {.height = 1e9}), Error);
}

}  // namespace
}  // namespace mirrorball
