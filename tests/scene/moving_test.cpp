// What of a scene depends on its time.
#include <gtest/gtest.h>
#include <mirrorball/scene.h>

namespace mirrorball {
namespace {

void expect_near(const Vec3d& a, const Vec3d& b) {
    EXPECT_LT((a - b).length(), 1e-12) << a << " " << b;
}

TEST(Moving, LightsTurnAsObjectsDo) {
    Scene scene;
    scene.lights = {ScenePointLight{{1, 2, -3}, {1, 1, 1}, 0.25},
                    SceneDirectionalLight{{0, 1, -1}, {1, 1, 1}, -0.5}, ScenePointLight{}};
    EXPECT_EQ(lights_now(scene), scene.lights);
    scene.time = 3;
    const std::vector<SceneLight> lights = lights_now(scene);
    const auto turned = [](const Vec3d& p, double yaw) {
        Transform turn;
        turn.yaw = yaw;
        return turn.point(p);
    };
    expect_near(std::get<ScenePointLight>(lights[0]).position, turned({1, 2, -3}, 0.75));
    expect_near(std::get<SceneDirectionalLight>(lights[1]).direction, turned({0, 1, -1}, -1.5));
    EXPECT_EQ(lights[2], scene.lights[2]);
}

TEST(Moving, BumpsDriftAndTheirMatrixTurns) {
    BumpMap bump;
    bump.offset = {0.5, 0.25}, bump.drift = {0.75, -0.5};
    EXPECT_EQ(offset_at(bump, 0), Imath::V2d(0.5, 0.25));
    EXPECT_EQ(offset_at(bump, 2), Imath::V2d(0, 0.25)) << "a whole number of tiles is none";
    bump.wrap = Wrap::clamp;
    EXPECT_EQ(offset_at(bump, 2), Imath::V2d(2, -0.75));

    bump.matrix = {1, 2, 3, 4};
    bump.matrix_turn = kPi / 2;
    EXPECT_EQ(matrix_at(bump, 0), bump.matrix);
    EXPECT_TRUE(matrix_at(bump, 1).equalWithAbsError({-3, -4, 1, 2}, 1e-12))
        << "a quarter turn of what it gives: (x, y) to (-y, x)";
}

TEST(Moving, FormsTakeTheirMethods) {
    BumpMap bump;
    for (const Method method : all_methods()) EXPECT_TRUE(can_show(method, bump)) << name(method);
    bump.source = "waves";
    EXPECT_TRUE(can_show(Method::cube, bump));
    EXPECT_FALSE(can_show(Method::cube_split, bump));
    EXPECT_FALSE(can_show(Method::sphere_vertex, bump));
    bump.form = BumpForm::classic;
    EXPECT_TRUE(can_show(Method::sphere_vertex, bump));
    EXPECT_TRUE(can_show(Method::sphere_stale, bump));
    EXPECT_FALSE(can_show(Method::cube, bump));
}

}  // namespace
}  // namespace mirrorball
