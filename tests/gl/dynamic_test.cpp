// Reflections made anew for each picture: what objects see of each other.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include <mirrorball/builtin.h>
#include <mirrorball/compare.h>
#include <mirrorball/error.h>
#include <mirrorball/gl/context.h>
#include <mirrorball/gl/renderer.h>
#include <mirrorball/lookup.h>
#include <mirrorball/resample.h>

#include "gl/texture.h"

namespace mirrorball::gl {
namespace {

constexpr int kSide = 64;

std::shared_ptr<SceneAssets> assets_with(std::string_view environment, int size = 64) {
    auto assets = std::make_shared<SceneAssets>();
    assets->environment =
        make_builtin(environment, Projection::cube, size, default_axes(Projection::cube));
    for (const char* mesh : {"sphere", "plane", "cube"}) assets->meshes[mesh] = make_mesh(mesh, 24);
    return assets;
}

SceneObject ball_at(const Vec3d& position, double radius = 1) {
    SceneObject ball;
    ball.transform.position = position;
    ball.transform.scale = Vec3d(radius);
    return ball;
}

SceneObject matte(SceneObject object, const Vec3d& color) {
    object.material.mirror = 0;
    object.material.diffuse = 1;
    object.material.base_color = color;
    object.material.coupling = Coupling::added;
    return object;
}

SceneObject dynamic(SceneObject object, const DynamicReflection& settings) {
    object.dynamic = settings;
    return object;
}

Image picture(Renderer& renderer, const Scene& scene, int side = kSide) {
    PictureOptions options;
    options.width = options.height = side;
    options.sample_count = 1;
    options.display = false;
    return renderer.picture(scene, options);
}

double rms(const Image& image) {
    double sum = 0;
    for (const float value : image.values()) sum += static_cast<double>(value) * value;
    return std::sqrt(sum / static_cast<double>(image.values().size()));
}

double rms_difference(const Image& a, const Image& b) {
    Image difference = a;
    for (std::size_t i = 0; i < a.values().size(); ++i) difference.values()[i] -= b.values()[i];
    return rms(difference);
}

Camera looking_along_minus_z() {
    Camera camera;
    camera.eye = {0, 0, 6};
    camera.field_of_view = 0.4;
    return camera;
}

// A mirror ball with a red ball to its right.
Scene two_balls(const DynamicReflection& settings) {
    Scene scene;
    scene.camera = looking_along_minus_z();
    scene.objects = {dynamic(ball_at(Vec3d(0)), settings),
                     matte(ball_at({4, 0, 0}), {1, 0, 0})};
    return scene;
}

TEST(Dynamic, BallAloneShowsWhatTheEnvironmentsMapShows) {
    const Context context;
    for (const char* environment : {"axes", "sunset"}) {
        Renderer renderer(assets_with(environment));
        Scene scene;
        scene.camera = looking_along_minus_z();
        scene.objects = {ball_at(Vec3d(0))};
        const Image expected = picture(renderer, scene);
        scene.objects[0].dynamic = DynamicReflection{.size = 64};
        const Image found = picture(renderer, scene);
        // Of one size, each texel is one of the other's: 2^-11 of half floats, and mip levels that
        // are smoothed more at the rim, where much is seen in one pixel.
        EXPECT_LT(rms_difference(found, expected), 0.02 * rms(expected)) << environment;
    }
}

TEST(Dynamic, CapturedMapIsTheEnvironmentTexelByTexel) {
    const Context context;
    const auto assets = assets_with("axes", 32);
    Renderer renderer(assets);
    const EnvironmentMap map = renderer.capture(Scene{}, {1, 2, 3}, 32);
    EXPECT_EQ(map.axes, assets->environment.axes);
    // half floats: 2^-11
    EXPECT_LT(compare(map, assets->environment).maximum_relative, 1e-3);
}

TEST(Dynamic, ObjectToTheRightIsSeenOnTheRight) {
    const Context context;
    Renderer renderer(assets_with("white"));
    const Image image = picture(renderer, two_balls({.size = 64}));
    // r = +x where the normal is halfway between +x and the eye: at x = sin 45 of the ball
    const auto is_red = [&](double x, double y) {
        const double half = 6 * std::tan(0.2);
        const float* pixel = image.at(static_cast<int>((0.5 + 0.5 * x / half) * kSide),
                                      static_cast<int>((0.5 - 0.5 * y / half) * kSide));
        return pixel[1] < 0.5f * pixel[0];
    };
    EXPECT_TRUE(is_red(0.72, 0));
    EXPECT_FALSE(is_red(-0.72, 0));
    EXPECT_FALSE(is_red(0, 0.72));
    EXPECT_FALSE(is_red(0, -0.72));
    EXPECT_FALSE(is_red(0, 0));
}

}  // namespace
}  // namespace mirrorball::gl
