// Speed of prefiltering: the reference sum and its fast counterpart. Items are texels of the
// result.
#include <mirrorball/prefilter.h>

#include <mirrorball/compare.h>

#include "benchmark.h"

namespace mirrorball {
namespace {

void reference(benchmark::State& state, const char* lobe) {
    const EnvironmentMap source = panorama(256);
    const PrefilterTarget target{.lobe = parse_lobe(lobe),
                                 .size = static_cast<int>(state.range(0))};
    EnvironmentMap result;
    for (auto _ : state) result = prefilter_reference(source, target);
    expect_flux(state, result, source, 1e-2, target.lobe.integral());
    state.SetItemsProcessed(state.iterations() * texel_count(result));
}

void fast(benchmark::State& state, const char* lobe) {
    const EnvironmentMap source = panorama(1024);
    const PrefilterTarget target{.lobe = parse_lobe(lobe),
                                 .size = static_cast<int>(state.range(0))};
    std::vector<EnvironmentMap> results;
    for (auto _ : state) results = prefilter(source, std::span(&target, 1));
    expect_flux(state, results.front(), source, 1e-2, target.lobe.integral());
    state.SetItemsProcessed(state.iterations() * texel_count(results.front()));
}

BENCHMARK_CAPTURE(reference, diffuse, "diffuse")
    ->Arg(16)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(reference, ggx, "ggx:0.5")->Arg(16)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(fast, diffuse, "diffuse")->Arg(64)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(fast, ggx_rough, "ggx:0.8")
    ->Arg(64)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(fast, ggx_glossy, "ggx:0.3")
    ->Arg(128)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace mirrorball
