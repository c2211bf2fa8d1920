// Speed of the transforms by bands, grid and threads: --benchmark_filter=harmonics. Plan and run
// apart; gflops counts the multiplications and additions of the Legendre stage alone, as if none
// were left out: 6 channels' sums, twice, for each pair of rings, degree and order.
#include <algorithm>
#include <cmath>
#include <random>

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <mirrorball/harmonics.h>
#include <mirrorball/zonal.h>

#include "benchmark.h"

namespace mirrorball {
namespace {

Harmonics noise(int band_count) {
    Harmonics result(band_count);
    std::mt19937 random(1);
    std::normal_distribution<float> value;
    for (int m = 0; m < band_count; ++m) {
        for (float& v : result.order(m)) v = value(random);
    }
    const std::span<float> zonal = result.order(0);  // has cosines alone
    for (std::size_t i = 0; i < zonal.size(); ++i) zonal[i] *= i % 6 < 3 ? 1.0f : 0.0f;
    return result;
}

MapShape cube_shape(int size) {
    return {Projection::cube, size, default_axes(Projection::cube)};
}

// Runs `work` on `threads` threads, for each iteration.
template <class Work>
void run_on(benchmark::State& state, int threads, const Work& work) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    tbb::task_arena arena(threads);
    arena.execute([&] {
        for (auto _ : state) work();
    });
}

void count_flops(benchmark::State& state, double ring_pairs, double bands) {
    state.counters["gflops"] = benchmark::Counter(
        12 * ring_pairs * bands * (bands + 1) / 2 * 1e-9 * static_cast<double>(state.iterations()),
        benchmark::Counter::kIsRate);
}

void harmonics_analysis_of_panorama(benchmark::State& state) {
    const int bands = static_cast<int>(state.range(0)), width = static_cast<int>(state.range(1));
    const EnvironmentMap map = panorama(width);
    const HarmonicAnalysis analysis(shape_of(map), bands);
    Harmonics found;
    run_on(state, static_cast<int>(state.range(2)), [&] { analysis(map, found); });
    const double expected = flux(map).y / std::sqrt(4 * kPi);
    if (!(std::abs(found.coefficient(0, 0).y / expected - 1) < 1e-5))
        state.SkipWithError("the first coefficient is not the mean");
    count_flops(state, width / 4, bands);
}

void harmonics_analysis_of_cube(benchmark::State& state) {
    const int bands = static_cast<int>(state.range(0)), size = static_cast<int>(state.range(1));
    const MapShape shape = cube_shape(size);
    const EnvironmentMap map = make_builtin("sunset", shape.projection, size, shape.axes);
    const HarmonicAnalysis analysis(shape, bands);
    Harmonics found;
    run_on(state, static_cast<int>(state.range(2)), [&] { analysis(map, found); });
    const double expected = flux(map).y / std::sqrt(4 * kPi);
    if (!(std::abs(found.coefficient(0, 0).y / expected - 1) < 1e-5))
        state.SkipWithError("the first coefficient is not the mean");
    count_flops(state, 1.5 * bands, bands);
}

void harmonics_synthesis_to_cube(benchmark::State& state) {
    const int bands = static_cast<int>(state.range(0)), size = static_cast<int>(state.range(1));
    const HarmonicSynthesis synthesis(cube_shape(size), bands);
    const Harmonics light = noise(bands);
    EnvironmentMap map = synthesis(light);
    const std::vector<double> ones(bands, 1.0);
    run_on(state, static_cast<int>(state.range(2)), [&] { synthesis(light, ones, map); });
    const Vec3d d =
        map.axes.to_world(Cube::direction(FacePoint<double>{2, 0.5 / size, 0.5 / size}));
    if (!((Vec3d(map.levels[0].faces[2].rgb(0, 0)) - evaluate(light, d)).length() < 1e-4 * bands))
        state.SkipWithError("a texel is not what its direction has");
    count_flops(state, 1.5 * bands, bands);
}

// A slider of roughness: the lobe's coefficients and the cube, for each frame.
void harmonics_slider(benchmark::State& state) {
    const int bands = static_cast<int>(state.range(0)), size = static_cast<int>(state.range(1));
    const Harmonics light = analyse(panorama(512), bands);
    const HarmonicSynthesis synthesis(cube_shape(size), bands, parse_lobe("ggx:0.25"));
    EnvironmentMap map = synthesis(light);
    const TexelRange range{{0, 0, 0}, {1e4f, 1e4f, 1e4f}};
    int frame = 0;
    run_on(state, static_cast<int>(state.range(2)), [&] {
        const Lobe lobe{Lobe::Kind::ggx, 0.25 + 0.001 * (frame++ % 500)};
        synthesis(light, zonal_coefficients(lobe, bands), map, range);
    });
    const double expected = light.coefficient(0, 0).y * std::sqrt(4 * kPi);
    if (!(std::abs(flux(map).y / expected - 1) < 1e-2)) state.SkipWithError("the flux changed");
}

void harmonics_rotation(benchmark::State& state) {
    const int bands = static_cast<int>(state.range(0));
    const Harmonics light = noise(bands);
    const Axes axes = rotated(Axes{}, 0.7, 0.4, -0.2);
    Harmonics found;
    run_on(state, static_cast<int>(state.range(1)), [&] { found = rotated(light, axes); });
    const double before = power_spectrum(light).back(), after = power_spectrum(found).back();
    if (!(std::abs(after / before - 1) < 1e-5)) state.SkipWithError("the power changed");
}

void harmonics_evaluation(benchmark::State& state) {
    const Harmonics light = noise(static_cast<int>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(evaluate(light, Vec3d(0.6, 0.64, 0.48)));
}

void harmonics_plan(benchmark::State& state) {
    const int bands = static_cast<int>(state.range(0)), size = static_cast<int>(state.range(1));
    for (auto _ : state) benchmark::DoNotOptimize(HarmonicSynthesis(cube_shape(size), bands));
}

#define MIRRORBALL_BENCHMARK(name) BENCHMARK(name)->UseRealTime()->Unit(benchmark::kMicrosecond)

MIRRORBALL_BENCHMARK(harmonics_slider)->ArgsProduct({{128, 160, 192}, {64}, {1, 2}});
MIRRORBALL_BENCHMARK(harmonics_analysis_of_panorama)
    ->ArgsProduct({{64, 128, 256, 512, 1024}, {1024, 2048}, {1, 2}});
MIRRORBALL_BENCHMARK(harmonics_analysis_of_cube)
    ->ArgsProduct({{64, 128, 256, 512, 1024}, {256}, {1, 2}});
MIRRORBALL_BENCHMARK(harmonics_synthesis_to_cube)
    ->ArgsProduct({{64, 128, 256, 512, 1024}, {256}, {1, 2}});
MIRRORBALL_BENCHMARK(harmonics_rotation)->ArgsProduct({{64, 128, 256, 512, 1024}, {1, 2}});
BENCHMARK(harmonics_evaluation)->Arg(64)->Arg(1024)->Unit(benchmark::kMicrosecond);
MIRRORBALL_BENCHMARK(harmonics_plan)->ArgsProduct({{128, 512}, {64, 256}});

}  // namespace
}  // namespace mirrorball
