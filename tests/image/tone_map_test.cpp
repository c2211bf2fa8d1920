#include <mirrorball/tone_map.h>

#include <gtest/gtest.h>

#include <limits>

namespace mirrorball {
namespace {

TEST(ToneMap, KeepsGreyRisesAndStaysInRange) {
    EXPECT_NEAR(tone_mapped(0.18f, 1), 0.18f, 1e-6f);
    EXPECT_NEAR(tone_mapped(0.09f, 2), 0.18f, 1e-6f);
    EXPECT_EQ(tone_mapped(0.0f, 1), 0.0f);
    EXPECT_EQ(tone_mapped(-1.0f, 1), 0.0f);
    EXPECT_EQ(tone_mapped(std::numeric_limits<float>::infinity(), 1), 1.0f);
    float last = 0;
    for (float x = 1e-4f; x < 1e5f; x *= 1.1f) {
        const float y = tone_mapped(x, 1);
        EXPECT_GT(y, last) << x;
        EXPECT_LE(y, 1.0f);
        last = y;
    }
}

EnvironmentMap uniform(float radiance) {
    EnvironmentMap map = make_environment_map(Projection::cube, 8);
    for (Image& face : map.levels[0].faces) {
        for (float& value : face.values()) value = radiance;
    }
    return map;
}

// A bin of the histogram is a tenth of a stop, 7 %.
TEST(ToneMap, ExposureFollowsTheLight) {
    EXPECT_NEAR(usual_exposure(uniform(1)), 0.8, 0.04);
    EXPECT_NEAR(usual_exposure(uniform(1000)), 0.8e-3, 0.04e-3);
    EnvironmentMap lamp = uniform(1);
    lamp.levels[0].faces[0].set_rgb(4, 4, {1e6f, 1e6f, 1e6f});
    EXPECT_NEAR(usual_exposure(lamp), 0.8, 0.04) << "one small lamp does not darken the picture";
    EXPECT_GT(usual_exposure(uniform(0)), 0) << "no light at all is no division by zero";
}

}  // namespace
}  // namespace mirrorball
