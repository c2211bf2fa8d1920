// What this machine can do at most, to see by how much the rest falls short: multiply-adds in
// registers, and memory read and copied. Measured in the same run, since such figures change from
// minute to minute where machines are shared. Argument: threads.
#include <array>
#include <cstring>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/parallel.h"
#include "threads.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "machine_benchmark.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mirrorball {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Chains enough to hide a multiply-add's latency on two ports. Returns how many operations it did.
double multiply_add(int repetitions, float* result) {
    const hn::ScalableTag<float> d;
    const auto factor = hn::Set(d, 0.999f), term = hn::Set(d, 0.001f);
    auto a = hn::Set(d, result[0]), b = a, c = a, e = a, f = a, g = a, h = a, i = a, j = a, k = a;
    for (int n = 0; n < repetitions; ++n) {
        a = hn::MulAdd(a, factor, term), b = hn::MulAdd(b, factor, term);
        c = hn::MulAdd(c, factor, term), e = hn::MulAdd(e, factor, term);
        f = hn::MulAdd(f, factor, term), g = hn::MulAdd(g, factor, term);
        h = hn::MulAdd(h, factor, term), i = hn::MulAdd(i, factor, term);
        j = hn::MulAdd(j, factor, term), k = hn::MulAdd(k, factor, term);
    }
    const auto sum = hn::Add(hn::Add(hn::Add(a, b), hn::Add(c, e)),
                             hn::Add(hn::Add(hn::Add(f, g), hn::Add(h, i)), hn::Add(j, k)));
    result[0] = hn::GetLane(sum);
    return 2.0 * 10 * repetitions * static_cast<double>(hn::Lanes(d));
}

// The sum of a long array, eight vectors at a time.
float sum(const float* values, std::size_t count) {
    const hn::ScalableTag<float> d;
    const std::size_t n = hn::Lanes(d);
    auto a = hn::Zero(d), b = a, c = a, e = a;
    for (std::size_t i = 0; i + 4 * n <= count; i += 4 * n) {
        a = hn::Add(a, hn::LoadU(d, values + i));
        b = hn::Add(b, hn::LoadU(d, values + i + n));
        c = hn::Add(c, hn::LoadU(d, values + i + 2 * n));
        e = hn::Add(e, hn::LoadU(d, values + i + 3 * n));
    }
    return hn::GetLane(hn::Add(hn::Add(a, b), hn::Add(c, e)));
}

}  // namespace HWY_NAMESPACE
}  // namespace mirrorball
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mirrorball {
namespace {

HWY_EXPORT(multiply_add);
HWY_EXPORT(sum);

constexpr std::size_t kFloatCount = std::size_t{64} << 18;  // 64 MiB, beyond most caches
constexpr std::size_t kPiece = kFloatCount / 64;

void machine_multiply_add(benchmark::State& state) {
    const auto threads = static_cast<int>(state.range(0));
    const Threads limit(threads);
    constexpr int kRepetitions = 1 << 20;
    double operations = 0;
    for (auto _ : state) {
        std::vector<std::array<float, 32>> results(threads, {1.5f});
        std::vector<double> counts(threads);
        detail::parallel_for(threads, [&](std::int64_t i) {
            counts[i] = HWY_DYNAMIC_DISPATCH(multiply_add)(kRepetitions, results[i].data());
        });
        for (const double count : counts) operations += count;
        benchmark::DoNotOptimize(results);
    }
    state.counters["FLOP/s"] = benchmark::Counter(operations, benchmark::Counter::kIsRate);
}

void machine_read(benchmark::State& state) {
    const Threads limit(static_cast<int>(state.range(0)));
    const std::vector<float> values(kFloatCount, 1.0f);
    for (auto _ : state) {
        std::array<float, kFloatCount / kPiece> sums{};
        detail::parallel_for(std::ssize(sums), [&](std::int64_t i) {
            sums[i] = HWY_DYNAMIC_DISPATCH(sum)(values.data() + kPiece * i, kPiece);
        });
        benchmark::DoNotOptimize(sums);
    }
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(kFloatCount * 4));
}

// Bytes read and bytes written both count.
void machine_copy(benchmark::State& state) {
    const Threads limit(static_cast<int>(state.range(0)));
    const std::vector<float> from(kFloatCount, 1.0f);
    std::vector<float> to(kFloatCount);
    for (auto _ : state) {
        detail::parallel_for(kFloatCount / kPiece, [&](std::int64_t i) {
            std::memcpy(to.data() + kPiece * i, from.data() + kPiece * i, kPiece * sizeof(float));
        });
        benchmark::ClobberMemory();
    }
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(2 * kFloatCount * 4));
}

void on_threads(benchmark::internal::Benchmark* b) {
    b->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK(machine_multiply_add)->Apply(on_threads);
BENCHMARK(machine_read)->Apply(on_threads);
BENCHMARK(machine_copy)->Apply(on_threads);

}  // namespace
}  // namespace mirrorball
#endif
