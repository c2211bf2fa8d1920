// A lobe's far and near parts: together the lobe, the near part compact, the far part good alone.
#include "prefilter/band_split.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <mirrorball/vector.h>
#include <mirrorball/zonal.h>

#include "prefilter/legendre.h"
#include "prefilter/lobe_kernel.h"
#include "prefilter/zonal_quadrature.h"

namespace mirrorball::detail {
namespace {

constexpr int kMostBands = 1024;

// What a lobe's split is off by, at squared chords: the float ones that the near part reads.
struct Errors {
    double of_peak = 0;   // the largest error over the lobe's largest value
    double of_local = 0;  // over its value there, or a hundredth of its root mean square
};

// The root mean square over the sphere.
double rms(const Lobe& lobe) {
    return std::sqrt(ZonalQuadrature(lobe, 1).square() / (4 * kPi));
}

Errors errors(const Lobe& lobe, const BandSplit& split) {
    constexpr int count = 20000;
    std::vector<double> chords2, x, series;
    for (int i = 0; i < count; ++i) {
        const double u = (i + 0.37) / count, angle = kPi * u * u * u;
        chords2.push_back(static_cast<float>(4 * std::pow(std::sin(angle / 2), 2)));
        x.push_back(std::min(chords2.back(), 4 - chords2.back()) / 2);
    }
    for (std::size_t l = 0; l < split.far.size(); ++l)
        series.push_back((2 * static_cast<double>(l) + 1) / (4 * kPi) * split.far[l]);
    std::vector<double> front(x.size()), back(x.size());
    legendre_series(series, x, front, back);
    const LobeKernel kernel(lobe);
    const double least = 0.01 * rms(lobe);
    Errors errors;
    double peak = 0, worst = 0;
    for (int i = 0; i < count; ++i) {
        const double expected = kernel.at(chords2[i] / 4);
        const double sum = (chords2[i] <= 2 ? front[i] : back[i]) +
                           double{split.near(static_cast<float>(chords2[i]))};
        const double error = std::abs(sum - expected);
        peak = std::max(peak, expected);
        worst = std::max(worst, error);
        errors.of_local = std::max(errors.of_local, error / std::max(expected, least));
    }
    errors.of_peak = worst / peak;
    return errors;
}

// The share of the sphere where the near part is.
double share(const NearKernel& near) {
    double sum = 0;
    for (const NearPart& part : near.parts())
        sum += (double{part.farthest} * part.farthest - double{part.nearest} * part.nearest) / 4;
    return sum;
}

// 2e-4 of the local value is what may be left out; interpolation and float rounding may add as much
// again. Where a lobe narrower than 1024 bands falls to nothing beside its own peak, far and near
// cancel in float: 2e-3 measured at phong:1e6.
TEST(BandSplit, FarAndNearAddUpToTheLobe) {
    for (const char* text :
         {"ggx:0.01",      "ggx:0.05",        "ggx:0.1",     "ggx:0.125",  "ggx:0.25",
          "ggx:0.375",     "ggx:0.5",         "ggx:0.75",    "ggx:1",      "phong:1",
          "phong:2.5",     "phong:10",        "phong:100",   "phong:1000", "phong:100000",
          "blinn-phong:4", "blinn-phong:400", "charlie:0.5", "charlie:1",  "diffuse"}) {
        const Lobe lobe = parse_lobe(text);
        for (const double tolerance : {1e-3, 1e-4}) {
            const Errors found = errors(lobe, split_bands(lobe, tolerance, kMostBands));
            EXPECT_LT(found.of_local, 4e-4) << text << " " << tolerance;
            EXPECT_LT(found.of_peak, 2e-4) << text << " " << tolerance;
        }
    }
}

// The hardest: a step at the horizon, rings narrower than the bands' reach, and extreme exponents.
TEST(BandSplit, HoldsForExtremes) {
    for (const char* text : {"phong:0", "charlie:0.1", "charlie:0.2", "phong:1e6"}) {
        const Lobe lobe = parse_lobe(text);
        const Errors found = errors(lobe, split_bands(lobe, 1e-4, kMostBands));
        EXPECT_LT(found.of_local, 3e-3) << text;
        EXPECT_LT(found.of_peak, 2e-4) << text;
    }
    const Lobe steps =
        tabulated_lobe("steps", {0.2, 0.3, 0.3001, 1.0, 1.7, 2.0}, {3, 2, 0.5, 1, 1, 0.25});
    EXPECT_LT(errors(steps, split_bands(steps, 1e-4, kMostBands)).of_peak, 4e-4);
}

TEST(BandSplit, NearPartsAreCompact) {
    const auto near = [](const char* text) {
        return share(split_bands(parse_lobe(text), 1e-4, kMostBands).near);
    };
    // Gaussian lobes have none; glossy ones a trace at their peak; narrow ones what 1024 bands
    // leave; creased ones a ring at the horizon
    for (const char* text : {"phong:10", "phong:100", "phong:1000", "blinn-phong:400"})
        EXPECT_EQ(near(text), 0) << text;
    for (const char* text : {"ggx:0.1", "ggx:0.125", "ggx:0.2"})
        EXPECT_LT(near(text), 1e-4) << text;
    for (const char* text : {"ggx:0.01", "ggx:0.05", "phong:100000"})
        EXPECT_LT(near(text), 2e-3) << text;
    for (const char* text : {"diffuse", "ggx:1", "ggx:0.75"}) EXPECT_LT(near(text), 0.15) << text;
    for (const char* text : {"ggx:0.375", "ggx:0.5", "phong:2.5"})
        EXPECT_LT(near(text), 0.35) << text;
}

// `tail` is what far lacks, and keeps to the tolerance where no crease or cap is in the way.
TEST(BandSplit, FarAloneKeepsTheTolerance) {
    for (const char* text : {"ggx:0.1", "ggx:0.25", "ggx:0.5", "phong:50", "blinn-phong:1000"}) {
        const Lobe lobe = parse_lobe(text);
        for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
            const BandSplit split = split_bands(lobe, tolerance, kMostBands);
            const auto lambda = zonal_coefficients(lobe, 4096);
            double lost = 0, all = 0;
            for (std::size_t l = 0; l < lambda.size(); ++l) {
                const double far = l < split.far.size() ? split.far[l] : 0;
                lost += (2 * static_cast<double>(l) + 1) * std::pow(lambda[l] - far, 2);
                all += (2 * static_cast<double>(l) + 1) * lambda[l] * lambda[l];
            }
            // to the root of what double precision keeps of a sum of squares
            EXPECT_NEAR(split.tail, std::sqrt(lost / all), 0.02 * split.tail + 3e-8) << text;
            if (std::string(text) == "ggx:0.5" && tolerance < 1e-4) continue;  // its crease
            EXPECT_LE(split.tail, 1.03 * tolerance) << text << " " << tolerance;
        }
    }
}

TEST(BandSplit, AsksForAFewMoreBandsThanAHardCut) {
    for (const char* text : {"ggx:0.08", "ggx:0.1", "ggx:0.125"}) {
        const Lobe lobe = parse_lobe(text);
        EXPECT_LE(static_cast<double>(split_bands(lobe, 1e-4, 4096).far.size()),
                  1.21 * band_count(lobe, 1e-4) + 1)
            << text;
    }
    EXPECT_EQ(split_bands(parse_lobe("diffuse"), 1e-4, kMostBands).far.size(), 192u);
    EXPECT_EQ(split_bands(parse_lobe("diffuse"), 1e-4, 48).far.size(), 48u);
    EXPECT_LT(errors(parse_lobe("diffuse"), split_bands(parse_lobe("diffuse"), 1e-4, 48)).of_local,
              4e-4);
}

}  // namespace
}  // namespace mirrorball::detail
