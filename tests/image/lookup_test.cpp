// Lookups against what maps were made of, in every projection.
#include <mirrorball/lookup.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <mirrorball/resample.h>

#include "synthetic.h"

namespace mirrorball {
namespace {

const std::vector<Projection> kAll = {Projection::equirect,
                                      Projection::cube,
                                      Projection::sphere,
                                      Projection::dual_paraboloid,
                                      Projection::angular,
                                      Projection::octahedral,
                                      Projection::equal_area_octahedral};

// A frame that is nobody's default, of the other handedness.
const Axes kAskew = mirrored(rotated({}, 0.3, -0.5, 1.1));

Vec3d linear(const Vec3d& d) {
    return {2 + d.x, 2 + 0.6 * d.y - 0.8 * d.z, 2 - d.z};
}

std::vector<Vec3d> directions(int count) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    std::vector<Vec3d> result;
    while (static_cast<int>(result.size()) < count)
        result.push_back(Vec3d(normal(random), normal(random), normal(random)).normalized());
    return result;
}

// Where the texels of a map are stretched without bound: the rim of these two.
bool at_rim(const EnvironmentMap& map, const Vec3d& d) {
    if (map.projection == Projection::sphere) return map.axes.to_map(d).z < -0.8;
    if (map.projection == Projection::angular) return map.axes.to_map(d).z > 0.8;
    return false;
}

// The errors of lookups all around, the smallest first.
std::vector<double> errors(const EnvironmentMap& map, bool rims) {
    std::vector<double> result;
    for (const Vec3d& d : directions(20000)) {
        if (at_rim(map, d) != rims) continue;
        const Vec3d error = Vec3d(look_up(map, d)) - linear(d);
        result.push_back(std::max({std::abs(error.x), std::abs(error.y), std::abs(error.z)}));
    }
    std::sort(result.begin(), result.end());
    return result;
}

class Lookup : public testing::TestWithParam<Projection> {};

// Half the texel, a quarter of the error, but where texels change their direction: at a cube's
// edges, an octahedron's folds and beside rims. Those are no more than a fifth of the sphere here,
// and the error there is in proportion to the texel.
TEST_P(Lookup, LinearLightIsMetToTheSquareOfATexel) {
    const int size = size_for(GetParam(), 128);
    const std::vector<double> coarse = errors(sampled(GetParam(), size, kAskew, linear), false);
    const std::vector<double> fine = errors(sampled(GetParam(), 2 * size, kAskew, linear), false);
    const std::size_t most = coarse.size() * 4 / 5;
    const double h = 2 * kPi / 128;
    EXPECT_LT(coarse[most], h * h);
    EXPECT_GT(coarse[most] / fine[most], 3.0);
    EXPECT_LT(coarse.back(), 0.55 * h);
    EXPECT_LT(fine.back(), 0.55 * h / 2);
}

// A texel beside the rim of a sphere map is acos(1 - 2 (1 - 2/64)^2) = 0.5 away from -z, and half
// of that is what linear light may be off by between two; an angular map's are all alike.
TEST(LookupRims, AreMetToTheirTexels) {
    EXPECT_LT(errors(sampled(Projection::sphere, 64, kAskew, linear), true).back(), 0.25);
    EXPECT_LT(errors(sampled(Projection::angular, 64, kAskew, linear), true).back(), 0.01);
}

TEST_P(Lookup, UniformLightIsExact) {
    const auto light = [](const Vec3d&) { return Vec3d(0.1, 0.7, 1e6 / 3); };
    EnvironmentMap map = sampled(GetParam(), 6, kAskew, light);
    append_mip_levels(map, 1);
    for (const Vec3d& d : directions(5000)) EXPECT_EQ(look_up(map, d), Vec3f(light(d)));
}

TEST_P(Lookup, SmallestMapsAreMapsToo) {
    const int size = GetParam() == Projection::equirect ? 2 : 1;
    const EnvironmentMap map = sampled(GetParam(), size, kAskew, linear);
    for (const Vec3d& d : directions(1000)) {
        for (int i = 0; i < 3; ++i) {
            EXPECT_GE(look_up(map, d)[i], 1 - 1e-6);
            EXPECT_LE(look_up(map, d)[i], 3 + 1e-6);
        }
    }
}

// Small steps all around, through every edge and pole: what is looked up moves no faster than
// texels differ by, plus, where discs meet, what they are off by.
TEST_P(Lookup, NoSeams) {
    const int size = size_for(GetParam(), 128);
    const EnvironmentMap map = sampled(GetParam(), size, kAskew, linear);
    const double step = 2e-5;
    const std::vector<Vec3d> frames = directions(6);
    double worst = 0;
    for (std::size_t k = 0; k + 1 < frames.size(); k += 2) {
        const Vec3d a = frames[k], b = a.cross(frames[k + 1]).normalized();
        Vec3d last(look_up(map, a));
        for (double angle = 0; angle < 2 * kPi; angle += step) {
            const Vec3d d = a * std::cos(angle) + b * std::sin(angle);
            const Vec3d here(look_up(map, d));
            if (!at_rim(map, d)) worst = std::max(worst, (here - last).length());
            last = here;
        }
    }
    // A step of the light itself is at most 1.5e-5 per channel; texels are up to 1.5 times as far
    // apart on the sphere as their lookups.
    const double h = 2 * kPi / 128;
    const double meeting = GetParam() == Projection::dual_paraboloid ? 2 * h * h : 0;
    EXPECT_LT(worst, 2 * 1.73 * step + meeting);
}

TEST_P(Lookup, BetweenLevelsInProportion) {
    EnvironmentMap map = sampled(GetParam(), 32, kAskew, linear);
    append_mip_levels(map);
    for (const Vec3d& d : directions(100)) {
        const Vec3f fine = look_up(map, d, 1), coarse = look_up(map, d, 2);
        EXPECT_NEAR((look_up_at_lod(map, d, 1.25) - (fine * 0.75f + coarse * 0.25f)).length(), 0,
                    1e-6);
        EXPECT_EQ(look_up_at_lod(map, d, 1), fine);
        EXPECT_EQ(look_up_at_lod(map, d, -3), look_up(map, d, 0));
        EXPECT_EQ(look_up_at_lod(map, d, 99), look_up(map, d, map.level_count() - 1));
    }
}

INSTANTIATE_TEST_SUITE_P(AllProjections, Lookup, testing::ValuesIn(kAll), [](const auto& test) {
    std::string text(name(test.param));
    std::replace(text.begin(), text.end(), '-', '_');
    return text;
});

// All three faces agree at a corner, and so at the edges that lead there.
TEST(LookupCube, CornersAgree) {
    const EnvironmentMap map = sampled(Projection::cube, 2, smooth_light);
    const double e = 1e-9;
    const Vec3f x = look_up(map, {1, 1 - e, 1 - e}), y = look_up(map, {1 - e, 1, 1 - e}),
                z = look_up(map, {1 - e, 1 - e, 1});
    EXPECT_NEAR((x - y).length(), 0, 1e-6);
    EXPECT_NEAR((x - z).length(), 0, 1e-6);
}

}  // namespace
}  // namespace mirrorball
