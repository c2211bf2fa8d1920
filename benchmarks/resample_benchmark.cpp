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

// With the plan apart: arguments are the source's size and that of the cube made of it.
struct PlanCase {
    EnvironmentMap source;
    MapShape target;
};

PlanCase plan_case(const benchmark::State& state, Projection from) {
    return {make_builtin("sunset", from, static_cast<int>(state.range(0)), default_axes(from)),
            {Projection::cube, static_cast<int>(state.range(1)), default_axes(Projection::cube)}};
}

void plan_cube(benchmark::State& state, Projection from) {
    const PlanCase c = plan_case(state, from);
    std::size_t bytes = 0;
    for (auto _ : state) bytes = Resampler(shape_of(c.source), c.target).bytes();
    state.counters["plan_bytes"] = static_cast<double>(bytes);
}

void run_plan(benchmark::State& state, Projection from) {
    const PlanCase c = plan_case(state, from);
    const Resampler plan(shape_of(c.source), c.target);
    EnvironmentMap result;
    for (auto _ : state) result = plan(c.source);
    expect_flux(state, result, c.source, 1e-2);
    state.SetItemsProcessed(state.iterations() * texel_count(result));
}

// Into a map that is there: what run_plan takes longer is the cost of fresh memory.
void run_plan_in_place(benchmark::State& state, Projection from) {
    const PlanCase c = plan_case(state, from);
    const Resampler plan(shape_of(c.source), c.target);
    EnvironmentMap result = plan(c.source);
    for (auto _ : state) plan(c.source, result);
    expect_flux(state, result, c.source, 1e-2);
    state.SetItemsProcessed(state.iterations() * texel_count(result));
}

void from_panorama(benchmark::internal::Benchmark* benchmark) {
    benchmark->Args({1024, 256})->Args({1024, 512})->Args({1024, 1024});
    benchmark->Unit(benchmark::kMillisecond)->UseRealTime();
}

// Of one size it is a copy.
void from_cube(benchmark::internal::Benchmark* benchmark) {
    benchmark->Args({512, 512})->Args({1024, 512})->Args({256, 512});
    benchmark->Unit(benchmark::kMillisecond)->UseRealTime();
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
    ->Args({1024, 1024})
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
BENCHMARK_CAPTURE(plan_cube, panorama, Projection::equirect)->Apply(from_panorama);
BENCHMARK_CAPTURE(run_plan, panorama, Projection::equirect)->Apply(from_panorama);
BENCHMARK_CAPTURE(run_plan_in_place, panorama, Projection::equirect)->Apply(from_panorama);
BENCHMARK_CAPTURE(plan_cube, cube, Projection::cube)->Apply(from_cube);
BENCHMARK_CAPTURE(run_plan, cube, Projection::cube)->Apply(from_cube);
BENCHMARK_CAPTURE(run_plan_in_place, cube, Projection::cube)->Apply(from_cube);
BENCHMARK(mip_levels)->Arg(512)->Arg(2048)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace mirrorball
