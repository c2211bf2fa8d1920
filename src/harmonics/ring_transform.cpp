#include "harmonics/ring_transform.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstring>

#include <mirrorball/vector.h>

#include "core/flush_denormals.h"
#include "core/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "harmonics/ring_transform.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "harmonics/fourier-inl.h"
#include "harmonics/legendre-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mirrorball::detail {
namespace HWY_NAMESPACE {

std::size_t lane_count() {
    return hn::Lanes(Lanes());
}

// Seeds ------------------------------------------------------------------------------------------

// A function of high order is nothing near the poles: below this it is not summed. The largest
// values are of the order of 1.
constexpr double kNegligible = 1e-12;
// First values can lie below the least double; such lanes carry a power of this.
constexpr double kLogScale = 512 * 0.693147180559945309;

// Runs the recurrence of one order on one group until its values matter (or `first`, if that is
// later); returns the step, and p_n and p_{n-1} there.
int find_seeds(const LegendreTable& table, int order, int step_count, int first, const double* x,
               double* seeds) {
    const hn::CappedTag<double, 16> d;
    const std::size_t n = lane_count(), vector_size = hn::Lanes(d);
    HWY_ALIGN double now[16], before[16], scale[16];
    for (std::size_t i = 0; i < n; ++i) {
        const double log_sine = std::log1p(-x[i] * x[i]) / 2;
        const double log_value = table.log_first(order) + (order > 0 ? order * log_sine : 0);
        scale[i] = std::max(0.0, std::ceil((-600 - log_value) / kLogScale));
        now[i] = std::exp(log_value + scale[i] * kLogScale);
        before[i] = 0;
    }
    const LegendreTable::Step* steps = table.steps(order);
    const LegendreTable::Scale* scales = table.scales(order);
    const auto up = hn::Set(d, 0x1p256), down = hn::Set(d, 0x1p-512), one = hn::Set(d, 1.0);
    int step = 0;
    for (; step < step_count; ++step) {
        const auto limit = hn::Set(d, kNegligible / static_cast<double>(scales[step].own));
        bool matters = false;
        for (std::size_t i = 0; i < n; i += vector_size) {
            const auto unscaled = hn::Eq(hn::Load(d, scale + i), hn::Zero(d));
            const auto large = hn::Ge(hn::Abs(hn::Load(d, now + i)), limit);
            matters = matters || !hn::AllFalse(d, hn::And(unscaled, large));
        }
        if (matters && step >= first && step % 2 == 0) break;
        const auto alpha = hn::Set(d, steps[step].alpha), beta = hn::Set(d, steps[step].beta);
        for (std::size_t i = 0; i < n; i += vector_size) {
            const auto v = hn::Load(d, x + i), p = hn::Load(d, now + i);
            auto next =
                hn::MulSub(hn::MulAdd(alpha, hn::Mul(v, v), beta), p, hn::Load(d, before + i));
            auto old = p, exponent = hn::Load(d, scale + i);
            const auto rescale = hn::And(hn::Gt(hn::Abs(next), up), hn::Gt(exponent, hn::Zero(d)));
            next = hn::IfThenElse(rescale, hn::Mul(next, down), next);
            old = hn::IfThenElse(rescale, hn::Mul(old, down), old);
            exponent = hn::IfThenElse(rescale, hn::Sub(exponent, one), exponent);
            hn::Store(next, d, now + i), hn::Store(old, d, before + i);
            hn::Store(exponent, d, scale + i);
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        seeds[i] = scale[i] > 0 ? 0 : now[i];
        seeds[n + i] = scale[i] > 0 ? 0 : before[i];
    }
    return step;
}

// Analysis ---------------------------------------------------------------------------------------

// Four texels of RGB from each of four rows, into four lanes of three planes.
HWY_INLINE void load_4_rows_4_texels(const float* const* rows, std::size_t offset, float* const* to,
                                     std::size_t step) {
    const hn::FixedTag<float, 4> d;
    const hn::FixedTag<double, 2> pairs;
    for (std::size_t part = 0; part < 3; ++part) {
        const auto a = hn::LoadU(d, rows[0] + offset + 4 * part);
        const auto b = hn::LoadU(d, rows[1] + offset + 4 * part);
        const auto c = hn::LoadU(d, rows[2] + offset + 4 * part);
        const auto e = hn::LoadU(d, rows[3] + offset + 4 * part);
        const auto ab0 = hn::BitCast(pairs, hn::InterleaveLower(d, a, b));
        const auto ce0 = hn::BitCast(pairs, hn::InterleaveLower(d, c, e));
        const auto ab1 = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b));
        const auto ce1 = hn::BitCast(pairs, hn::InterleaveUpper(d, c, e));
        const std::size_t i = 4 * part;  // of twelve values: texel i / 3, channel i % 3
        hn::Store(hn::BitCast(d, hn::InterleaveLower(pairs, ab0, ce0)), d,
                  to[i % 3] + i / 3 * step);
        hn::Store(hn::BitCast(d, hn::InterleaveUpper(pairs, ab0, ce0)), d,
                  to[(i + 1) % 3] + (i + 1) / 3 * step);
        hn::Store(hn::BitCast(d, hn::InterleaveLower(pairs, ab1, ce1)), d,
                  to[(i + 2) % 3] + (i + 2) / 3 * step);
        hn::Store(hn::BitCast(d, hn::InterleaveUpper(pairs, ab1, ce1)), d,
                  to[(i + 3) % 3] + (i + 3) / 3 * step);
    }
}

// `rows` are 2 n pointers: n northern rows, then their n southern mates.
void load_rows(const float* const* rows, std::size_t width, float* const* planes) {
    const std::size_t n = lane_count(), step = 2 * n;
    for (std::size_t lane = 0; lane < 2 * n; lane += 4) {
        float* const to[3] = {planes[0] + lane, planes[1] + lane, planes[2] + lane};
        std::size_t x = 0;
        for (; x + 4 <= width; x += 4) {
            float* const here[3] = {to[0] + x * step, to[1] + x * step, to[2] + x * step};
            load_4_rows_4_texels(rows + lane, 3 * x, here, step);
        }
        for (; x < width; ++x) {
            for (std::size_t i = 0; i < 4; ++i) {
                for (std::size_t c = 0; c < 3; ++c) to[c][x * step + i] = rows[lane + i][3 * x + c];
            }
        }
    }
}

// Transforms one channel of a group and unpacks north + i south into even and odd parts.
void to_spectra(const FourierPlan& plan, const Columns& columns, const float* weights,
                const double* x, int channel, int order_count, float* values, float* scratch,
                float* spectra) {
    const Lanes d;
    const std::size_t n = hn::Lanes(d), length = plan.length();
    const float* const z = transform(plan, values, scratch);
    HWY_ALIGN float cosines_of_rings[16];
    for (std::size_t i = 0; i < n; ++i) cosines_of_rings[i] = static_cast<float>(x[i]);
    const Vec even_weight = hn::Mul(hn::LoadU(d, weights), hn::Set(d, 0.5f));
    const Vec odd_weight = hn::Mul(even_weight, hn::Load(d, cosines_of_rings));
    const std::complex<double> step = std::polar(1.0, columns.first);
    std::complex<double> turn = 1;  // exp(i m first)
    for (int m = 0; m < order_count; ++m) {
        const std::size_t k = m % length, mate = (length - k) % length;
        const Complexes a = load(z, k), b = load(z, mate);
        // twice the transforms of the northern and southern rings
        const Complexes north{hn::Add(a.re, b.re), hn::Sub(a.im, b.im)};
        const Complexes south{hn::Add(a.im, b.im), hn::Sub(b.re, a.re)};
        const Complexes even = north + south, odd = north - south;
        // times exp(-i m first), of the conjugate where columns run the other way; the cosines are
        // the real part of that, the sines the imaginary part's opposite
        const Vec c = hn::Set(d, static_cast<float>(turn.real()));
        const Vec s = hn::Set(d, static_cast<float>(columns.direction * turn.imag()));
        turn *= step;
        const Vec sign = hn::Set(d, static_cast<float>(-columns.direction));
        const auto cosines = [&](const Complexes& v)
                                 HWY_ATTR { return hn::MulAdd(v.re, c, hn::Mul(v.im, s)); };
        const auto sines = [&](const Complexes& v) HWY_ATTR {
            return hn::Mul(sign, hn::MulSub(v.im, c, hn::Mul(v.re, s)));
        };
        const Vec parts[4] = {cosines(even), sines(even), cosines(odd), sines(odd)};
        float* const to = spectra + (static_cast<std::size_t>(m) * kParts + channel) * n;
        hn::Store(hn::Mul(parts[0], even_weight), d, to);
        hn::Store(hn::Mul(parts[1], even_weight), d, to + 3 * n);
        hn::Store(hn::Mul(parts[2], odd_weight), d, to + 6 * n);
        hn::Store(hn::Mul(parts[3], odd_weight), d, to + 9 * n);
    }
}

// Degrees in twos of two, so that a group's values are loaded once for four degrees.
void analyse_order(const LegendreOrder& order, const float* spectra, double* state,
                   float* functions, float* sums, float* coefficients) {
    const Lanes d;
    const std::size_t n = hn::Lanes(d);
    int first = order.group_count;
    for (int step = 0; step < order.step_count; step += 2) {
        for (; first > 0 && order.starts[first - 1] <= step; --first) {
            const std::size_t at = static_cast<std::size_t>(first - 1) * 2 * n;
            std::memcpy(state + at, order.seeds + at, 2 * n * sizeof(double));
        }
        // first the functions, then the sums: both at once do not fit the registers
        for (int group = first; group < order.group_count; ++group) {
            double* const saved = state + static_cast<std::size_t>(group) * 2 * n;
            Recurrence p(order.x + static_cast<std::size_t>(group) * n, saved);
            float* const to = functions + static_cast<std::size_t>(group) * 2 * n;
            hn::Store(p.value(), d, to);
            p.advance(order.steps[step]);
            hn::Store(p.value(), d, to + n);
            p.advance(order.steps[step + 1]);
            p.save(saved);
        }
        Vec sum[2][kParts];
        for (int i = 0; i < kParts; ++i) sum[0][i] = sum[1][i] = hn::Zero(d);
        for (int group = first; group < order.group_count; ++group) {
            const float* const p = functions + static_cast<std::size_t>(group) * 2 * n;
            const Vec p0 = hn::Load(d, p), p1 = hn::Load(d, p + n);
            const float* const values = spectra + order.group_stride * group;
            HWY_UNROLL(12)
            for (int i = 0; i < kParts; ++i) {
                const Vec value = hn::Load(d, values + i * n);
                sum[0][i] = hn::MulAdd(p0, value, sum[0][i]);
                sum[1][i] = hn::MulAdd(p1, value, sum[1][i]);
            }
        }
        float* const to = sums + static_cast<std::size_t>(step) * kParts;
        for (int i = 0; i < 2 * kParts; i += 4)
            store_sums_of_4(sum[i / kParts] + i % kParts, to + i);
    }
    for (int step = 0; step < order.step_count; ++step) {
        const LegendreTable::Scale& scale = order.scales[step];
        const float before = step > 0 ? order.scales[step - 1].next : 0;
        const float* const now = sums + static_cast<std::size_t>(step) * kParts;
        const float* const last = step > 0 ? now - kParts : now;
        float* const even = coefficients + static_cast<std::size_t>(step) * kParts;
        for (int i = 0; i < 6; ++i) even[i] = scale.even * now[i] + before * last[i];
        if (2 * step + 1 < order.degree_count) {
            for (int i = 6; i < kParts; ++i) even[i] = scale.own * now[i];
        }
    }
}

// Synthesis --------------------------------------------------------------------------------------

// `weights` are the coefficients in terms of p_n: [step][even and odd][6].
void synthesise_order(const LegendreOrder& order, const float* weights, float* spectra) {
    const Lanes d;
    const std::size_t n = hn::Lanes(d);
    for (int group = 0; group < order.group_count; ++group) {
        const double* const x = order.x + static_cast<std::size_t>(group) * n;
        Recurrence p(x, order.seeds + static_cast<std::size_t>(group) * 2 * n);
        Vec sum[kParts];
        for (Vec& s : sum) s = hn::Zero(d);
        for (int step = order.starts[group]; step < order.step_count; ++step) {
            const Vec value = p.value();
            p.advance(order.steps[step]);
            const float* const w = weights + static_cast<std::size_t>(step) * kParts;
            HWY_UNROLL(12)
            for (int i = 0; i < kParts; ++i) sum[i] = hn::MulAdd(value, hn::Set(d, w[i]), sum[i]);
        }
        HWY_ALIGN float cosines[16];
        for (std::size_t i = 0; i < n; ++i) cosines[i] = static_cast<float>(x[i]);
        const Vec cosine = hn::Load(d, cosines);
        float* const to = spectra + order.group_stride * group;
        for (int i = 0; i < 6; ++i) {
            const Vec even = sum[i], odd = hn::Mul(sum[6 + i], cosine);
            hn::Store(hn::Add(even, odd), d, to + i * n);
            hn::Store(hn::Sub(even, odd), d, to + (6 + i) * n);
        }
    }
}

// Packs one channel of a group as north + i south at frequencies of both signs, and transforms.
// Returns where the result is. A forward transform of mirrored frequencies is an inverse one.
float* from_spectra(const FourierPlan& plan, const float* weights, int channel, int order_count,
                    const float* spectra, float* values, float* scratch) {
    const Lanes d;
    const std::size_t n = hn::Lanes(d), length = plan.length();
    std::memset(values, 0, length * 2 * n * sizeof(float));
    const Vec weight = weights != nullptr ? hn::LoadU(d, weights) : hn::Set(d, 1.0f);
    for (int m = 0; m < order_count; ++m) {
        const float* const from = spectra + (static_cast<std::size_t>(m) * kParts + channel) * n;
        const Vec north_cos = hn::Mul(hn::Load(d, from), weight);
        const Vec north_sin = hn::Mul(hn::Load(d, from + 3 * n), weight);
        const Vec south_cos = hn::Mul(hn::Load(d, from + 6 * n), weight);
        const Vec south_sin = hn::Mul(hn::Load(d, from + 9 * n), weight);
        if (m > 0) {
            store({hn::Add(north_cos, south_sin), hn::Sub(south_cos, north_sin)}, values,
                  length - m);
        }
        store({hn::Sub(north_cos, south_sin), hn::Add(south_cos, north_sin)}, values, m);
    }
    return transform(plan, values, scratch);
}

}  // namespace HWY_NAMESPACE
}  // namespace mirrorball::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mirrorball::detail {
namespace {

HWY_EXPORT(lane_count);
HWY_EXPORT(find_seeds);
HWY_EXPORT(load_rows);
HWY_EXPORT(to_spectra);
HWY_EXPORT(analyse_order);
HWY_EXPORT(synthesise_order);
HWY_EXPORT(from_spectra);

// Odd, so that the groups' rows of one order do not fall on the same lines of a cache.
std::size_t padded(int order_count) {
    return static_cast<std::size_t>(order_count) | 1;
}

}  // namespace

int ring_lane_count() {
    return static_cast<int>(HWY_DYNAMIC_DISPATCH(lane_count)());
}

RingTransform::RingTransform(std::shared_ptr<const LegendreTable> table, int band_count,
                             int ring_count, int column_count, std::shared_ptr<ScratchPool> scratch)
    : table_(std::move(table)),
      band_count_(band_count),
      ring_count_(ring_count),
      lane_count_(ring_lane_count()),
      group_count_(((ring_count + 1) / 2 + lane_count_ - 1) / lane_count_),
      fourier_(column_count),
      scratch_(std::move(scratch)) {
    make_seeds();
}

void RingTransform::make_seeds() {
    const std::size_t n = lane_count_, groups = group_count_;
    x_ = AlignedArray<double>(groups * n);
    const int pair_count = (ring_count_ + 1) / 2;
    for (std::size_t i = 0; i < x_.size(); ++i) {
        // lanes without a ring follow the last that has one
        const int pair = std::min(static_cast<int>(i), pair_count - 1);
        const bool on_equator = 2 * pair + 1 == ring_count_;
        x_[i] = on_equator ? 0 : std::cos((pair + 0.5) * kPi / ring_count_);
    }
    starts_.resize(static_cast<std::size_t>(band_count_) * groups);
    seeds_ = AlignedArray<double>(static_cast<std::size_t>(band_count_) * groups * 2 * n);
    parallel_for(band_count_, [&](std::int64_t order) {
        int start = 0;
        const int m = static_cast<int>(order);
        // From the equator out: a ring never matters sooner than one farther from the pole.
        for (std::size_t group = groups; group-- > 0;) {
            const std::size_t at = static_cast<std::size_t>(order) * groups + group;
            start = HWY_DYNAMIC_DISPATCH(find_seeds)(
                *table_, m, LegendreTable::step_count(m, band_count_), start, x_.data() + group * n,
                seeds_.data() + at * 2 * n);
            starts_[at] = start;
        }
    });
}

RingSpectra RingTransform::make_spectra() const {
    return RingSpectra(scratch_, padded(band_count_) * group_count_ * kParts * lane_count_);
}

GroupValues RingTransform::make_values() const {
    return GroupValues(scratch_, static_cast<std::size_t>(column_count()) * 2 * lane_count_);
}

void RingTransform::load_rows(int group, const float* rows,
                              std::array<GroupValues, 3>& planes) const {
    const std::size_t row_size = static_cast<std::size_t>(column_count()) * 3;
    const std::vector<float> dark(row_size);
    std::vector<const float*> pointers(2 * static_cast<std::size_t>(lane_count_), dark.data());
    for (int lane = 0; lane < lane_count_; ++lane) {
        const int north = group * lane_count_ + lane, south = ring_count_ - 1 - north;
        if (north <= south) pointers[lane] = rows + row_size * north;
        if (north < south) pointers[lane_count_ + lane] = rows + row_size * south;
    }
    float* const to[3] = {planes[0].data(), planes[1].data(), planes[2].data()};
    HWY_DYNAMIC_DISPATCH(load_rows)(pointers.data(), column_count(), to);
}

void RingTransform::to_spectra(int group, std::array<GroupValues, 3>& planes, GroupValues& scratch,
                               const Columns& columns, std::span<const float> ring_weights,
                               RingSpectra& spectra) const {
    const std::size_t first = static_cast<std::size_t>(group) * lane_count_;
    float* const to = spectra.data() + padded(band_count_) * kParts * lane_count_ * group;
    for (int channel = 0; channel < 3; ++channel) {
        HWY_DYNAMIC_DISPATCH(to_spectra)
        (fourier_, columns, ring_weights.data() + first, x_.data() + first, channel, band_count_,
         planes[channel].data(), scratch.data(), to);
    }
}

LegendreOrder RingTransform::legendre_order(int m, int band_count) const {
    const std::size_t groups = group_count_, at = groups * m;
    return {table_->steps(m),
            table_->scales(m),
            LegendreTable::step_count(m, band_count),
            band_count - m,
            group_count_,
            starts_.data() + at,
            seeds_.data() + at * 2 * lane_count_,
            x_.data(),
            padded(band_count_) * kParts * lane_count_};
}

void RingTransform::analyse(const RingSpectra& spectra, Harmonics& harmonics) const {
    parallel_for(band_count_, [&](std::int64_t i) {
        const FlushDenormals flush;
        const int m = static_cast<int>(i);
        const LegendreOrder order = legendre_order(m, band_count_);
        AlignedArray<double> state(static_cast<std::size_t>(group_count_) * 2 * lane_count_);
        ScratchArray functions(scratch_, static_cast<std::size_t>(group_count_) * 2 * lane_count_);
        // in steps of two, and each sum is stored with a vector's rest
        ScratchArray sums(scratch_, static_cast<std::size_t>(order.step_count + 1) * kParts + 16);
        const float* const from =
            spectra.data() + static_cast<std::size_t>(m) * kParts * lane_count_;
        HWY_DYNAMIC_DISPATCH(analyse_order)
        (order, from, state.data(), functions.data(), sums.data(), harmonics.order(m).data());
    });
}

void RingTransform::synthesise(const Harmonics& harmonics, std::span<const float> zonal,
                               RingSpectra& spectra) const {
    const int band_count = static_cast<int>(zonal.size());
    parallel_for(band_count, [&](std::int64_t i) {
        const FlushDenormals flush;
        const int m = static_cast<int>(i);
        const LegendreOrder order = legendre_order(m, band_count);
        const std::span<const float> coefficients = harmonics.order(m);
        // filtered, with two degrees of zeros at the end; each sign of m > 0 has half of the light
        const std::size_t steps = order.step_count;
        ScratchArray filtered(scratch_, (steps + 1) * kParts);
        ScratchArray weights(scratch_, steps * kParts);
        std::fill(filtered.end() - 2 * kParts, filtered.end(), 0.0f);
        for (std::size_t k = 0; k < static_cast<std::size_t>(order.degree_count); ++k) {
            const float share = m > 0 ? 0.5f * zonal[m + k] : zonal[m + k];
            for (std::size_t part = 0; part < 6; ++part)
                filtered.data()[6 * k + part] = share * coefficients[6 * k + part];
        }
        for (std::size_t n = 0; n < steps; ++n) {
            const LegendreTable::Scale& scale = order.scales[n];
            const float* const f = filtered.data() + n * kParts;
            float* const w = weights.data() + n * kParts;
            for (std::size_t part = 0; part < 6; ++part) {
                w[part] = scale.even * f[part] + scale.next * f[kParts + part];
                w[6 + part] = scale.own * f[6 + part];
            }
        }
        float* const to = spectra.data() + static_cast<std::size_t>(m) * kParts * lane_count_;
        HWY_DYNAMIC_DISPATCH(synthesise_order)(order, weights.data(), to);
    });
}

void RingTransform::from_spectra(int group, const RingSpectra& spectra, int order_count,
                                 std::span<const float> ring_weights,
                                 std::array<GroupValues, 3>& planes, GroupValues& scratch) const {
    const std::size_t first = static_cast<std::size_t>(group) * lane_count_;
    const float* const from = spectra.data() + padded(band_count_) * kParts * lane_count_ * group;
    const float* const weights = ring_weights.empty() ? nullptr : ring_weights.data() + first;
    for (int channel = 0; channel < 3; ++channel) {
        const float* const result = HWY_DYNAMIC_DISPATCH(from_spectra)(
            fourier_, weights, channel, order_count, from, planes[channel].data(), scratch.data());
        if (result == scratch.data()) std::swap(planes[channel], scratch);
    }
}

}  // namespace mirrorball::detail
#endif
