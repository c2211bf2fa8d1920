// Equations 4 to 7 as one matrix against the projection that maps are stored by.
#include <random>

#include <gtest/gtest.h>
#include <mirrorball/projections/dual_paraboloid.h>

#include "gl/paraboloid_matrix.h"

namespace mirrorball::gl {
namespace {

// A map's frame that lies along nothing.
const Axes kAskew = rotated({}, 0.7, -0.4, 1.1);

Imath::V4d times(const Vec3d& r, const Imath::M44d& m) {
    return Imath::V4d(r.x, r.y, r.z, 1) * m;
}

TEST(ParaboloidMatrix, IsTheProjectionOnEachSidesOwnMap) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 1000; ++i) {
        const Vec3d r = Vec3d(normal(random), normal(random), normal(random)).normalized();
        const FacePoint<double> expected = DualParaboloid::project(kAskew.to_map(r));
        const Imath::V4d place = times(r, paraboloid_matrix(kAskew, expected.face == 0));
        // 1 + |r_z| in the map's frame, but for its sign
        EXPECT_GE(std::abs(place.w), 1 - 1e-12);
        EXPECT_NEAR(place.x / place.w, expected.s, 1e-14);
        EXPECT_NEAR(place.y / place.w, expected.t, 1e-14);
    }
}

// Where the other map would be used it goes on past its rim, by the same formula.
TEST(ParaboloidMatrix, GoesOnPastTheRim) {
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 1000; ++i) {
        const Vec3d r = Vec3d(normal(random), normal(random), normal(random)).normalized();
        for (const bool front : {true, false}) {
            const Imath::V4d place = times(r, paraboloid_matrix(kAskew, front));
            if (std::abs(place.w) < 1e-3) continue;
            const double x = 2 * place.x / place.w - 1, y = 1 - 2 * place.y / place.w;
            const Vec3d d = kAskew.to_map(r);
            const double q = front ? 1 + d.z : 1 - d.z;
            EXPECT_NEAR(x, d.x / q, 1e-9);
            EXPECT_NEAR(y, d.y / q, 1e-9);
        }
    }
}

// Eq. 4 to 7 worked by hand for r = (0.48, 0.6, 0.64): S gives d_o - r = (-0.48, -0.6, -1.64), P
// keeps it and puts its last component in place of 1, and what is divided is x = 0.48 / 1.64 =
// 12/41 and y = 0.6 / 1.64 = 15/41. T maps to s = x/2 + 1/2 = 53/82 and, as t grows down, t =
// 26/82.
TEST(ParaboloidMatrix, AsWorkedByHand) {
    const Vec3d r(0.48, 0.6, 0.64);
    const Imath::V4d front = times(r, paraboloid_matrix({}, true));
    EXPECT_NEAR(front.w, -1.64, 1e-15);
    EXPECT_NEAR(front.x / front.w, 53.0 / 82, 1e-15);
    EXPECT_NEAR(front.y / front.w, 26.0 / 82, 1e-15);
    // Behind: d_o - r = (-0.48, -0.6, 1.64) for r_z = -0.64; -12/41 and -15/41 are turned back.
    const Imath::V4d back = times({0.48, 0.6, -0.64}, paraboloid_matrix({}, false));
    EXPECT_NEAR(back.w, 1.64, 1e-15);
    EXPECT_NEAR(back.x / back.w, 53.0 / 82, 1e-15);
    EXPECT_NEAR(back.y / back.w, 26.0 / 82, 1e-15);
}

}  // namespace
}  // namespace mirrorball::gl
