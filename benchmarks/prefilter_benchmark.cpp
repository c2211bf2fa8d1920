// Speed of prefiltering: the whole chain that a renderer takes, its plan and its stages, and the
// sum over every texel for comparison. docs/performance.md says how to read the figures.
#include <mirrorball/prefilter.h>

#include <cmath>
#include <map>
#include <memory>
#include <tuple>

#include <mirrorball/compare.h>
#include <mirrorball/resample.h>
#include <mirrorball/zonal.h>

#include "benchmark.h"
#include "core/parallel.h"
#include "harmonics/transforms.h"
#include "threads.h"

namespace mirrorball {
namespace {

using namespace detail;

constexpr int kPanoramaWidth = 1024;

const EnvironmentMap& sunset(Projection projection, int size) {
    static std::map<std::tuple<Projection, int>, EnvironmentMap> made;
    EnvironmentMap& map = made[{projection, size}];
    if (map.levels.empty())
        map = make_builtin("sunset", projection, size, default_axes(projection));
    return map;
}

// A panorama of the usual size, or a cube as large as the chain's level 0.
const EnvironmentMap& source_for(Projection projection, int chain_size) {
    return sunset(projection, projection == Projection::cube ? chain_size : kPanoramaWidth);
}

// All levels from the first that is not the source itself, irradiance, and three Phong maps.
std::vector<PrefilterTarget> chain(int size) {
    std::vector<PrefilterTarget> targets;
    const std::vector<Lobe> lobes = level_lobes("gltf", full_level_count(Projection::cube, size));
    for (std::size_t level = 1; level < lobes.size(); ++level)
        targets.push_back({.lobe = lobes[level], .size = size >> level});
    targets.push_back({.lobe = parse_lobe("diffuse"), .size = 64});
    for (const char* text : {"phong:10", "phong:100", "phong:1000"})
        targets.push_back({.lobe = parse_lobe(text), .size = 128});
    return targets;
}

std::int64_t texel_count(const Prefiltered& result) {
    std::int64_t count = 0;
    for (const EnvironmentMap& map : result.maps) count += texel_count(map);
    return count;
}

// Of the maps large enough for their texels to sum up to the light around.
void expect_fluxes(benchmark::State& state, const Prefiltered& result,
                   const EnvironmentMap& source) {
    for (const EnvironmentMap& map : result.maps) {
        if (map.width() >= 32)
            expect_flux(state, map, source, 1e-2, map.levels[0].lobe->integral());
    }
}

// ---- The chain. Items are texels of the result ----

void plan_chain(benchmark::State& state, Projection from) {
    const auto size = static_cast<int>(state.range(0));
    const Threads limit(static_cast<int>(state.range(1)));
    const EnvironmentMap& source = source_for(from, size);
    const std::vector<PrefilterTarget> targets = chain(size);
    for (auto _ : state) benchmark::DoNotOptimize(PrefilterPlan(shape_of(source), targets));
}

void time_run(benchmark::State& state, const EnvironmentMap& source, const PrefilterPlan& plan) {
    Prefiltered result = plan(source);
    for (auto _ : state) plan(source, result);
    expect_fluxes(state, result, source);
    double largest = 0;
    for (const double error : result.errors) largest = std::max(largest, error);
    state.counters["estimated_error"] = largest;
    state.SetItemsProcessed(state.iterations() * texel_count(result));
}

void run_chain(benchmark::State& state, Projection from) {
    const auto size = static_cast<int>(state.range(0));
    const Threads limit(static_cast<int>(state.range(1)));
    const EnvironmentMap& source = source_for(from, size);
    time_run(state, source, PrefilterPlan(shape_of(source), chain(size)));
}

void level_zero(benchmark::State& state, Projection from) {
    const auto size = static_cast<int>(state.range(0));
    const Threads limit(static_cast<int>(state.range(1)));
    const EnvironmentMap& source = source_for(from, size);
    const Resampler plan(shape_of(source),
                         {Projection::cube, size, default_axes(Projection::cube)});
    EnvironmentMap result = plan(source);
    for (auto _ : state) plan(source, result);
    expect_flux(state, result, source, 1e-2);
    state.SetItemsProcessed(state.iterations() * texel_count(result));
}

void sizes_and_threads(benchmark::internal::Benchmark* b) {
    b->ArgNames({"size", "threads"});
    for (const int size : {128, 256, 512, 1024, 2048})
        for (const int threads : {1, 2}) b->Args({size, threads});
    b->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK_CAPTURE(plan_chain, panorama, Projection::equirect)->Apply(sizes_and_threads);
BENCHMARK_CAPTURE(plan_chain, cube, Projection::cube)->Apply(sizes_and_threads);
BENCHMARK_CAPTURE(run_chain, panorama, Projection::equirect)->Apply(sizes_and_threads);
BENCHMARK_CAPTURE(run_chain, cube, Projection::cube)->Apply(sizes_and_threads);
BENCHMARK_CAPTURE(level_zero, panorama, Projection::equirect)->Apply(sizes_and_threads);

// ---- How cost grows, on a chain of 512 ----

void run_by_source_width(benchmark::State& state) {
    const EnvironmentMap& source = sunset(Projection::equirect, static_cast<int>(state.range(0)));
    time_run(state, source, PrefilterPlan(shape_of(source), chain(512)));
}

// Argument: the tolerance is ten to minus this.
void run_by_tolerance(benchmark::State& state) {
    const EnvironmentMap& source = sunset(Projection::equirect, kPanoramaWidth);
    const double tolerance = std::pow(10, -static_cast<double>(state.range(0)));
    time_run(state, source, PrefilterPlan(shape_of(source), chain(512), {.tolerance = tolerance}));
}

BENCHMARK(run_by_source_width)
    ->ArgName("width")
    ->RangeMultiplier(2)
    ->Range(512, 4096)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(run_by_tolerance)
    ->ArgName("digits")
    ->DenseRange(2, 6)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

// ---- Stages, on one lobe that a panorama of 1024 x 512 just carries ----

// What the finest level of a chain of 256 needs.
struct Stages {
    static constexpr int kSize = 128;

    Lobe lobe = parse_lobe("ggx:0.125");
    int band_count = mirrorball::band_count(lobe, 1e-3);
    std::shared_ptr<const LegendreTable> table = std::make_shared<LegendreTable>(band_count);
    RingTransform panorama{table, band_count, kPanoramaWidth / 2, kPanoramaWidth};
    // as SynthesisPlan has them
    RingTransform grid{table, band_count, (band_count * 3 / 2 + 31) / 32 * 32,
                       good_fourier_length(3 * band_count)};
    std::vector<double> lambda = zonal_coefficients(lobe, band_count);
    std::vector<double> power = squares(lambda);
    MapShape target{Projection::cube, kSize, default_axes(Projection::cube)};
    std::unique_ptr<TexelGrid> texels =
        make_texel_grid(target, grid, GridTaps(grid, power), GridUse::synthesis);
    std::vector<float> zonal{lambda.begin(), lambda.end()};
    std::vector<float> ring_weights = std::vector<float>(
        static_cast<std::size_t>(panorama.group_count()) * panorama.lane_count(), 1e-4f);

    static std::vector<double> squares(std::vector<double> values) {
        for (double& v : values) v *= v;
        return values;
    }
};

using Planes = std::array<GroupValues, 3>;

Planes make_planes(const RingTransform& rings) {
    return {rings.make_values(), rings.make_values(), rings.make_values()};
}

void fourier_analysis(const Stages& s, const EnvironmentMap& source, RingSpectra& spectra) {
    parallel_for(s.panorama.group_count(), [&](std::int64_t i) {
        const int group = static_cast<int>(i);
        Planes planes = make_planes(s.panorama);
        GroupValues scratch = s.panorama.make_values();
        s.panorama.load_rows(group, source.levels[0].faces[0].values().data(), planes);
        s.panorama.to_spectra(group, planes, scratch, {}, s.ring_weights, spectra);
    });
}

void fourier_synthesis(const Stages& s, const RingSpectra& spectra, TexelGrid::Buffer& buffer) {
    parallel_for(s.grid.group_count(), [&](std::int64_t i) {
        const int group = static_cast<int>(i);
        Planes planes = make_planes(s.grid);
        GroupValues scratch = s.grid.make_values();
        s.grid.from_spectra(group, spectra, s.grid.band_count(), {}, planes, scratch);
        s.texels->scatter_group(group, planes, buffer);
    });
}

// Operations of a complex transform of each ring pair and channel, as they are usually counted.
double fourier_operations(const RingTransform& rings) {
    const double length = rings.column_count();
    return 3.0 * rings.group_count() * rings.lane_count() * 5 * length * std::log2(length);
}

// Fourteen multiply-adds per step of the recurrence and ring pair; two of them are in double and
// count twice. Steps that are skipped near the poles count too: about a quarter.
double legendre_operations(const RingTransform& rings) {
    double steps = 0;
    for (int m = 0; m < rings.band_count(); ++m)
        steps += LegendreTable::step_count(m, rings.band_count());
    return 2.0 * 16 * steps * rings.group_count() * rings.lane_count();
}

void count_operations(benchmark::State& state, double operations) {
    state.counters["FLOP/s"] =
        benchmark::Counter(operations, benchmark::Counter::kIsIterationInvariantRate);
}

void stage_analysis_fourier(benchmark::State& state) {
    const Threads limit(static_cast<int>(state.range(0)));
    const Stages s;
    const EnvironmentMap& source = sunset(Projection::equirect, kPanoramaWidth);
    RingSpectra spectra = s.panorama.make_spectra();
    for (auto _ : state) fourier_analysis(s, source, spectra);
    count_operations(state, fourier_operations(s.panorama));
}

void stage_analysis_legendre(benchmark::State& state) {
    const Threads limit(static_cast<int>(state.range(0)));
    const Stages s;
    RingSpectra spectra = s.panorama.make_spectra();
    fourier_analysis(s, sunset(Projection::equirect, kPanoramaWidth), spectra);
    Harmonics harmonics(s.band_count);
    for (auto _ : state) s.panorama.analyse(spectra, harmonics);
    count_operations(state, legendre_operations(s.panorama));
}

Harmonics analysed(const Stages& s) {
    RingSpectra spectra = s.panorama.make_spectra();
    fourier_analysis(s, sunset(Projection::equirect, kPanoramaWidth), spectra);
    Harmonics harmonics(s.band_count);
    s.panorama.analyse(spectra, harmonics);
    return harmonics;
}

void stage_synthesis_legendre(benchmark::State& state) {
    const Threads limit(static_cast<int>(state.range(0)));
    const Stages s;
    const Harmonics harmonics = analysed(s);
    RingSpectra spectra = s.grid.make_spectra();
    for (auto _ : state) s.grid.synthesise(harmonics, s.zonal, spectra);
    count_operations(state, legendre_operations(s.grid));
}

void stage_synthesis_fourier(benchmark::State& state) {
    const Threads limit(static_cast<int>(state.range(0)));
    const Stages s;
    RingSpectra spectra = s.grid.make_spectra();
    s.grid.synthesise(analysed(s), s.zonal, spectra);
    TexelGrid::Buffer buffer = s.texels->make_buffer();
    for (auto _ : state) fourier_synthesis(s, spectra, buffer);
    count_operations(state, fourier_operations(s.grid));
}

// Items are texels of the result.
void stage_texels(benchmark::State& state) {
    const Threads limit(static_cast<int>(state.range(0)));
    const Stages s;
    RingSpectra spectra = s.grid.make_spectra();
    s.grid.synthesise(analysed(s), s.zonal, spectra);
    TexelGrid::Buffer buffer = s.texels->make_buffer();
    fourier_synthesis(s, spectra, buffer);
    EnvironmentMap result = make_environment_map(Projection::cube, Stages::kSize);
    constexpr float kBound = 1e30f;
    for (auto _ : state) {
        s.texels->make_texels(buffer, Vec3f(-kBound, -kBound, -kBound),
                              Vec3f(kBound, kBound, kBound), result.levels[0].faces);
    }
    state.SetItemsProcessed(state.iterations() * texel_count(result));
    state.SetBytesProcessed(state.iterations() * texel_count(result) * 12);
}

void on_threads(benchmark::internal::Benchmark* b) {
    b->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK(stage_analysis_fourier)->Apply(on_threads);
BENCHMARK(stage_analysis_legendre)->Apply(on_threads);
BENCHMARK(stage_synthesis_legendre)->Apply(on_threads);
BENCHMARK(stage_synthesis_fourier)->Apply(on_threads);
BENCHMARK(stage_texels)->Apply(on_threads);

// ---- A slider: one lobe after the other, of a source that is taken apart ----

// As fine a cube as the source shows of the lobe, made a second time: the first finds what is kept.
void new_lobe(benchmark::State& state, const char* text, int size) {
    LobeFilter filter(std::shared_ptr<const EnvironmentMap>(
        &sunset(Projection::equirect, kPanoramaWidth), [](const EnvironmentMap*) {}));
    const PrefilterTarget target{.lobe = parse_lobe(text), .size = size};
    EnvironmentMap result = filter(target);
    for (auto _ : state) result = filter(target);
    expect_flux(state, result, filter.source(), 1e-2, target.lobe.integral());
}

#define MIRRORBALL_NEW_LOBE(name, ...)             \
    BENCHMARK_CAPTURE(new_lobe, name, __VA_ARGS__) \
        ->Unit(benchmark::kMillisecond)            \
        ->MeasureProcessCPUTime()                  \
        ->UseRealTime()
MIRRORBALL_NEW_LOBE(ggx_0_08, "ggx:0.08", 256);
MIRRORBALL_NEW_LOBE(ggx_0_1, "ggx:0.1", 256);
MIRRORBALL_NEW_LOBE(ggx_0_15, "ggx:0.15", 256);
MIRRORBALL_NEW_LOBE(ggx_0_2, "ggx:0.2", 256);
MIRRORBALL_NEW_LOBE(ggx_0_3, "ggx:0.3", 128);
MIRRORBALL_NEW_LOBE(ggx_0_5, "ggx:0.5", 64);
MIRRORBALL_NEW_LOBE(ggx_1, "ggx:1", 32);
MIRRORBALL_NEW_LOBE(phong_10, "phong:10", 64);
MIRRORBALL_NEW_LOBE(phong_100, "phong:100", 256);
MIRRORBALL_NEW_LOBE(phong_1000, "phong:1000", 256);

// ---- The sum over every texel, from a panorama a sixteenth as large. Items are pairs ----

void reference(benchmark::State& state, const char* lobe) {
    const EnvironmentMap& source = sunset(Projection::equirect, 256);
    const PrefilterTarget target{.lobe = parse_lobe(lobe), .size = 16};
    EnvironmentMap result;
    for (auto _ : state) result = prefilter_reference(source, target);
    expect_flux(state, result, source, 1e-2, target.lobe.integral());
    state.SetItemsProcessed(state.iterations() * texel_count(result) * texel_count(source));
}

BENCHMARK_CAPTURE(reference, diffuse, "diffuse")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(reference, ggx, "ggx:0.5")->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace mirrorball
