#include <mirrorball/environment_map.h>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <mirrorball/compare.h>
#include <mirrorball/error.h>

#include "synthetic.h"

namespace mirrorball {
namespace {

TEST(EnvironmentMap, FluxOfUniformLightIsFourPi) {
    for (std::size_t i = 0; i < kProjectionCount; ++i) {
        const EnvironmentMap map =
            sampled(static_cast<Projection>(i), 10, [](const Vec3d&) { return Vec3d(1, 2, 0); });
        const Vec3d f = flux(map);
        EXPECT_NEAR(f.x, 4 * kPi, 1e-9);
        EXPECT_NEAR(f.y, 8 * kPi, 1e-9);
        EXPECT_EQ(f.z, 0);
        EXPECT_NEAR(statistics(map).rms, std::sqrt(5.0 / 3), 1e-9);
    }
}

TEST(EnvironmentMap, StatisticsCountWhatIsOddAndIgnoreTheUnused) {
    EnvironmentMap map = sampled(Projection::sphere, 8, [](const Vec3d&) { return Vec3d(1); });
    const float nan = std::numeric_limits<float>::quiet_NaN();
    map.levels[0].faces[0].set_rgb(0, 0, {nan, -1, 7});  // a corner, outside the disc
    EXPECT_EQ(statistics(map).non_finite_count, 0);
    map.levels[0].faces[0].set_rgb(4, 4, {nan, 1, 1});
    map.levels[0].faces[0].set_rgb(3, 4, {1, -2, 5});
    const LevelStatistics s = statistics(map);
    EXPECT_EQ(s.non_finite_count, 1);
    EXPECT_EQ(s.negative_count, 1);
    EXPECT_EQ(s.minimum.y, -2);
    EXPECT_EQ(s.maximum.z, 5);
    EXPECT_EQ(s.texel_count, 60);  // 64 less the four corners, which the disc does not touch
}

TEST(EnvironmentMap, SeamRatioSeesASeam) {
    const auto rough = [](const Vec3d& d) {
        return Vec3d(2 + std::sin(5 * d.x + 3 * d.y + 2 * d.z));
    };
    EnvironmentMap cube = sampled(Projection::cube, 32, rough);
    EXPECT_NEAR(seam_ratio(cube), 1, 0.1);
    for (float& value : cube.levels[0].faces[2].values()) value *= 1.5f;
    EXPECT_GT(seam_ratio(cube), 2);
    EXPECT_EQ(seam_ratio(sampled(Projection::cube, 4, [](const Vec3d&) { return Vec3d(1); })), 1);
}

TEST(EnvironmentMap, SizesAreChecked) {
    EXPECT_THROW((void)make_environment_map(Projection::cube, 0), Error);
    EXPECT_THROW((void)make_environment_map(Projection::equirect, 1), Error);
    EXPECT_EQ(environment_map_bytes(Projection::cube, 16), 6u * 16 * 16 * 12);
    EXPECT_GT(environment_map_bytes(Projection::cube, std::int64_t{1} << 40),
              std::uint64_t{1} << 60);
}

// 1 % more of one channel over a quarter of the sphere, by hand.
TEST(Compare, FiguresAreTheDefinitions) {
    const EnvironmentMap b =
        sampled(Projection::equal_area_octahedral, 8, [](const Vec3d&) { return Vec3d(1, 2, 2); });
    EnvironmentMap a = b;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) a.levels[0].faces[0].set_rgb(x, y, {1.5f, 2, 2});
    const Difference d = compare(a, b);
    EXPECT_NEAR(d.relative_rmse, std::sqrt(0.25 * 0.25 / 9), 1e-9);
    EXPECT_NEAR(d.maximum, 0.5, 1e-9);
    EXPECT_NEAR(d.maximum_relative, 0.5, 1e-9);
    EXPECT_NEAR(d.flux_ratio.x, 1.125, 1e-9);
    EXPECT_EQ(d.flux_ratio.y, 1);
    EXPECT_EQ(compare(b, b).relative_rmse, 0);
}

TEST(Compare, MeetsMapsOfDifferentProjections) {
    const EnvironmentMap a = averaged(Projection::equirect, 256, smooth_light);
    const EnvironmentMap b = averaged(Projection::cube, 64, smooth_light);
    EXPECT_LT(compare(a, b).relative_rmse, 1e-3);
    EXPECT_LT(compare(b, a).relative_rmse, 1e-3);
}

}  // namespace
}  // namespace mirrorball
