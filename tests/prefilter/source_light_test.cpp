// What prefiltering learns of a source, against plain loops in double.
#include "prefilter/source_light.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "synthetic.h"

namespace mirrorball::detail {
namespace {

// Most texels about 1, a tenth up to 3000, one at 3e4; channels differ. 21 is no multiple of a
// stretch of texels, and the projection has unused ones.
EnvironmentMap source_with_lights() {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform;
    EnvironmentMap map = sampled(Projection::dual_paraboloid, 21, [&](const Vec3d&) {
        const double brightness = uniform(random) < 0.1 ? std::pow(3000, uniform(random)) : 1;
        return Vec3d(uniform(random), uniform(random), uniform(random)) * brightness;
    });
    map.levels[0].faces[1].set_rgb(10, 11, {3e4f, 1, 2e3f});
    return map;
}

struct Source {
    EnvironmentMap map = source_with_lights();
    std::vector<double> solid_angles = solid_angle_table(map.projection, 21, 21);
    SourceRange range = range_of(map, solid_angles);

    // Calls f(value, solid angle) for every channel of every used texel.
    template <class F>
    void for_each_value(const F& f) const {
        for (const Image& face : map.levels[0].faces) {
            for (int i = 0; i < 21 * 21; ++i)
                for (int c = 0; c < 3; ++c) f(face.values()[3 * i + c], solid_angles[i]);
        }
    }

    [[nodiscard]] double deviation_below(double limit, double over) const {
        double first = 0, second = 0, area = 0;
        for_each_value([&](double v, double solid_angle) {
            first += solid_angle * std::min(v, limit);
            second += solid_angle * std::pow(std::min(v, limit), 2);
            area += solid_angle;
        });
        return std::sqrt(second / area - std::pow(first / area, 2)) / over;
    }
};

constexpr float kMean = 20;

TEST(SourceLight, RangeIsThatOfUsedTexels) {
    const Source source;
    EXPECT_EQ(source.range.highest.x, 3e4f);
    EXPECT_GT(source.range.lowest.x, 0);  // unused texels are 0
    ASSERT_EQ(source.range.rows.size(), 42u);
    EXPECT_EQ(source.range.rows[21 + 11], 3e4f);
}

TEST(SourceLight, LightsAreWhatIsAboveTheThreshold) {
    const Source source;
    LightLevels levels(source.map, source.solid_angles, source.range, kMean);
    // from the last level down: those above the usual one are made from that one's
    for (std::size_t level = LightLevels::kThresholds.size(); level-- > 0;) {
        const double threshold = LightLevels::kThresholds[level] * kMean;
        double above = 0;
        source.for_each_value([&](double v, double solid_angle) {
            above += solid_angle * std::max(v - threshold, 0.0);
        });
        std::size_t count = 0;
        for (const Image& face : source.map.levels[0].faces) {
            for (int i = 0; i < 21 * 21; ++i) {
                const float* const v = face.values().data() + 3 * i;
                count += source.solid_angles[i] > 0 && std::max({v[0], v[1], v[2]}) > threshold;
            }
        }
        EXPECT_EQ(levels.any(level), count > 0);
        double power = 0;
        for (const Light& light : levels.lights(level)) {
            EXPECT_NEAR(light.direction.length(), 1, 1e-6);
            power += light.power.x + light.power.y + light.power.z;
        }
        EXPECT_EQ(levels.count(level), count) << threshold;
        EXPECT_NEAR(power, above, 1e-5 * above) << threshold;
    }
}

TEST(SourceLight, DeviationsAreThoseOfWhatLightsLeave) {
    const Source source;
    LightLevels levels(source.map, source.solid_angles, source.range, kMean);
    EXPECT_NEAR(levels.deviation(), source.deviation_below(1e9, kMean), 1e-5 * levels.deviation());
    for (std::size_t level = 1; level < LightLevels::kThresholds.size(); ++level) {
        const double expected =
            source.deviation_below(LightLevels::kThresholds[level] * kMean, kMean);
        EXPECT_NEAR(levels.rest(level), expected, 1e-5 * expected) << level;
    }
}

TEST(SourceLight, AllLightsHoldTheWholeFlux) {
    const Source source;
    Vec3d sum(0.0);
    double area = 0;
    for (const Light& light : all_lights(source.map, source.solid_angles))
        sum += Vec3d(light.power), area += light.solid_angle;
    const Vec3d expected = flux(source.map);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], expected[c], 1e-6 * expected[c]);
    EXPECT_NEAR(area, 4 * kPi, 1e-5);
}

}  // namespace
}  // namespace mirrorball::detail
