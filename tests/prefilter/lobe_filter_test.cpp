// Lobes that come one by one, next to those that are known beforehand.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <mirrorball/builtin.h>
#include <mirrorball/error.h>
#include <mirrorball/prefilter.h>

#include "synthetic.h"

namespace mirrorball {
namespace {

std::shared_ptr<const EnvironmentMap> sky(Projection projection, int size) {
    return std::make_shared<const EnvironmentMap>(
        make_builtin("sunset", projection, size, default_axes(projection)));
}

PrefilterTarget target_for(const char* lobe, int size = 32) {
    return {parse_lobe(lobe), Projection::cube, size, default_axes(Projection::cube)};
}

// The root mean square of the differences over that of what there is.
double difference(const EnvironmentMap& a, const EnvironmentMap& b) {
    double error = 0, light = 0;
    for (std::size_t face = 0; face < b.levels[0].faces.size(); ++face) {
        const auto x = a.levels[0].faces[face].values(), y = b.levels[0].faces[face].values();
        for (std::size_t i = 0; i < y.size(); ++i) {
            error += (x[i] - y[i]) * (x[i] - y[i]);
            light += y[i] * y[i];
        }
    }
    return std::sqrt(error / light);
}

bool same_bits(const EnvironmentMap& a, const EnvironmentMap& b) {
    for (std::size_t face = 0; face < b.levels[0].faces.size(); ++face) {
        const auto x = a.levels[0].faces[face].values(), y = b.levels[0].faces[face].values();
        if (!std::equal(x.begin(), x.end(), y.begin(), y.end())) return false;
    }
    return true;
}

constexpr const char* kLobes[] = {"ggx:0.15", "ggx:0.3",   "ggx:0.7",     "ggx:1",
                                  "phong:10", "phong:500", "charlie:0.4", "diffuse"};

// Each may be off by the tolerance from the same truth.
TEST(LobeFilter, GivesWhatPlansGive) {
    for (const auto& source : {sky(Projection::equirect, 128), sky(Projection::cube, 32)}) {
        LobeFilter filter(source);
        for (const char* lobe : kLobes) {
            const PrefilterTarget target = target_for(lobe);
            const EnvironmentMap map = filter(target);
            EXPECT_EQ(map.levels[0].lobe, target.lobe);
            EXPECT_LT(difference(map, prefilter(*source, {&target, 1})[0]), 2e-4) << lobe;
        }
    }
}

TEST(LobeFilter, NarrowLobesAndMirrorsToo) {
    const auto source = sky(Projection::equirect, 64);
    LobeFilter filter(source);
    for (const char* lobe : {"mirror", "ggx:0.01", "ggx:0.1"}) {
        const PrefilterTarget target = target_for(lobe, 16);
        EXPECT_LT(difference(filter(target), prefilter(*source, {&target, 1})[0]), 1e-3) << lobe;
    }
}

TEST(LobeFilter, BitsDoNotDependOnWhatWasAskedBefore) {
    const auto source = sky(Projection::cube, 32);
    LobeFilter filter(source);
    std::vector<EnvironmentMap> first;
    for (const char* lobe : kLobes) first.push_back(filter(target_for(lobe)));
    for (std::size_t i = first.size(); i-- > 0;) {
        const PrefilterTarget target = target_for(kLobes[i]);
        EXPECT_TRUE(same_bits(filter(target), first[i])) << kLobes[i];
        EXPECT_TRUE(same_bits(LobeFilter(source)(target), first[i])) << kLobes[i];
    }
}

TEST(LobeFilter, DarkSourcesAreDark) {
    LobeFilter filter(
        std::make_shared<const EnvironmentMap>(make_environment_map(Projection::equirect, 64)));
    for (const char* lobe : {"ggx:0.1", "ggx:0.5", "diffuse"}) {
        const EnvironmentMap map = filter(target_for(lobe));
        for (const Image& face : map.levels[0].faces)
            for (const float value : face.values()) ASSERT_EQ(value, 0) << lobe;
    }
}

TEST(LobeFilter, KnowsWhichLobesTakeLong) {
    const auto source =
        std::make_shared<const EnvironmentMap>(make_environment_map(Projection::equirect, 1024));
    const LobeFilter filter(source);
    const auto is_quick = [&](const char* lobe) {
        return filter.is_quick({parse_lobe(lobe), Projection::cube, 256});
    };
    for (const char* lobe : {"mirror", "diffuse", "ggx:1", "ggx:0.12", "phong:1000"})
        EXPECT_TRUE(is_quick(lobe)) << lobe;
    for (const char* lobe : {"ggx:0.1", "ggx:0.06", "ggx:0.03"})
        EXPECT_FALSE(is_quick(lobe)) << lobe;
}

TEST(LobeFilter, RefusesWhatPlansRefuse) {
    auto broken = make_environment_map(Projection::equirect, 64);
    broken.levels[0].faces[0].set_rgb(3, 4, Vec3f(std::numeric_limits<float>::quiet_NaN()));
    EXPECT_THROW(LobeFilter(std::make_shared<const EnvironmentMap>(broken)), Error);
    const auto source = sky(Projection::equirect, 64);
    EXPECT_THROW(LobeFilter(source, {.tolerance = 0}), Error);
    LobeFilter filter(source);
    EXPECT_THROW((void)filter(target_for("table:gloss")), Error);
    EXPECT_THROW((void)filter(target_for("ggx:0.5", 0)), Error);
}

}  // namespace
}  // namespace mirrorball
