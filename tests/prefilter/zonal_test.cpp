// Lobes in bands against closed forms, long double sums and Parseval.
#include <mirrorball/zonal.h>

#include <cmath>

#include <gtest/gtest.h>
#include <mirrorball/vector.h>

#include "prefilter/lobe_kernel.h"

namespace mirrorball {
namespace {

const char* const kSmooth[] = {
    "ggx:0.02",    "ggx:0.1",   "ggx:0.25",   "ggx:0.5",       "ggx:0.75",
    "ggx:1",       "phong:10",  "phong:1000", "blinn-phong:4", "blinn-phong:4000",
    "charlie:0.2", "charlie:1", "diffuse",    "phong:2.5"};

// Steps, a plateau, and weight beyond the hemisphere.
Lobe stepped_table() {
    return tabulated_lobe("steps", {0.2, 0.3, 0.3001, 1.0, 1.7, 2.0}, {3, 2, 0.5, 1, 1, 0.25});
}

// P_l(1 - x) in long double, by differences.
struct LongLegendre {
    long double x, p = 1, difference = 0;
    int l = 0;

    void advance() {
        difference = (l * difference - (2 * l + 1) * x * p) / (l + 1);
        p += difference;
        ++l;
    }
};

// By Simpson's rule in a variable that crowds its points at both ends of [from, to].
std::vector<double> by_simpson(const Lobe& lobe, const std::vector<int>& bands, double from,
                               double to) {
    constexpr int count = 8000;
    const detail::LobeKernel kernel(lobe);
    std::vector<long double> sums(bands.size(), 0);
    for (int i = 0; i <= count; ++i) {
        const long double u = static_cast<long double>(i) / count;
        const long double angle = from + (to - from) * u * u * u * (u * (u * 6 - 15) + 10);
        const long double step = (to - from) * 30 * u * u * (u - 1) * (u - 1);
        const long double sine = std::sin(angle / 2);
        const long double weight = (i % count == 0 ? 1
                                    : i % 2 == 1   ? 4
                                                   : 2) /
                                   (3.0L * count) * step * 2 * kPi * std::sin(angle) *
                                   kernel.at(static_cast<double>(sine * sine));
        LongLegendre polynomial{2 * sine * sine};
        for (std::size_t j = 0; j < bands.size(); ++j) {
            while (polynomial.l < bands[j]) polynomial.advance();
            sums[j] += weight * polynomial.p;
        }
    }
    return {sums.begin(), sums.end()};
}

TEST(Zonal, AgreesWithSimpsonsRule) {
    const std::vector<int> bands = {0, 1, 2, 7, 30, 100, 250, 399};
    for (const char* text : kSmooth) {
        const Lobe lobe = parse_lobe(text);
        const auto lambda = zonal_coefficients(lobe, 400);
        const auto expected = by_simpson(lobe, bands, 0, kPi / 2);
        for (std::size_t j = 0; j < bands.size(); ++j)
            EXPECT_NEAR(lambda[bands[j]], expected[j], 2e-12) << text << " " << bands[j];
    }
}

TEST(Zonal, TablesAgreeLineByLine) {
    const std::vector<int> bands = {0, 1, 2, 31, 150, 399};
    const Lobe lobe = stepped_table();
    const auto lambda = zonal_coefficients(lobe, 400);
    std::vector<double> expected(bands.size(), 0.0);
    const double edges[] = {0, 0.2, 0.3, 0.3001, 1.0, 1.7, 2.0};
    for (int i = 0; i < 6; ++i) {
        const auto part = by_simpson(lobe, bands, edges[i], edges[i + 1]);
        for (std::size_t j = 0; j < bands.size(); ++j) expected[j] += part[j];
    }
    for (std::size_t j = 0; j < bands.size(); ++j)
        EXPECT_NEAR(lambda[bands[j]], expected[j], 2e-12) << bands[j];
}

TEST(Zonal, ClosedForms) {
    const auto diffuse = zonal_coefficients(parse_lobe("diffuse"), 6);
    const double expected[] = {kPi, 2 * kPi / 3, kPi / 4, 0, -kPi / 24, 0};
    for (int l = 0; l < 6; ++l) EXPECT_NEAR(diffuse[l], expected[l], 1e-15) << l;
    // blinn-phong:0 and ggx:1 are a cosine by quadrature; phong:1 by its recurrence
    for (const char* text : {"phong:1", "blinn-phong:0", "ggx:1"}) {
        const auto cosine = zonal_coefficients(parse_lobe(text), 1024);
        const auto closed = zonal_coefficients(parse_lobe("diffuse"), 1024);
        for (int l = 0; l < 1024; ++l)
            ASSERT_NEAR(cosine[l], closed[l] / kPi, 1e-14) << text << " " << l;
    }
    // next to a Gaussian: far below what the quadrature could see, the recurrence keeps its digits
    const auto phong = zonal_coefficients(parse_lobe("phong:1000000"), 4096);
    EXPECT_NEAR(std::log(phong[4000]) / (-4000.0 * 4001 / 2e6), 1, 1e-3);
    // phong:4 is a polynomial on the hemisphere: no even band above its degree
    const auto polynomial = zonal_coefficients(parse_lobe("phong:4"), 64);
    for (int l = 6; l < 64; l += 2) EXPECT_EQ(polynomial[l], 0) << l;
}

TEST(Zonal, BandZeroIsTheIntegral) {
    for (const char* text : kSmooth) {
        const Lobe lobe = parse_lobe(text);
        for (const int count : {1, 2, 33, 4096})
            EXPECT_NEAR(zonal_coefficients(lobe, count)[0], lobe.integral(), 1e-13) << text;
    }
    EXPECT_NEAR(zonal_coefficients(stepped_table(), 4096)[0], 1, 1e-13);
}

// The bands of a lobe that they carry wholly put it together again (the addition theorem), and hold
// its square.
TEST(Zonal, BandsAddUpToTheLobe) {
    for (const char* text : {"ggx:0.2", "phong:100", "blinn-phong:1000"}) {
        const Lobe lobe = parse_lobe(text);
        const auto lambda = zonal_coefficients(lobe, 900);
        for (const double angle : {0.0, 0.01, 0.3, 1.2, 2.9}) {
            LongLegendre polynomial{2 * std::pow(std::sin(angle / 2.0L), 2)};
            long double sum = 0;
            for (int l = 0; l < 900; ++l, polynomial.advance())
                sum += (2 * l + 1) / (4 * kPi) * lambda[l] * polynomial.p;
            // what the crease at the horizon leaves beyond 900 bands, in ggx: 2e-9 measured
            EXPECT_NEAR(static_cast<double>(sum), lobe.value(std::cos(angle)), 1e-8 * lobe.value(1))
                << text << " " << angle;
        }
    }
    // of phong:N the square integrates to 2 pi ((N+1) / 2 pi)^2 / (2N+1)
    const auto lambda = zonal_coefficients(parse_lobe("phong:50"), 200);
    double sum = 0;
    for (int l = 0; l < 200; ++l) sum += (2 * l + 1) / (4 * kPi) * lambda[l] * lambda[l];
    EXPECT_NEAR(sum, 51 * 51 / (2 * kPi) / 101, 1e-12);
}

struct Case {
    const char* lobe;
    double cap;  // of bands, beyond which a crease is not carried
};

// Against sums over all that 4096 bands and Parseval know of it.
TEST(BandCount, IsTheLeastThatKeepsThePromise) {
    const Case cases[] = {
        {"ggx:0.06", 128},        {"ggx:0.1", 128},       {"ggx:0.125", 128},
        {"ggx:0.2", 128},         {"ggx:0.25", 128},      {"ggx:0.375", 128},
        {"ggx:0.5", 128},         {"ggx:0.625", 128},     {"ggx:0.75", 128},
        {"ggx:1", 128},           {"phong:0", 128},       {"phong:1", 128},
        {"phong:2.5", 128},       {"phong:10", 128},      {"phong:100", 128},
        {"phong:1000", 128},      {"phong:100000", 128},  {"blinn-phong:0", 128},
        {"diffuse", 128},         {"blinn-phong:4", 128}, {"blinn-phong:40", 128},
        {"blinn-phong:400", 128}, {"charlie:0.1", 1200},  {"charlie:0.2", 300},
        {"charlie:0.5", 128},     {"charlie:1", 128},
    };
    for (const auto& [text, cap] : cases) {
        const Lobe lobe = parse_lobe(text);
        const auto lambda = zonal_coefficients(lobe, 4096);
        std::vector<double> beyond(4097, 0.0);  // what creases leave beyond is nothing to the cap
        for (int l = 4095; l >= 0; --l)
            beyond[l] = beyond[l + 1] + (2 * l + 1) * lambda[l] * lambda[l];
        for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
            int exact = 4096;
            while (exact > 1 && beyond[exact - 1] <= tolerance * tolerance * beyond[0]) --exact;
            const int count = band_count(lobe, tolerance);
            if (exact >= cap && count == cap) continue;
            EXPECT_NEAR(count, exact, std::max(2.0, 0.03 * exact)) << text << " " << tolerance;
        }
    }
}

TEST(BandCount, SaysWhenHarmonicsDoNotCarryALobe) {
    EXPECT_GT(band_count(parse_lobe("ggx:0.01"), 1e-4), kLargestBandCount);
    EXPECT_GT(band_count(parse_lobe("phong:1e7"), 1e-4), kLargestBandCount);
    EXPECT_GT(band_count(parse_lobe("ggx:0.0001"), 1e-6), 100000000);
    EXPECT_GT(band_count(parse_lobe("phong:1e16"), 1e-6), 100000000);
    EXPECT_EQ(band_count(stepped_table(), 1e-4), 512);
    EXPECT_GE(band_count(parse_lobe("diffuse"), 0.9), 1);
}

TEST(Window, FallsFromOneTowardNothing) {
    for (const Window window : {Window::hanning, Window::lanczos}) {
        const auto factors = window_coefficients(window, 8);
        ASSERT_EQ(factors.size(), 8u);
        EXPECT_EQ(factors[0], 1);
        for (int l = 1; l < 8; ++l) EXPECT_LT(factors[l], factors[l - 1]);
        EXPECT_GT(factors[7], 0);
    }
    EXPECT_NEAR(window_coefficients(Window::hanning, 8)[4], 0.5, 1e-15);
    EXPECT_NEAR(window_coefficients(Window::lanczos, 8)[4], 2 / kPi, 1e-15);
    EXPECT_EQ(window_coefficients(Window::none, 3), std::vector<double>(3, 1.0));
}

}  // namespace
}  // namespace mirrorball
