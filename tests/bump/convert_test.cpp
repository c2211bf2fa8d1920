// Slopes and normals of reliefs whose derivatives are known, at every edge and size.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <mirrorball/bump.h>
#include <mirrorball/error.h>

namespace mirrorball {
namespace {

template <class Height>
HeightMap relief_of(int columns, int rows, double width, double height, Wrap wrap,
                    const Height& value) {
    HeightMap relief{Image(columns, rows, 1), width, height, wrap};
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            *relief.heights.at(x, y) = static_cast<float>(
                value((x + 0.5) / columns * width, (1 - (y + 0.5) / rows) * height));
    return relief;
}

// 30 degrees up to the right and 20 up to the top: the normal leans left and down by those.
TEST(BumpSlopes, RampTiltsTheNormalByItsAngle) {
    const double du = std::tan(kPi / 6), dv = std::tan(kPi / 9);
    for (const auto& [columns, rows] : {std::pair{16, 8}, {5, 7}, {4, 3}, {2, 2}}) {
        const HeightMap relief = relief_of(columns, rows, 2, 0.5, Wrap::clamp,
                                           [&](double x, double y) { return du * x + dv * y; });
        const SlopeMap map = slopes(relief);
        const NormalMap normal = normals(relief);
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x) {
                // Heights of about 1 as floats, differenced over at least 1/16 m, weights below 9.
                EXPECT_NEAR(map.slopes.at(x, y)[0], du, 2e-5) << columns << " " << x << " " << y;
                EXPECT_NEAR(map.slopes.at(x, y)[1], dv, 2e-5) << columns << " " << x << " " << y;
                const Vec3f n = normal.normals.rgb(x, y);
                EXPECT_NEAR(std::atan2(-n.x, n.z), kPi / 6, 2e-5);
                EXPECT_NEAR(std::atan2(-n.y, n.z), kPi / 9, 2e-5);
                EXPECT_NEAR(n.length(), 1, 1e-6);
            }
    }
}

TEST(BumpSlopes, CubicsAreExactWithClampedEdgesToo) {
    const HeightMap relief = relief_of(12, 12, 1, 1, Wrap::clamp, [](double x, double y) {
        return x * x * x - 2 * y * y * y + x * y;
    });
    const SlopeMap map = slopes(relief);
    for (int row = 0; row < 12; ++row)
        for (int column = 0; column < 12; ++column) {
            const double x = (column + 0.5) / 12, y = 1 - (row + 0.5) / 12;
            EXPECT_NEAR(map.slopes.at(column, row)[0], 3 * x * x + y, 1e-5);
            EXPECT_NEAR(map.slopes.at(column, row)[1], -6 * y * y + x, 1e-5);
        }
}

// The response that the header states, at 4, 8 and 16 texels a wave, and no seam where they repeat.
TEST(BumpSlopes, SinesHaveTheStatedResponse) {
    constexpr int kSize = 64;
    for (const int cycles : {4, 8, 16}) {
        const double w = 2 * kPi * cycles / kSize;
        const double response = (8 * std::sin(w) - std::sin(2 * w)) / (6 * w);
        EXPECT_NEAR(response, 1 - std::pow(w, 4) / 30, std::pow(w, 6) / 140);
        for (const bool upright : {false, true}) {
            const HeightMap relief =
                relief_of(kSize, kSize, 1, 1, Wrap::repeat, [&](double x, double y) {
                    return 0.01 * std::sin(2 * kPi * cycles * (upright ? y : x));
                });
            const SlopeMap map = slopes(relief);
            for (int row = 0; row < kSize; ++row)
                for (int column = 0; column < kSize; ++column) {
                    const double at = upright ? 1 - (row + 0.5) / kSize : (column + 0.5) / kSize;
                    const double expected =
                        0.01 * 2 * kPi * cycles * response * std::cos(2 * kPi * cycles * at);
                    EXPECT_NEAR(map.slopes.at(column, row)[upright], expected, 1e-6);
                    EXPECT_EQ(map.slopes.at(column, row)[!upright], 0);
                }
        }
    }
}

TEST(BumpSlopes, MirroredEdgesAreFlatAndTilesAreShifted) {
    const auto cosine = [](double x, double) { return 0.1 * std::cos(kPi * x); };
    const SlopeMap mirrored = slopes(relief_of(32, 4, 1, 1, Wrap::mirror, cosine));
    for (int x = 0; x < 32; ++x)
        EXPECT_NEAR(mirrored.slopes.at(x, 2)[0], -0.1 * kPi * std::sin(kPi * (x + 0.5) / 32), 2e-5);

    // A tile moved by any number of texels has its slopes moved likewise, bit for bit.
    HeightMap tile{Image(9, 7, 1)}, moved{Image(9, 7, 1)};
    for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 9; ++x)
            *tile.heights.at(x, y) = *moved.heights.at((x + 4) % 9, (y + 5) % 7) =
                static_cast<float>((x * 31 + y * 17) % 13);
    const SlopeMap a = slopes(tile), b = slopes(moved);
    for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 9; ++x)
            for (int c = 0; c < 2; ++c)
                EXPECT_EQ(a.slopes.at(x, y)[c], b.slopes.at((x + 4) % 9, (y + 5) % 7)[c]);
}

TEST(BumpSlopes, SmallestPicturesAndEqualHeightsAreFlat) {
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror})
        for (const auto& [columns, rows] : {std::pair{1, 1}, {1, 6}, {3, 1}, {8, 8}}) {
            HeightMap relief{Image(columns, rows, 1), 1, 1, wrap};
            for (float& height : relief.heights.values()) height = 12345.678f;
            const NormalMap map = normals(relief);
            for (int y = 0; y < rows; ++y)
                for (int x = 0; x < columns; ++x)
                    EXPECT_EQ(map.normals.rgb(x, y), Vec3f(0, 0, 1)) << name(wrap) << columns;
        }
}

TEST(BumpSlopes, WhatIsNoNumberIsRefused) {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        HeightMap relief{Image(4, 4, 1)};
        *relief.heights.at(2, 1) = bad;
        try {
            (void)slopes(relief);
            FAIL();
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), Errc::cannot_read);
            EXPECT_NE(std::string(error.what()).find("column 2, row 1"), std::string::npos);
        }
    }
    HeightMap steep{Image(4, 4, 1), 1e-3, 1, Wrap::repeat};
    *steep.heights.at(2, 1) = 3e38f;
    EXPECT_THROW((void)slopes(steep), Error);
}

TEST(BumpNormals, SlopesComeBack) {
    SlopeMap map{Image(40, 30, 2)};
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            map.slopes.at(x, y)[0] = static_cast<float>(x - 20) / 5;
            map.slopes.at(x, y)[1] = static_cast<float>(y - 15) / 7;
        }
    const SlopeMap back = slopes(normals(map));
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x)
            for (int c = 0; c < 2; ++c)  // rounding of a unit vector, over an n_z down to 0.2
                EXPECT_NEAR(back.slopes.at(x, y)[c], map.slopes.at(x, y)[c], 3e-6);
}

TEST(BumpNormals, SteepAndInwardOnesBecomeSteepSlopes) {
    NormalMap map{Image(3, 1, 3)};
    map.normals.set_rgb(0, 0, {1, 0, 0});
    map.normals.set_rgb(1, 0, {0, 0.8f, -0.6f});
    map.normals.set_rgb(2, 0, {0, 0, -1});
    const SlopeMap result = slopes(map);
    EXPECT_EQ(result.slopes.at(0, 0)[0], -100);
    EXPECT_EQ(result.slopes.at(1, 0)[1], -100);
    EXPECT_EQ(result.slopes.at(2, 0)[0], 0);
}

// Stored forms ------------------------------------------------------------------------------------

TEST(StoredNormals, GreenUpAndDownAreEachOthersMirror) {
    const HeightMap relief =
        relief_of(8, 8, 1, 1, Wrap::clamp, [](double, double y) { return 0.5 * y; });
    const NormalMap map = normals(relief);
    const Image up = stored_normals(map, Green::up), down = stored_normals(map, Green::down);
    EXPECT_LT(up.rgb(3, 3).y, 0.5f);  // higher above: leans down
    EXPECT_GT(down.rgb(3, 3).y, 0.5f);
    EXPECT_FLOAT_EQ(up.rgb(3, 3).y + down.rgb(3, 3).y, 1);
    for (const Green green : {Green::up, Green::down}) {
        const NormalMap back = parse_normals(stored_normals(map, green), green);
        EXPECT_NEAR((back.normals.rgb(3, 3) - map.normals.rgb(3, 3)).length(), 0, 2e-7);
    }
}

TEST(StoredNormals, FlatStaysFlatThroughCodes) {
    for (const int most : {255, 65535})
        for (const int code : {most / 2, most / 2 + 1}) {
            const float value = static_cast<float>(code) / static_cast<float>(most);
            Image picture(2, 2, 3);
            for (int i = 0; i < 4; ++i) picture.set_rgb(i % 2, i / 2, Vec3f(value, value, 1));
            for (const Green green : {Green::up, Green::down})
                EXPECT_EQ(parse_normals(picture, green, 1.0 / most).normals.rgb(1, 1),
                          Vec3f(0, 0, 1));
        }
}

TEST(StoredNormals, SignedValuesAreRecognised) {
    const HeightMap relief = relief_of(16, 16, 1, 1, Wrap::repeat, [](double x, double y) {
        return 0.05 * std::sin(2 * kPi * (x + y));
    });
    const NormalMap map = normals(relief);
    NormalFaults faults;
    const NormalMap as_is = parse_normals(map.normals, Green::up, 0, &faults);
    EXPECT_TRUE(faults.signed_values);
    EXPECT_NEAR((as_is.normals.rgb(5, 5) - map.normals.rgb(5, 5)).length(), 0, 2e-7);
    (void)parse_normals(stored_normals(map, Green::up), Green::up, 0, &faults);
    EXPECT_FALSE(faults.signed_values);
}

TEST(StoredNormals, BadTexelsAreCountedAndNeverNaN) {
    Image picture(4, 1, 3);
    picture.set_rgb(0, 0, {0.5f, 0.5f, 1});
    picture.set_rgb(1, 0, {0.5f, 0.5f, 0.5f});  // no direction
    picture.set_rgb(2, 0, {1, 0.5f, 0.5f});     // within the surface
    picture.set_rgb(3, 0, {0.5f, 0.5f, 0});     // straight in
    NormalFaults faults;
    const NormalMap map = parse_normals(picture, Green::up, 0, &faults);
    EXPECT_EQ(faults.without_count, 1);
    EXPECT_EQ(faults.inward_count, 2);
    EXPECT_NEAR(faults.largest_length_error, 1, 1e-6);
    for (int x = 0; x < 4; ++x) {
        EXPECT_NEAR(map.normals.rgb(x, 0).length(), 1, 1e-6);
        EXPECT_GT(map.normals.rgb(x, 0).z, 0);
    }
    EXPECT_THROW((void)parse_normals(Image(4, 4, 1), Green::up), Error);
    EXPECT_THROW((void)parse_normals(Image(4, 4, 2), Green::up), Error);
    picture.at(2, 0)[1] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW((void)parse_normals(picture, Green::up), Error);
}

TEST(BumpSeams, TilesHaveNoneAndRampsDo) {
    const auto sine = [](double x, double y) {
        return std::sin(2 * kPi * x) * std::cos(2 * kPi * y);
    };
    const Seams tile = seams(relief_of(64, 64, 1, 1, Wrap::repeat, sine));
    EXPECT_NEAR(tile.across, 1, 0.5);  // a sine's slope at the edge, over its mean one: sqrt 2
    EXPECT_LT(tile.down, 1.5);
    const Seams ramp =
        seams(relief_of(64, 64, 1, 1, Wrap::repeat, [](double x, double) { return x; }));
    EXPECT_NEAR(ramp.across, 63, 0.01);
    EXPECT_EQ(ramp.down, 0);
}

TEST(BumpNames, ComeBackAndOthersAreRefused) {
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror})
        EXPECT_EQ(parse_wrap(name(wrap)), wrap);
    for (const Green green : {Green::up, Green::down}) EXPECT_EQ(parse_green(name(green)), green);
    EXPECT_THROW((void)parse_wrap("tile"), Error);
    EXPECT_THROW((void)parse_green("opengl"), Error);
}

}  // namespace
}  // namespace mirrorball
