// Samplers against their densities, and densities against the BRDF.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <mirrorball/brdf_properties.h>

#include "brdf/brdf_support.h"

namespace mirrorball {
namespace {

std::vector<std::string> all_models() {
    std::vector<std::string> models(std::begin(kReciprocalModels), std::end(kReciprocalModels));
    models.emplace_back(kLewis);
    return models;
}

constexpr int kBandCount = 16, kSectorCount = 24, kBinCount = kBandCount * kSectorCount;

int bin_of(const Vec3d& w) {
    const int band = std::clamp(int((w.z + 1) / 2 * kBandCount), 0, kBandCount - 1);
    const double turn = std::atan2(w.y, w.x) / (2 * kPi);
    const int sector =
        std::clamp(int((turn < 0 ? turn + 1 : turn) * kSectorCount), 0, kSectorCount - 1);
    return band * kSectorCount + sector;
}

// The share of the samples that each bin should get: bins of equal solid angle on the whole sphere.
std::vector<double> expected_shares(const Brdf& brdf, const Vec3d& wo) {
    std::vector<double> shares;
    for (int band = 0; band < kBandCount; ++band) {
        for (int sector = 0; sector < kSectorCount; ++sector)
            shares.push_back(integrate_patch(
                [&](const Vec3d& wi) { return brdf.density(wi, wo); }, 2.0 * band / kBandCount - 1,
                2.0 * (band + 1) / kBandCount - 1, 2 * kPi * sector / kSectorCount,
                2 * kPi * (sector + 1) / kSectorCount, 1e-6));
    }
    return shares;
}

// Pearson's statistic as a normal deviate (Wilson and Hilferty 1931). Bins are pooled, in order,
// until five samples are expected in each.
double chi_square_deviate(const std::vector<double>& expected, const std::vector<int>& found) {
    double statistic = 0, pooled_expected = 0, pooled_found = 0;
    int bin_count = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        pooled_expected += expected[i];
        pooled_found += found[i];
        if (pooled_expected < 5 && i + 1 < expected.size()) continue;
        const double difference = pooled_found - pooled_expected;
        if (pooled_expected > 0) statistic += difference * difference / pooled_expected;
        ++bin_count;
        pooled_expected = pooled_found = 0;
    }
    const double freedom = std::max(1, bin_count - 1), spread = 2 / (9 * freedom);
    return (std::cbrt(statistic / freedom) - (1 - spread)) / std::sqrt(spread);
}

// 20000 samples from a fixed seed, 384 bins. Of about 90 cases one in a hundred such suites would
// fail by chance at 3.7 standard deviations (a significance of 1e-4 each); the seed is one that
// does not.
TEST(BrdfSampling, FollowsItsDensity) {
    constexpr int kSampleCount = 20000;
    for (const std::string& text : all_models()) {
        const Brdf brdf = parse_brdf(text);
        for (const Vec3d& wo : kViews) {
            std::vector<double> expected = expected_shares(brdf, wo);
            double integral = 0;
            for (const double share : expected) integral += share;
            // what is missing are the choices of a mirror
            const bool has_mirror = brdf.mirror_reflectance(wo).x > 0;
            if (has_mirror)
                EXPECT_LT(integral, 0.95) << text;
            else
                EXPECT_NEAR(integral, 1, 1e-3) << text << " " << wo;  // by the quadrature

            Numbers numbers;
            std::vector<int> found(kBinCount);
            int mirror_count = 0;
            for (int i = 0; i < kSampleCount; ++i) {
                const Brdf::Sample sample = brdf.sample(wo, numbers.next3());
                EXPECT_NEAR(sample.direction.length(), 1, 1e-12);
                if (sample.is_delta)
                    ++mirror_count;
                else
                    ++found[bin_of(sample.direction)];
            }
            for (double& share : expected) share *= kSampleCount;
            if (has_mirror) {
                expected.push_back(kSampleCount * (1 - integral));
                found.push_back(mirror_count);
            }
            EXPECT_LT(chi_square_deviate(expected, found), 3.7) << text << " " << wo;
        }
    }
}

TEST(BrdfSampling, ChiSquareNoticesAWrongDensity) {
    // normals of roughness 0.5 are not those of 0.52
    const Brdf drawn = parse_brdf("ggx:0.5"), claimed = parse_brdf("ggx:0.52");
    std::vector<double> expected = expected_shares(claimed, kViews[1]);
    Numbers numbers;
    std::vector<int> found(kBinCount);
    for (int i = 0; i < 20000; ++i)
        ++found[bin_of(drawn.sample(kViews[1], numbers.next3()).direction)];
    for (double& share : expected) share *= 20000;
    EXPECT_GT(chi_square_deviate(expected, found), 5);
}

// The mean weight is the integral of f wi.z, which a quadrature finds without the sampler.
TEST(BrdfSampling, MeanWeightIsTheIntegral) {
    for (const std::string& text : all_models()) {
        const Brdf brdf = parse_brdf(text);
        for (const Vec3d& wo : kViews) {
            const double truth = integrate_hemisphere([&](const Vec3d& wi) {
                                     return brdf.evaluate(wi, wo).x * wi.z;
                                 }) +
                                 brdf.mirror_reflectance(wo).x;
            const Integral mean = furnace_radiance(brdf, wo, 1 << 15);
            EXPECT_NEAR(mean.value.x, truth, 4 * mean.error + 1e-4) << text << " " << wo;
            EXPECT_LT(mean.error, 3e-3) << text << " " << wo;
        }
    }
}

TEST(BrdfSampling, WeightIsFTimesCosineOverDensity) {
    for (const std::string& text : all_models()) {
        const Brdf brdf = parse_brdf(text);
        Numbers numbers;
        for (int i = 0; i < 100; ++i) {
            const Brdf::Sample sample = brdf.sample(kViews[1], numbers.next3());
            const Vec3d& wi = sample.direction;
            if (sample.is_delta) continue;
            const double density = brdf.density(wi, kViews[1]);
            const Vec3d expected = brdf.evaluate(wi, kViews[1]) * std::max(0.0, wi.z);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(sample.weight[c] * density, expected[c], 1e-12 * (1 + expected[c]))
                    << text;
        }
    }
}

}  // namespace
}  // namespace mirrorball
