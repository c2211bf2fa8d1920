#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <mirrorball/mesh.h>
#include <mirrorball/scene.h>

namespace mirrorball {
namespace {

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance = 1e-12) {
    EXPECT_NEAR((a - b).length(), 0, tolerance) << a << " and " << b;
}

TEST(Transform, ScalesTurnsAndMoves) {
    Transform t;
    t.position = {1, 2, 3};
    t.scale = {2, 1, 1};
    t.yaw = kPi / 2;  // what is ahead goes to the left: -z to -x, so +x to -z
    expect_near(t.point({0, 0, 0}), {1, 2, 3});
    expect_near(t.point({1, 0, 0}), {1, 2, 1});
    expect_near(t.point({0, 0, -1}), {0, 2, 3});
}

TEST(Transform, MatrixIsTheSame) {
    Transform t{{1, -2, 3}, 0.3, -0.7, 1.1, {2, -0.5, 3}};
    Vec3d p(0.3, 0.7, -0.2), moved;
    matrix(t).multVecMatrix(p, moved);
    expect_near(moved, t.point(p));
}

// A normal stays perpendicular to what lies in its surface, and on the same side.
TEST(Transform, NormalsStayPerpendicular) {
    const Transform t{{1, -2, 3}, 0.3, -0.7, 1.1, {2, -0.5, 3}};
    const Vec3d n = Vec3d(1, 2, -3).normalized(), inside(0.0);
    const Vec3d a = n.cross({1, 0, 0}), b = n.cross(a);
    const Vec3d normal = t.normal(n);
    EXPECT_NEAR(normal.length(), 1, 1e-12);
    EXPECT_NEAR(normal.dot(t.point(a) - t.point(inside)), 0, 1e-12);
    EXPECT_NEAR(normal.dot(t.point(b) - t.point(inside)), 0, 1e-12);
    EXPECT_GT(normal.dot(t.point(n) - t.point(inside)), 0);
}

TEST(Camera, RaysGoThroughThePicture) {
    Camera camera;
    camera.field_of_view = kPi / 2;
    expect_near(view_ray(camera, 0.5, 0.5, 2), {0, 0, -1});
    expect_near(view_ray(camera, 1, 0.5, 2), Vec3d(2, 0, -1).normalized());
    expect_near(view_ray(camera, 0.5, 0, 2), Vec3d(0, 1, -1).normalized());
}

TEST(Camera, LookingAlongUpIsAFrameToo) {
    for (const double y : {1.0, -1.0}) {
        for (const Vec3d& up : {Vec3d(0, 1, 0), Vec3d(1, 0, 0), Vec3d(0, 0, 1)}) {
            Camera camera;
            camera.up = up;
            camera.eye = up * (3 * y);
            const Axes frame = axes(camera);
            expect_near(frame.x.cross(frame.y), frame.z);
            EXPECT_NEAR(frame.x.length(), 1, 1e-12);
            EXPECT_NEAR(frame.x.dot(frame.z), 0, 1e-12);
        }
    }
}

// The ball around the bounds is in the picture, and fills most of its narrower side.
TEST(Camera, FramingShowsTheBall) {
    const Bounds bounds{{-1, 2, 3}, {2, 4, 9}, 2.5};
    for (const double aspect : {0.5, 1.0, 1.78}) {
        const Camera camera = framing(bounds, aspect);
        const double angle = std::asin(bounds.radius / (camera.eye - bounds.centre()).length());
        const double half = std::atan(std::tan(camera.field_of_view / 2) * std::min(1.0, aspect));
        EXPECT_LT(angle, half);
        EXPECT_GT(angle, 0.9 * half);
        expect_near(view_ray(camera, 0.5, 0.5, aspect),
                    (bounds.centre() - camera.eye).normalized());
    }
}

}  // namespace
}  // namespace mirrorball
