#include <mirrorball/tone_map.h>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include <mirrorball/error.h>

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

// Curves

const std::vector<ToneMap> kToneMaps = {ToneMap::none, ToneMap::reinhard, ToneMap::aces,
                                        ToneMap::agx, ToneMap::film};
constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

TEST(ToneMap, NameAndParseAreInverse) {
    for (const ToneMap t : kToneMaps) EXPECT_EQ(parse_tone_map(name(t)), t);
    try {
        (void)parse_tone_map("filmic");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::usage);
        EXPECT_NE(std::string(error.what()).find("reinhard, aces, agx"), std::string::npos);
    }
}

TEST(ToneMap, EveryCurveRisesAndStaysInRange) {
    for (const ToneMap t : kToneMaps) {
        float last = 0;
        for (float x = 1e-3f; x < 1e5f; x *= 1.1f) {
            const float y = tone_mapped(Vec3f(x), 1, t).y;
            EXPECT_GE(y, last) << name(t) << " at " << x;
            EXPECT_LE(y, 1) << name(t) << " at " << x;
            last = y;
        }
        EXPECT_GT(last, 0.99f) << name(t);
    }
}

// The figures that tone_map.h states.
TEST(ToneMap, GreyCards) {
    const double expected[] = {0.18, 0.18 / 1.18, 0.1401, 0.18, 0.18};
    for (std::size_t i = 0; i < kToneMaps.size(); ++i) {
        const Vec3f y = tone_mapped(Vec3f(0.09f), 2, kToneMaps[i]);
        EXPECT_NEAR(y.x, expected[i], 1e-4) << name(kToneMaps[i]);
        // a grey stays grey, to the rounding of agx's matrices
        EXPECT_NEAR(y.x, y.y, 1e-6) << name(kToneMaps[i]);
        EXPECT_NEAR(y.x, y.z, 1e-6) << name(kToneMaps[i]);
    }
}

TEST(ToneMap, Extremes) {
    for (const ToneMap t : kToneMaps) {
        EXPECT_EQ(tone_mapped(Vec3f(kNoNumber), 1, t), Vec3f(0)) << name(t);
        EXPECT_EQ(tone_mapped(Vec3f(-kInfinite), 1, t), Vec3f(0)) << name(t);
        EXPECT_EQ(tone_mapped(Vec3f(-1), 1, t), Vec3f(0)) << name(t);
        EXPECT_EQ(tone_mapped(Vec3f(0), 1, t), Vec3f(0)) << name(t);
        EXPECT_EQ(tone_mapped(Vec3f(kInfinite), 0, t), Vec3f(0)) << name(t);
        EXPECT_EQ(tone_mapped(Vec3f(kInfinite), 1, t), Vec3f(1)) << name(t);
        EXPECT_EQ(tone_mapped(Vec3f(3e38f), 1e30, t), Vec3f(1)) << name(t);
    }
}

// A channel that is brighter stays so, and a colour's complement, were it to appear, would show as
// another order. Very bright ones fade to white only where the curve is made for it.
TEST(ToneMap, HuesKeepTheirOrder) {
    for (const ToneMap t : kToneMaps) {
        for (float x = 0.01f; x < 1e4f; x *= 1.7f) {
            const Vec3f orange = tone_mapped(Vec3f(x, 0.5f * x, 0.05f * x), 1, t);
            EXPECT_GE(orange.x, orange.y) << name(t) << " at " << x;
            EXPECT_GE(orange.y, orange.z) << name(t) << " at " << x;
        }
    }
    const Vec3f laser(0, 0, 100);
    EXPECT_EQ(tone_mapped(laser, 1, ToneMap::film).x, 0);
    const Vec3f pale = tone_mapped(laser, 1, ToneMap::agx);
    EXPECT_GT(pale.x, 0.3f) << "agx: the brightest blue is nearly white";
    EXPECT_GT(pale.z, pale.x);
}

TEST(ToneMap, ImagesOfAnyChannels) {
    for (int channels = 1; channels <= 4; ++channels) {
        Image image(2, 1, channels);
        for (float& value : image.values()) value = 0.18f;
        const Image mapped = tone_mapped(image, 1, ToneMap::reinhard);
        EXPECT_NEAR(mapped.at(1, 0)[0], 0.18 / 1.18, 1e-6);
        const bool opacity = channels % 2 == 0;
        EXPECT_NEAR(mapped.at(1, 0)[channels - 1], opacity ? 0.18 : 0.18 / 1.18, 1e-6);
    }
}

}  // namespace
}  // namespace mirrorball
