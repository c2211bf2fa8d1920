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

std::shared_ptr<SceneAssets> assets_with(std::string_view environment, int size = 32) {
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
    scene.objects = {dynamic(ball_at(Vec3d(0)), settings), matte(ball_at({4, 0, 0}), {1, 0, 0})};
    return scene;
}

// Seen so near that every texel of the maps is larger than a pixel: what differs is half floats.
TEST(Dynamic, BallAloneShowsWhatTheEnvironmentsMapShows) {
    const Context context;
    for (const char* environment : {"axes", "sunset"}) {
        Renderer renderer(assets_with(environment));
        Scene scene;
        scene.camera = looking_along_minus_z();
        scene.camera.field_of_view = 0.03;
        for (const Vec3d& eye : {Vec3d(0, 0, 6), Vec3d(4, 4, 3), Vec3d(-6, -1, 0)}) {
            scene.camera.eye = eye;
            scene.objects = {ball_at(Vec3d(0))};
            const Image expected = picture(renderer, scene);
            scene.objects[0].dynamic = DynamicReflection{.size = 32};
            const Image found = picture(renderer, scene);
            EXPECT_LT(rms_difference(found, expected), 2e-3 * rms(expected)) << environment;
        }
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
    Renderer renderer(assets_with("white", 16));
    const Image image = picture(renderer, two_balls({.size = 32}));
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

TEST(Dynamic, ThreeWaysToDrawFacesGiveTheSame) {
    const Context context;
    Renderer renderer(assets_with("sunset"));
    const Image expected = picture(renderer, two_balls({.size = 32}));
    for (const FaceDrawing drawing : {FaceDrawing::copy, FaceDrawing::one_pass}) {
        const Image found = picture(renderer, two_balls({.size = 32, .drawing = drawing}));
        EXPECT_LT(rms_difference(found, expected), 1e-4 * rms(expected)) << name(drawing);
    }
}

TEST(Dynamic, OpenGlEsDrawsTheSameAndRefusesOnePass) {
    Image expected;
    {
        const Context context;
        Renderer renderer(assets_with("sunset"));
        expected = picture(renderer, two_balls({.size = 32}));
    }
    const Context context(Api::es);
    Renderer renderer(assets_with("sunset"));
    for (const FaceDrawing drawing : {FaceDrawing::texture, FaceDrawing::copy}) {
        const Image found = picture(renderer, two_balls({.size = 32, .drawing = drawing}));
        EXPECT_LT(rms_difference(found, expected), 1e-3 * rms(expected)) << name(drawing);
    }
    try {
        (void)picture(renderer, two_balls({.size = 32, .drawing = FaceDrawing::one_pass}));
        FAIL() << "one pass was drawn";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::unsupported);
        EXPECT_NE(std::string(error.what()).find("geometry shader"), std::string::npos);
    }
    // it is still of use
    EXPECT_GT(rms(picture(renderer, two_balls({.size = 32}))), 0);
}

// Every method shows the ball's neighbour, in the same place; how sharply is each one's own.
TEST(Dynamic, EveryMethodShowsTheOtherBall) {
    const Context context;
    Renderer renderer(assets_with("white", 16));
    Scene scene = two_balls({.size = 32});
    for (const Method method : all_methods()) {
        if (method == Method::sphere_stale) continue;  // wrong from here, as it is meant to be
        scene.method = Method::cube;
        const Image expected = picture(renderer, scene);
        scene.method = method;
        const Image found = picture(renderer, scene);
        // most of it is white; what is red is at most 10 % of the picture
        EXPECT_LT(rms_difference(found, expected), 0.06 * rms(expected)) << name(method);
    }
}

// Glossy and matte objects see each other too: a white ball next to a red one gets red on that
// side.
TEST(Dynamic, GlossyAndMatteSurfacesTakeColourFromTheirNeighbours) {
    const Context context;
    Renderer renderer(assets_with("white", 16));
    Scene scene = two_balls({.size = 32});
    scene.objects[1].transform.position = {2.2, 0, 0};
    for (const bool glossy : {true, false}) {
        Material& material = scene.objects[0].material;
        material = {};
        material.mirror = 0;
        material.glossy = glossy ? 1 : 0;
        material.diffuse = glossy ? 0 : 1;
        material.coupling = Coupling::added;
        const Image image = picture(renderer, scene);
        const double half = 6 * std::tan(0.2);
        const auto green = [&](double x) {
            const float* pixel =
                image.at(static_cast<int>((0.5 + 0.5 * x / half) * kSide), kSide / 2);
            return pixel[1] / pixel[0];
        };
        EXPECT_LT(green(0.7), 0.9) << glossy;
        EXPECT_NEAR(green(-0.7), 1, 0.02) << glossy;
    }
}

// Two mirrors, and a matte ball between them that only they can bring to the eye again and again.
Scene facing_mirrors(int bounces) {
    Scene scene;
    scene.camera = looking_along_minus_z();
    scene.camera.eye = {0, 0, 9};
    scene.objects = {dynamic(ball_at({-1.3, 0, 0}), {.size = 32, .bounces = bounces}),
                     dynamic(ball_at({1.3, 0, 0}), {.size = 32, .bounces = bounces})};
    for (SceneObject& object : scene.objects) object.material.fresnel = parse_fresnel("f0=0.8");
    return scene;
}

TEST(Dynamic, EachBounceChangesLessThanTheOneBefore) {
    const Context context;
    Renderer renderer(assets_with("sunset"));
    std::vector<Image> pictures;
    for (const int bounces : {1, 2, 3, 4})
        pictures.push_back(picture(renderer, facing_mirrors(bounces)));
    double before = rms(pictures[0]);
    for (std::size_t i = 1; i < pictures.size(); ++i) {
        const double change = rms_difference(pictures[i], pictures[i - 1]);
        EXPECT_GT(change, 0) << i;
        EXPECT_LT(change, 0.5 * before) << i;
        before = change;
    }
}

// At one bounce a map has the other mirror as it is in the environment alone, whatever that one is.
TEST(Dynamic, OneBounceShowsTheOtherMirrorInTheEnvironment) {
    const Context context;
    Renderer renderer(assets_with("sunset"));
    Scene both = facing_mirrors(1), one = facing_mirrors(1);
    one.objects[1].dynamic.reset();
    // the left ball only
    const Image a = picture(renderer, both), b = picture(renderer, one);
    double largest = 0;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide / 2; ++x)
            largest =
                std::max(largest, static_cast<double>(std::abs(a.at(x, y)[0] - b.at(x, y)[0])));
    }
    EXPECT_EQ(largest, 0);
    EXPECT_GT(rms_difference(a, b), 0);  // the right one differs
}

TEST(Dynamic, TheOrderOfObjectsDoesNotMatter) {
    const Context context;
    Renderer renderer(assets_with("sunset"));
    Scene scene = facing_mirrors(3);
    const Image a = picture(renderer, scene);
    std::swap(scene.objects[0], scene.objects[1]);
    EXPECT_EQ(rms_difference(picture(renderer, scene), a), 0);
}

TEST(Dynamic, SomeFacesPerFrameAreDrawnInTurn) {
    const Context context;
    Renderer renderer(assets_with("sunset"));
    Scene scene = two_balls({.size = 32, .faces_per_frame = 4});
    const Image whole = picture(renderer, scene);
    ASSERT_EQ(renderer.face_updates().size(), 1u);
    EXPECT_EQ(renderer.face_updates()[0].faces, (std::vector<int>{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(rms_difference(picture(renderer, scene), whole), 0);
    EXPECT_EQ(renderer.face_updates()[0].faces, (std::vector<int>{0, 1, 2, 3}));
    EXPECT_EQ(rms_difference(picture(renderer, scene), whole), 0);
    EXPECT_EQ(renderer.face_updates()[0].faces, (std::vector<int>{4, 5, 0, 1}));

    // What moves is seen to have moved once its face's turn has come.
    scene.objects[0].dynamic->faces_per_frame = 1;
    (void)picture(renderer, scene);  // anew: all
    scene.objects[1].transform.position = {-4, 0, 0};
    const Image stale = picture(renderer, scene);  // +x is drawn without the ball
    const Image fresh = picture(renderer, scene);  // and now -x with it
    EXPECT_EQ(renderer.face_updates()[0].faces, (std::vector<int>{1}));
    EXPECT_GT(rms_difference(stale, fresh), 0.01 * rms(fresh));
    scene.objects[0].dynamic->faces_per_frame = 6;
    const Image all = picture(renderer, scene);
    EXPECT_LT(rms_difference(fresh, all), 0.1 * rms_difference(stale, fresh));
}

TEST(Dynamic, MapsAreMadeOncePerPicture) {
    const Context context;
    Renderer renderer(assets_with("sunset"));
    const Scene scene = two_balls({.size = 32, .faces_per_frame = 1});
    PictureOptions options;
    options.width = options.height = 16;
    options.sample_count = 8;
    (void)renderer.picture(scene, options);
    (void)renderer.picture(scene, options);
    EXPECT_EQ(renderer.face_updates()[0].faces, (std::vector<int>{0}));  // one of eight samples
}

TEST(Dynamic, SizesOutOfRangeAreRefusedByName) {
    const Context context;
    Renderer renderer(assets_with("white", 16));
    const auto message = [&](const DynamicReflection& settings) -> std::string {
        try {
            (void)picture(renderer, two_balls(settings), 8);
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), Errc::usage);
            return error.what();
        }
        return "drawn";
    };
    EXPECT_EQ(message({.size = 15}), "the size of a dynamic reflection is from 16 to 4096, not 15");
    EXPECT_EQ(message({.size = 4097}),
              "the size of a dynamic reflection is from 16 to 4096, not 4097");
    EXPECT_EQ(message({.faces_per_frame = 0}),
              "the number of faces per frame is from 1 to 6, not 0");
    EXPECT_EQ(message({.bounces = 9}), "the number of bounces is from 1 to 8, not 9");
    EXPECT_EQ(message({.faces_per_frame = 2, .drawing = FaceDrawing::one_pass}),
              "one-pass draws all six faces of a cube map; for 2 per frame take texture or copy");
}

TEST(Dynamic, MoreThanTheDriverTakesIsRefused) {
    const Context context;
    try {
        (void)make_texture(GL_TEXTURE_CUBE_MAP, 1 << 20, 1 << 20, 1, 6);
        FAIL() << "there is such a driver";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::unsupported);
        EXPECT_NE(std::string(error.what()).find("1048576 x 1048576"), std::string::npos);
    }
    GLint largest = 0, layers = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
    try {
        (void)make_texture(GL_TEXTURE_2D_ARRAY, largest, largest, 1, layers);
        FAIL() << "there is a driver with so much memory";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::unsupported);
        EXPECT_NE(std::string(error.what()).find("GL_OUT_OF_MEMORY"), std::string::npos);
    }
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

}  // namespace
}  // namespace mirrorball::gl
