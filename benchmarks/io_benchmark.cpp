// Speed of writing and reading files, on a temporary folder. Items are texels.
#include <mirrorball/io.h>

#include <filesystem>
#include <string>

#include <unistd.h>

#include "benchmark.h"

namespace mirrorball {
namespace {

void write_and_read(benchmark::State& state, const char* ending) {
    const EnvironmentMap source = panorama(static_cast<int>(state.range(0)));
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() /
        ("mirrorball-benchmark-" + std::to_string(getpid()) + ending);
    EnvironmentMap result;
    for (auto _ : state) {
        write_map(path.string(), source);
        result = read_map(path.string()).map;
    }
    std::filesystem::remove(path);
    // shared exponents keep 8 bits, half floats 11
    expect_flux(state, result, source, 4e-3);
    state.SetItemsProcessed(state.iterations() * texel_count(source));
}

BENCHMARK_CAPTURE(write_and_read, hdr, ".hdr")
    ->Arg(1024)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(write_and_read, exr, ".exr")
    ->Arg(1024)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(write_and_read, pfm, ".pfm")
    ->Arg(1024)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(write_and_read, ktx2, ".ktx2")
    ->Arg(1024)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace mirrorball
