#include "io/repair.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/texel_use.h"
#include "io_test_support.h"

namespace mirrorball::detail {
namespace {

const float kNan = std::numeric_limits<float>::quiet_NaN();
const float kInfinity = std::numeric_limits<float>::infinity();

constexpr Projection kRoundProjections[] = {Projection::sphere, Projection::angular,
                                            Projection::dual_paraboloid};

void fill(Level& level, float value) {
    for (Image& face : level.faces) {
        std::fill(face.values().begin(), face.values().end(), value);
    }
}

TEST(TexelUse, AgreesWithTheTable) {
    for (std::size_t i = 0; i < kProjectionCount; ++i) {
        const auto projection = static_cast<Projection>(i);
        for (const int height : {1, 2, 5, 16}) {
            const int width = aspect(projection) * height;
            const std::vector<double> table = solid_angle_table(projection, width, height);
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    EXPECT_EQ(texel_solid_angle(projection, width, height, x, y),
                              table[std::size_t(y) * width + x]);
                }
            }
        }
        const bool round =
            std::count(std::begin(kRoundProjections), std::end(kRoundProjections), projection) == 1;
        EXPECT_EQ(has_unused_texels(projection), round) << name(projection);
    }
}

// A texel wholly outside the disc has no solid angle at all, not a sum's rounding: zero is how
// unused texels are told.
TEST(TexelUse, IsExactlyZeroOutsideTheDisc) {
    for (const Projection projection : kRoundProjections) {
        constexpr int size = 100;
        int unused_count = 0;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                const int column = std::max(x, size - 1 - x) - size / 2;
                const int row = std::max(y, size - 1 - y) - size / 2;
                const bool outside = column * column + row * row >= size * size / 4;
                EXPECT_EQ(texel_solid_angle(projection, size, size, x, y) == 0, outside);
                unused_count += outside;
            }
        }
        EXPECT_GT(unused_count, 0);
    }
}

TEST(FindFaults, CountsTexelsAndTellsWhereTheFirstIs) {
    EnvironmentMap map = make_environment_map(Projection::cube, 4);
    Level& level = map.levels[0];
    level.faces[1].set_rgb(2, 3, {1, kNan, kNan});
    level.faces[1].set_rgb(3, 3, {kInfinity, 0, 0});
    level.faces[4].set_rgb(0, 0, {0, 0, -kInfinity});
    level.faces[0].set_rgb(0, 0, {-1, -2, 5});
    level.faces[5].set_rgb(1, 1, {-0.5f, 0, 0});

    const TexelFaults faults = find_faults(level, map.projection);
    EXPECT_EQ(faults.non_finite_count, 3);
    EXPECT_EQ(faults.first_non_finite.face, 1);
    EXPECT_EQ(faults.first_non_finite.x, 2);
    EXPECT_EQ(faults.first_non_finite.y, 3);
    EXPECT_EQ(faults.negative_count, 2);
    EXPECT_EQ(faults.smallest, -2);
}

TEST(FindFaults, IgnoresUnusedTexels) {
    for (const Projection projection : kRoundProjections) {
        EnvironmentMap map = make_environment_map(projection, 8);
        for (Image& face : map.levels[0].faces) {
            face.set_rgb(0, 0, {kNan, 0, 0});
            face.set_rgb(7, 7, {-1, 0, 0});
        }
        const TexelFaults faults = find_faults(map.levels[0], projection);
        EXPECT_EQ(faults.non_finite_count, 0);
        EXPECT_EQ(faults.negative_count, 0);

        clear_unused_faults(map.levels[0], projection);
        EXPECT_EQ(map.levels[0].faces[0].rgb(0, 0), Vec3f(0, 0, 0));
        EXPECT_EQ(map.levels[0].faces[0].rgb(7, 7), Vec3f(-1, 0, 0));
    }
}

TEST(Repair, TakesTheMeanOfTheFourNeighbours) {
    EnvironmentMap map = make_environment_map(Projection::equirect, 8);
    Image& image = map.levels[0].faces[0];
    image.set_rgb(3, 1, {1, 0, 8});
    image.set_rgb(5, 1, {2, 0, 0});
    image.set_rgb(4, 0, {3, 0, 0});
    image.set_rgb(4, 2, {6, 4, 0});
    image.set_rgb(4, 1, {kNan, 7, 7});
    EXPECT_EQ(repair(map.levels[0], map.projection), 1);
    EXPECT_EQ(image.rgb(4, 1), Vec3f(3, 1, 2));
}

TEST(Repair, ReachesAcrossTheEdgesOfThePicture) {
    EnvironmentMap map = make_environment_map(Projection::equirect, 8);
    Image& image = map.levels[0].faces[0];
    fill(map.levels[0], kNan);
    image.set_rgb(7, 2, {5, 5, 5});
    image.set_rgb(0, 3, {2, 2, 2});
    image.set_rgb(0, 1, {2, 2, 2});
    EXPECT_EQ(repair(map.levels[0], map.projection), 8 * 4 - 3);
    EXPECT_EQ(image.rgb(0, 2), Vec3f(3, 3, 3));  // 5 from the other side of the seam
}

// A texel of the middle is never better than what surrounds it, and a hole in a constant vanishes.
TEST(Repair, FillsHolesOfAnySizeInEveryProjection) {
    for (std::size_t i = 0; i < kProjectionCount; ++i) {
        const auto projection = static_cast<Projection>(i);
        for (const int size : {1, 2, 6, 16}) {
            if (size % aspect(projection) != 0) continue;
            SCOPED_TRACE(std::string(name(projection)) + " " + std::to_string(size));
            EnvironmentMap map = make_environment_map(projection, size);
            Level& level = map.levels[0];
            fill(level, kNan);
            clear_unused_faults(level, projection);
            const std::int64_t used_count = find_faults(level, projection).non_finite_count;
            level.faces.back().set_rgb(level.width() / 2, level.height() / 2, {3, 2, 1});
            EXPECT_EQ(repair(level, projection), used_count - 1);
            for (const Image& face : level.faces) {
                for (int y = 0; y < face.height(); ++y) {
                    for (int x = 0; x < face.width(); ++x) {
                        if (texel_solid_angle(projection, face.width(), face.height(), x, y) == 0) {
                            continue;
                        }
                        EXPECT_EQ(face.rgb(x, y), Vec3f(3, 2, 1)) << x << ", " << y;
                    }
                }
            }
        }
    }
}

TEST(Repair, LeavesGoodTexelsAsTheyAre) {
    EnvironmentMap map = numbered_map(Projection::cube, 8);
    const EnvironmentMap before = map;
    map.levels[0].faces[2].set_rgb(0, 7, {0, kNan, 0});
    map.levels[0].faces[2].set_rgb(1, 7, {0, kInfinity, 0});
    EXPECT_EQ(repair(map.levels[0], map.projection), 2);
    for (int face = 0; face < 6; ++face) {
        for (int y = 0; y < 8; ++y) {
            for (int x = 0; x < 8; ++x) {
                const bool repaired = face == 2 && y == 7 && x < 2;
                if (repaired) continue;
                EXPECT_EQ(map.levels[0].faces[face].rgb(x, y),
                          before.levels[0].faces[face].rgb(x, y));
            }
        }
    }
    EXPECT_EQ(find_faults(map.levels[0], map.projection).non_finite_count, 0);
}

TEST(Repair, LeavesAMapWithoutOneGoodTexel) {
    EnvironmentMap map = make_environment_map(Projection::sphere, 4);
    fill(map.levels[0], kNan);
    EXPECT_EQ(repair(map.levels[0], map.projection), 0);
}

}  // namespace
}  // namespace mirrorball::detail
