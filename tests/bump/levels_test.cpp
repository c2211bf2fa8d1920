// Moments by level against sums over the texels under each, and the roughness that follows.
#include <gtest/gtest.h>

#include <cmath>

#include <mirrorball/bump.h>

#include "../../src/environments/noise.h"

namespace mirrorball {
namespace {

SlopeMap random_slopes(int width, int height) {
    SlopeMap map{Image(width, height, 2)};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 2; ++c)
                map.slopes.at(x, y)[c] =
                    static_cast<float>(detail::lattice_number(x, y, 1 + c) - 0.3 * c);
    return map;
}

// The mean of f(du, dv) over the area of texel (x, y) of a level, by overlap with each texel.
template <class F>
double brute_force(const SlopeMap& map, int columns, int rows, int x, int y, const F& f) {
    const auto overlap = [](int i, int count, int source, int j) {
        const double low = static_cast<double>(i) / count, high = (i + 1.0) / count;
        return std::max(0.0, std::min(high, (j + 1.0) / source) -
                                 std::max(low, static_cast<double>(j) / source)) *
               count;
    };
    double sum = 0;
    for (int j = 0; j < map.slopes.height(); ++j)
        for (int i = 0; i < map.slopes.width(); ++i)
            sum += overlap(x, columns, map.slopes.width(), i) *
                   overlap(y, rows, map.slopes.height(), j) *
                   f(double{map.slopes.at(i, j)[0]}, double{map.slopes.at(i, j)[1]});
    return sum;
}

TEST(BumpLevels, AreMeansOverTheAreaUnderEachTexel) {
    for (const auto& [width, height] :
         {std::pair{16, 16}, {13, 7}, {12, 10}, {1, 9}, {6, 1}, {1, 1}}) {
        const SlopeMap map = random_slopes(width, height);
        const std::vector<BumpLevel> levels = bump_levels(map);
        EXPECT_EQ(levels.back().mean.texel_count(), 1);
        for (const BumpLevel& level : levels) {
            const int columns = level.mean.width(), rows = level.mean.height();
            for (int y = 0; y < rows; ++y)
                for (int x = 0; x < columns; ++x) {
                    const auto mean = [&](auto f) {
                        return brute_force(map, columns, rows, x, y, f);
                    };
                    // Floats below 1, rounded once a level: at most 4 levels here.
                    constexpr double kRounding = 4 * 6e-8;
                    const double du = mean([](double u, double) { return u; });
                    const double dv = mean([](double, double v) { return v; });
                    const double uu = mean([](double u, double) { return u * u; });
                    const double vv = mean([](double, double v) { return v * v; });
                    const double uv = mean([](double u, double v) { return u * v; });
                    EXPECT_NEAR(level.mean.at(x, y)[0], du, kRounding) << width << "x" << height;
                    EXPECT_NEAR(level.mean.at(x, y)[1], dv, kRounding);
                    EXPECT_NEAR(level.second.at(x, y)[0], uu, kRounding);
                    EXPECT_NEAR(level.second.at(x, y)[1], vv, kRounding);
                    EXPECT_NEAR(level.second.at(x, y)[2], uv, kRounding);
                    EXPECT_NEAR(level.normal.rgb(x, y).x,
                                mean([](double u, double v) { return -u / std::hypot(u, v, 1); }),
                                kRounding);
                    const SlopeCovariance c = covariance(level, x, y);
                    EXPECT_NEAR(c.du, uu - du * du, 1e-6);
                    EXPECT_NEAR(c.dv, vv - dv * dv, 1e-6);
                    EXPECT_NEAR(c.both, uv - du * dv, 1e-6);
                }
        }
    }
}

TEST(BumpLevels, ConstantMapsHaveNoVarianceAtAll) {
    for (const float slope : {0.0f, 0.1f, -3.7f, 1e-4f, 77.7f}) {
        SlopeMap map{Image(13, 10, 2)};
        for (int y = 0; y < 10; ++y)
            for (int x = 0; x < 13; ++x) {
                map.slopes.at(x, y)[0] = slope;
                map.slopes.at(x, y)[1] = -0.3f * slope;
            }
        for (const BumpLevel& level : bump_levels(map))
            for (int y = 0; y < level.mean.height(); ++y)
                for (int x = 0; x < level.mean.width(); ++x) {
                    const SlopeCovariance c = covariance(level, x, y);
                    EXPECT_EQ(c.du, 0);
                    EXPECT_EQ(c.dv, 0);
                    EXPECT_EQ(c.both, 0);
                }
    }
}

// Corrugated at 30 degrees: all of the variance along one direction, none across.
TEST(BumpLevels, PrincipalDirectionsAreThoseOfTheRelief) {
    const double angle = kPi / 6;
    SlopeMap map{Image(64, 64, 2)};
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const double slope = 0.2 * std::sin(2 * kPi * (3 * x + 5 * y) / 64.0);
            map.slopes.at(x, y)[0] = static_cast<float>(slope * std::cos(angle));
            map.slopes.at(x, y)[1] = static_cast<float>(slope * std::sin(angle));
        }
    const BumpLevel top = bump_levels(map).back();
    const SlopeCovariance::Principal principal = covariance(top, 0, 0).principal();
    EXPECT_NEAR(principal.largest, 0.02, 1e-7);  // 0.2^2 / 2
    EXPECT_NEAR(principal.smallest, 0, 1e-8);
    EXPECT_NEAR(principal.angle, angle, 1e-5);
    EXPECT_EQ((SlopeCovariance{0.1, 0.1, 0}.principal().angle), 0);
}

TEST(BumpRoughness, GrowsFromBothMeasures) {
    EXPECT_DOUBLE_EQ(alpha_with_variance(0.3, 0), 0.3);
    EXPECT_DOUBLE_EQ(alpha_with_variance(0, 0.02), 0.2);
    EXPECT_DOUBLE_EQ(alpha_with_variance(0.3, 0.08), 0.5);
    EXPECT_DOUBLE_EQ(alpha_with_variance(0.9, 5), 1);
    for (const double alpha : {0.0, 0.1, 0.5, 1.0}) {
        EXPECT_DOUBLE_EQ(alpha_with_mean_length(alpha, 1), alpha);
        EXPECT_DOUBLE_EQ(alpha_with_mean_length(alpha, 0), 1);
    }
    // Toksvig's own words: an exponent of 98 and a length of 0.9 make 98 f, f = 0.9/(0.9 + 9.8).
    const double alpha = std::sqrt(2.0 / 100), exponent = 98 * 0.9 / 10.7;
    EXPECT_NEAR(alpha_with_mean_length(alpha, 0.9), std::sqrt(2 / (exponent + 2)), 1e-12);
}

// Small slopes: a mean normal is shorter by half the sum of the two variances, and Toksvig's
// measure, which takes (1 - length) / length for the variance, agrees with the moments.
TEST(BumpRoughness, BothMeasuresAgreeOnGentleSlopes) {
    SlopeMap map = random_slopes(64, 64);
    for (float& slope : map.slopes.values()) slope = 0.02f * (slope - 0.5f);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) map.slopes.at(x, y)[1] += 0.006f;
    const BumpLevel top = bump_levels(map).back();
    const double variance = covariance(top, 0, 0).mean();
    EXPECT_NEAR(variance, 0.02 * 0.02 / 12, 2e-6);  // uniform; of 4096 numbers
    // The length is 1 - 3e-5 in floats, whose rounding is 6e-8: 0.2% of alpha^2, 0.4% granted.
    EXPECT_NEAR(alpha_with_mean_length(0, Vec3d(top.normal.rgb(0, 0)).length()) /
                    alpha_with_variance(0, variance),
                1, 4e-3);
}

}  // namespace
}  // namespace mirrorball
