// Speed of resampling and of mip levels. Items are texels of the result.
#include <mirrorball/resample.h>

#include "benchmark.h"

namespace mirrorball {
namespace {

// Arguments: the panorama's width, the size of the result.
void resample_panorama(benchmark::State& state, Projection projection) {
    const EnvironmentMap source = panorama(static_cast<int>(state.range(0)));
    const int size = static_cast<int>(state.range(1));
    EnvironmentMap result;
    for (auto _ : state) result = resample(source, projection, size, default_axes(projection));
    // the sun is a few texels wide, and bicubic interpolation keeps it to about this
    expect_flux(state, result, source, 1e-2);
    state.SetItemsProcessed(state.iterations() * texel_count(result));
}

void mip_levels(benchmark::State& state) {
    const int size = static_cast<int>(state.range(0));
    const EnvironmentMap cube =
        make_builtin("sunset", Projection::cube, size, default_axes(Projection::cube));
    EnvironmentMap result;
    for (auto _ : state) {
        result = cube;
        append_mip_levels(result);
    }
    expect_flux(state, result, cube, 1e-6);
    state.SetItemsProcessed(state.iterations() * texel_count(result));
}

BENCHMARK_CAPTURE(resample_panorama, cube, Projection::cube)
    ->Args({1024, 256})
    ->Args({1024, 512})
    ->Args({8192, 2048})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(resample_panorama, octahedral, Projection::octahedral)
    ->Args({1024, 512})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(resample_panorama, sphere, Projection::sphere)
    ->Args({1024, 512})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(mip_levels)->Arg(512)->Arg(2048)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace mirrorball
