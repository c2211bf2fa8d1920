// Speed of what a plan does for each lobe, and of the near field. Items are coefficients, then
// pairs of a texel and a light within reach.
#include <algorithm>
#include <cmath>

#include <benchmark/benchmark.h>
#include <mirrorball/zonal.h>

#include "prefilter/band_split.h"
#include "prefilter/near_field.h"

namespace mirrorball {
namespace {

void zonal(benchmark::State& state, const char* text) {
    const Lobe lobe = parse_lobe(text);
    const int count = static_cast<int>(state.range(0));
    std::vector<double> lambda;
    for (auto _ : state) benchmark::DoNotOptimize(lambda = zonal_coefficients(lobe, count));
    if (std::abs(lambda[0] - lobe.integral()) > 1e-12)
        state.SkipWithError("the first coefficient is not the integral");
    state.SetItemsProcessed(state.iterations() * count);
}

void split(benchmark::State& state, const char* text) {
    const Lobe lobe = parse_lobe(text);
    detail::BandSplit split;
    for (auto _ : state) benchmark::DoNotOptimize(split = detail::split_bands(lobe, 1e-4, 1024));
    if (std::abs(split.far[0] - lobe.integral()) > 1e-12)
        state.SkipWithError("the far part has lost flux");
}

// A tile of 8 x 8 texels in the middle of the near part about lights at +Z.
void near_field(benchmark::State& state, const char* text) {
    constexpr int size = 8;
    const detail::NearKernel near = detail::split_bands(parse_lobe(text), 1e-4, 1024).near;
    const float chord = (near.parts().back().nearest + near.parts().back().farthest) / 2;
    const float angle = 2 * std::asin(chord / 2);
    std::vector<float> x, y, z, sums[3];
    for (int i = 0; i < size * size; ++i) {
        Vec3f d(std::sin(angle) + 0.001f * static_cast<float>(i % size),
                0.001f * static_cast<float>(i / size), std::cos(angle));
        d.normalize();
        x.push_back(d.x);
        y.push_back(d.y);
        z.push_back(d.z);
    }
    for (std::vector<float>& sum : sums) sum.resize(x.size());
    const int light_count = static_cast<int>(state.range(0));
    std::vector<detail::Light> lights;
    for (int i = 0; i < light_count; ++i) {
        const float turn = static_cast<float>(i);
        const float away = 1e-3f * turn / static_cast<float>(light_count);
        Vec3f d(away * std::cos(turn), away * std::sin(turn), 1);
        lights.push_back({d.normalize(), {1, 1, 1}, 1e-3f});
    }
    const detail::NearField field(lights);
    for (auto _ : state) field.add(near, {x, y, z, sums[0], sums[1], sums[2]});
    if (std::all_of(sums[0].begin(), sums[0].end(), [](float sum) { return sum == 0; }))
        state.SkipWithError("nothing was added");
    state.SetItemsProcessed(state.iterations() * light_count * size * size);
}

BENCHMARK_CAPTURE(zonal, ggx, "ggx:0.1")->Arg(600)->Arg(4096)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(split, ggx, "ggx:0.125")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(split, ggx_rough, "ggx:0.75")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(split, phong, "phong:1000")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(split, ggx_narrow, "ggx:0.05")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(near_field, diffuse, "diffuse")->Arg(800)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(near_field, ggx_narrow, "ggx:0.05")->Arg(800)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace mirrorball
