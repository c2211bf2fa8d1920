// Which way round: a chart whose sides have colours and letters, reflected in a ball.
//
// The ball is at the origin and the camera on +z. What the ball's middle shows is behind the
// camera, +z; its normal at half the way to the rim (45 degrees) reflects what is at right angles:
// on the right +x, at the top +y. So it is in every mirror: letters are reversed.
#include <gtest/gtest.h>
#include <mirrorball/lookup.h>

#include "gl_test.h"
#include "seen.h"

namespace mirrorball::gl {
namespace {

constexpr int kSize = 128;

class Orientation : public GlTest, public ::testing::WithParamInterface<Method> {
  protected:
    void SetUp() override {
        GlTest::SetUp();
        renderer.emplace(assets_in(chart));
        scene = scene_with("sphere", mirror_material(), GetParam());
        scene.map_size = 64;
        // Far away, so that rays are nearly parallel and a cosine is all there is to it.
        scene.camera = {{0, 0, 50}, {0, 0, 0}, {0, 1, 0}, 2 * std::atan(1.0 / 49)};
    }

    // The colour of a side is nearest to that of its paper, which is what most of it shows.
    static std::string nearest_side(const Vec3f& colour) {
        const std::pair<std::string, Vec3f> sides[] = {
            {"+X", {0.68f, 0.055f, 0.035f}}, {"-X", {0.90f, 0.60f, 0.54f}},
            {"+Y", {0.085f, 0.40f, 0.055f}}, {"-Y", {0.62f, 0.82f, 0.48f}},
            {"+Z", side_colour({0, 0, 1})},  {"-Z", side_colour({0, 0, -1})}};
        const auto found =
            std::min_element(std::begin(sides), std::end(sides), [&](const auto& a, const auto& b) {
                return (a.second - colour).length() < (b.second - colour).length();
            });
        return found->first;
    }

    // The mean around a side's middle.
    static Vec3f side_colour(const Vec3d& d) {
        static const EnvironmentMap map = builtin_environment("axes", 64);
        Vec3f sum(0);
        int count = 0;
        for (double a = -0.3; a <= 0.31; a += 0.1) {
            for (double b = -0.3; b <= 0.31; b += 0.1, ++count)
                sum += look_up(map, d + Vec3d(a, b, 0));
        }
        return sum / static_cast<float>(count);
    }

    const EnvironmentMap& chart = builtin_environment("axes", 256);
    std::optional<Renderer> renderer;
    Scene scene;
};

// The mean of 9 x 9 pixels, so that letters do not count for much.
Vec3f mean_around(const Image& image, double x, double y) {
    Vec3f sum(0);
    for (int j = -4; j <= 4; ++j)
        for (int i = -4; i <= 4; ++i)
            sum += image.rgb(static_cast<int>(x) + i, static_cast<int>(y) + j);
    return sum / 81.0f;
}

TEST_P(Orientation, AMirrorBallShowsEachSideWhereItIs) {
    const Image image = radiance(*renderer, scene, kSize, kSize);
    const double middle = kSize / 2.0, radius = kSize / 2.0 * std::sin(kPi / 4);
    EXPECT_EQ(nearest_side(mean_around(image, middle + radius, middle)), "+X");
    EXPECT_EQ(nearest_side(mean_around(image, middle - radius, middle)), "-X");
    EXPECT_EQ(nearest_side(mean_around(image, middle, middle - radius)), "+Y");
    EXPECT_EQ(nearest_side(mean_around(image, middle, middle + radius)), "-Y");
    EXPECT_EQ(nearest_side(mean_around(image, middle, middle)), "+Z");
}

// Letters included: nothing but the true reflection, not even a mirrored one, comes near.
TEST_P(Orientation, LettersAreReversedAsInAMirror) {
    const Image image = radiance(*renderer, scene, kSize, kSize);
    const SurfaceBuffer buffer = renderer->surfaces(scene, kSize, kSize);
    double error = 0, error_if_turned = 0;
    int count = 0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            if (object_at(buffer, x, y) < 0) continue;
            const Seen seen = seen_at(buffer, x, y, scene.camera.eye);
            // Sphere maps squeeze what is behind the ball into their rim.
            if (seen.n.dot(seen.v) < 0.35) continue;
            const Vec3d r = seen.r();
            error += (image.rgb(x, y) - look_up(chart, r)).length();
            error_if_turned += (image.rgb(x, y) - look_up(chart, {-r.x, r.y, r.z})).length();
            ++count;
        }
    }
    // Edges of letters are blurred by a texel or two, and bent where only vertices know better.
    EXPECT_LT(error / count, 0.12);
    EXPECT_GT(error_if_turned, 3 * error);
}

TEST_P(Orientation, TheBackgroundIsSeenAsItIs) {
    scene.objects.clear();
    scene.camera = {{0, 0, 0}, {0.3, 0.2, -1}, {0.1, 1, 0}, 1};
    const int width = 96, height = 64;
    const Image image = radiance(*renderer, scene, width, height);
    double error = 0, error_if_turned = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const auto seen = [&](double s) {
                return look_up(chart, view_ray(scene.camera, s, (y + 0.5) / height,
                                               static_cast<double>(width) / height));
            };
            error += (image.rgb(x, y) - seen((x + 0.5) / width)).length();
            error_if_turned += (image.rgb(x, y) - seen(1 - (x + 0.5) / width)).length();
        }
    }
    EXPECT_LT(error / (width * height), 0.03);
    EXPECT_GT(error_if_turned, 4 * error);
}

INSTANTIATE_TEST_SUITE_P(Methods, Orientation, ::testing::ValuesIn(all_methods()),
                         [](const auto& method) {
                             std::string text(name(method.param));
                             std::replace(text.begin(), text.end(), '-', '_');
                             return text;
                         });

}  // namespace
}  // namespace mirrorball::gl
