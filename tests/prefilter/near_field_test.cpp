// Near parts added in space, against a sum in double over every light.
#include "prefilter/near_field.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "prefilter/band_split.h"

namespace mirrorball::detail {
namespace {

struct Texels {
    std::vector<float> x, y, z, r, g, b, weight;

    explicit Texels(const std::vector<Vec3f>& directions)
        : r(directions.size()),
          g(directions.size()),
          b(directions.size()),
          weight(directions.size()) {
        for (const Vec3f& d : directions) {
            x.push_back(d.x);
            y.push_back(d.y);
            z.push_back(d.z);
        }
    }
    NearTile tile() { return {x, y, z, r, g, b, weight}; }
};

std::vector<Vec3f> directions(std::size_t count, unsigned seed, const Vec3f& about = Vec3f(0.0f),
                              float spread = 1) {
    std::mt19937 generator(seed);
    std::normal_distribution<float> normal;
    std::vector<Vec3f> found(count);
    for (Vec3f& d : found) {
        d = about + Vec3f(normal(generator), normal(generator), normal(generator)) * spread;
        d.normalize();
    }
    return found;
}

std::vector<Light> lights(const std::vector<Vec3f>& at) {
    std::vector<Light> lights;
    for (std::size_t i = 0; i < at.size(); ++i) {
        const float power = 1 + static_cast<float>(i % 7);
        lights.push_back({at[i], {power, 0.5f * power, 2}, 0.25f * power});
    }
    return lights;
}

// Differences of float directions, as the kernel is asked; sums in double.
void expect_brute_force(const NearKernel& near, const std::vector<Light>& lights,
                        const std::vector<Vec3f>& at, const char* what) {
    Texels texels(at);
    NearField(lights).add(near, texels.tile());
    double worst = 0, largest = 0;
    for (std::size_t i = 0; i < at.size(); ++i) {
        double sums[4] = {};
        for (const Light& light : lights) {
            const Vec3f d = at[i] - light.direction;
            const double k = double{near(d.x * d.x + (d.y * d.y + d.z * d.z))};
            sums[0] += k * light.power.x;
            sums[1] += k * light.power.y;
            sums[2] += k * light.power.z;
            sums[3] += k * light.solid_angle;
        }
        const float found[] = {texels.r[i], texels.g[i], texels.b[i], texels.weight[i]};
        for (int c = 0; c < 4; ++c) {
            worst = std::max(worst, std::abs(sums[c] - found[c]));
            largest = std::max(largest, std::abs(sums[c]));
        }
    }
    // float sums of up to 3000 terms of both signs; a step of the table lost or won at its rim
    EXPECT_LE(worst, 2e-5 * largest) << what;
    EXPECT_GT(largest, 0) << what;
}

TEST(NearField, AgreesWithBruteForce) {
    for (const char* text : {"diffuse", "ggx:0.5", "ggx:0.05", "charlie:1", "phong:1e5"}) {
        const NearKernel near = split_bands(parse_lobe(text), 1e-4, 1024).near;
        // a tile beside the lights or, for rings at the horizon, at right angles to them
        const Vec3f here(0.6f, -0.64f, 0.48f), across(0.8f, 0.48f, -0.36f);
        const Vec3f there = near(0) != 0 ? here : across;
        for (const std::size_t light_count : {1, 7, 9, 3000})
            for (const std::size_t texel_count : {1, 63, 64, 100})
                expect_brute_force(near, lights(directions(light_count, 5, here, 0.01f)),
                                   directions(texel_count, 6, there, 0.01f), text);
        expect_brute_force(near, lights(directions(3000, 1)), directions(500, 2), text);
    }
}

TEST(NearField, NothingIsAddedOutOfReach) {
    const NearKernel near = split_bands(parse_lobe("ggx:0.05"), 1e-4, 1024).near;
    const auto lit = lights(directions(50, 3, {0, 0, 1}, 0.01f));
    Texels texels(directions(64, 4, {0, 0, -1}, 0.1f));
    NearField(lit).add(near, texels.tile());
    for (const float value : texels.r) EXPECT_EQ(value, 0);
    // nor by no lights, a kernel without parts, or to no texels
    NearField({}).add(near, texels.tile());
    NearField(lit).add(NearKernel(), texels.tile());
    Texels none{std::vector<Vec3f>{}};
    NearField(lit).add(near, none.tile());
}

TEST(NearField, AddsToWhatIsThere) {
    const NearKernel near = split_bands(parse_lobe("diffuse"), 1e-4, 1024).near;
    const auto lit = lights(directions(20, 3));
    const auto at = directions(70, 4);
    Texels once(at), twice(at);
    const NearField field(lit);
    field.add(near, once.tile());
    field.add(near, twice.tile());
    field.add(near, twice.tile());
    for (std::size_t i = 0; i < at.size(); ++i)
        EXPECT_NEAR(twice.r[i], 2 * once.r[i], 1e-6f * std::abs(once.r[i]) + 1e-7f);
}

// The tables themselves: what they say is what they were made of, an entry at the axis and at the
// horizon, and nothing outside.
TEST(NearKernel, ReadsWhatWasTabulated) {
    NearKernel kernel;
    const auto cone = [](std::span<const double> chords2) {
        std::vector<double> values;
        for (const double chord2 : chords2) values.push_back(1 / (1e-6 + chord2));
        return values;
    };
    kernel.add_part(0, 0.5, 1e-6, 10, cone);
    EXPECT_NEAR(kernel(0), 1e6, 1);
    for (const float chord2 : {1e-8f, 1e-6f, 1e-4f, 0.01f, 0.2f})
        EXPECT_NEAR(kernel(chord2) * (1e-6 + chord2), 1, 1e-6) << chord2;
    EXPECT_EQ(kernel(0.26f), 0);
    EXPECT_EQ(kernel(4), 0);
    NearKernel ring;
    ring.add_part(1.3, 1.5, 0, 12, [](std::span<const double> chords2) {
        std::vector<double> values;
        for (const double chord2 : chords2) values.push_back(std::max(0.0, 2 - chord2));
        return values;
    });
    EXPECT_EQ(ring(2), 0);
    EXPECT_NEAR(ring(1.9999f), 1e-4, 1e-7);
    EXPECT_EQ(ring(2.0001f), 0);
    EXPECT_EQ(ring(1.6f), 0);
    EXPECT_TRUE(ring.reaches(1.4f, 1.45f));
    EXPECT_TRUE(ring.reaches(0, 2));
    EXPECT_FALSE(ring.reaches(0, 1.2f));
    EXPECT_FALSE(ring.reaches(1.6f, 2));
}

}  // namespace
}  // namespace mirrorball::detail
