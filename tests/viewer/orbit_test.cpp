#include <mirrorball/orbit.h>

#include <cmath>

#include <gtest/gtest.h>

namespace mirrorball {
namespace {

Camera some_camera() {
    Camera camera;
    camera.target = {0.5, -1, 2};
    camera.eye = camera.target + Vec3d(1, 2, 4);
    return camera;
}

double distance(const Camera& camera) {
    return (camera.eye - camera.target).length();
}

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance = 1e-12) {
    EXPECT_NEAR((a - b).length(), 0, tolerance) << a << b;
}

// Where a point of the world is in the picture, in its heights from the middle.
Imath::V2d place(const Camera& camera, const Vec3d& point) {
    const Vec3d p = axes(camera).to_map(point - camera.eye);
    const double height = 2 * std::tan(camera.field_of_view / 2) * -p.z;
    return {p.x / height, p.y / height};
}

TEST(Orbit, GoesAroundTheTarget) {
    const Camera camera = some_camera();
    const Camera moved = orbited(camera, 0.7, -0.2);
    EXPECT_EQ(moved.target, camera.target);
    EXPECT_NEAR(distance(moved), distance(camera), 1e-12);
    expect_near(orbited(moved, -0.7, 0.2).eye, camera.eye);
    expect_near(orbited(camera, 2 * kPi, 0).eye, camera.eye);
}

// From the front, a quarter turn to the right is the side at +x.
TEST(Orbit, TurnsToTheRight) {
    Camera camera;
    expect_near(orbited(camera, kPi / 2, 0).eye, {5, 0, 0});
    EXPECT_GT(orbited(camera, 0, 0.3).eye.y, 0);
}

TEST(Orbit, StopsBelowThePoles) {
    const double most = 5 * std::sin(89 * kPi / 180);
    EXPECT_NEAR(orbited(Camera(), 0, 10).eye.y, most, 1e-12);
    EXPECT_NEAR(orbited(Camera(), 0, -10).eye.y, -most, 1e-12);
}

// A scene may say that one looks straight down; moving from there does not jump.
TEST(Orbit, LeavesWhoeverStandsAboveWhereTheyAre) {
    Camera camera;
    camera.eye = {0, 5, 0};
    expect_near(orbited(camera, 0.4, 0).eye, camera.eye, 1e-9);
    EXPECT_LT(orbited(camera, 0, -0.4).eye.y, 5);
}

TEST(Orbit, KeepsToAnUpOfItsOwn) {
    Camera camera;
    camera.up = {1, 0, 0};
    const Camera moved = orbited(camera, 1, 0);
    EXPECT_NEAR(moved.eye.x, 0, 1e-12);
    EXPECT_NEAR(distance(moved), 5, 1e-12);
}

TEST(Zoom, MultipliesTheDistanceWithinReason) {
    const Camera camera = some_camera();
    EXPECT_NEAR(distance(zoomed(camera, 0.25)), distance(camera) / 4, 1e-12);
    expect_near(zoomed(zoomed(camera, 3), 1.0 / 3).eye, camera.eye);
    EXPECT_GT(distance(zoomed(camera, 1e-300)), 0);
    EXPECT_LT(distance(zoomed(camera, 1e300)), 1e7);
}

// What is at the target's distance goes along with the hand.
TEST(Pan, MovesThePictureByHeights) {
    const Camera camera = some_camera();
    const Camera moved = panned(camera, 0.25, -0.1);
    const Imath::V2d target = place(moved, camera.target);
    EXPECT_NEAR(target.x, 0.25, 1e-12);
    EXPECT_NEAR(target.y, -0.1, 1e-12);
    expect_near(moved.eye - moved.target, camera.eye - camera.target);
}

}  // namespace
}  // namespace mirrorball
