// Methods that work per vertex, each in its two ways.
#include <gtest/gtest.h>
#include <mirrorball/projections/dual_paraboloid.h>

#include "gl_test.h"
#include "truth.h"

namespace mirrorball::gl {
namespace {

constexpr int kWidth = 160, kHeight = 120;

struct Differences {
    int covered = 0, differing = 0;
    double largest = 0, mean = 0;  // of what is shown
};

class PerVertex : public GlTest {
  protected:
    Differences between(const std::string& mesh, const Material& material, Method a, Method b) {
        const auto assets = assets_in(smooth_environment());
        Renderer renderer(assets);
        Scene scene = scene_with(mesh, material, a);
        const SurfaceBuffer buffer = renderer.surfaces(scene, kWidth, kHeight);
        const Image first = renderer.picture(scene, {kWidth, kHeight, 1, true, {}});
        scene.method = b;
        const Image second = renderer.picture(scene, {kWidth, kHeight, 1, true, {}});
        Differences result;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                if (*buffer.object.at(x, y) < 0) {
                    EXPECT_EQ(first.rgb(x, y), second.rgb(x, y)) << x << ", " << y;
                    continue;
                }
                ++result.covered;
                double error = 0;
                for (int c = 0; c < 3; ++c)
                    error = std::max(error, std::abs(srgb(first.rgb(x, y)[c]) -
                                                     srgb(second.rgb(x, y)[c])));
                result.differing += error > 1e-5;
                result.largest = std::max(result.largest, error);
                result.mean += error;
            }
        }
        result.mean /= result.covered;
        if (getenv("VERBOSE")) printf("%s %s: covered %d differing %d largest %.4f mean %.6f\n", mesh.c_str(), std::string(name(b)).c_str(), result.covered, result.differing, result.largest, result.mean);
        return result;
    }
};

// Where r passes from one map to the other, the one pass decides by r_z at the pixel and two passes
// by the front map's disc, which is the same but for rounding; then both maps hold the same light.
TEST_F(PerVertex, TwoPassesShowWhatOneDoes) {
    for (const char* mesh : {"sphere", "torus", "teapot"}) {
        const Differences d = between(mesh, mirror_material(), Method::dual_paraboloid_vertex,
                                      Method::dual_paraboloid_passes);
        EXPECT_GT(d.covered, 2000);
        EXPECT_LE(d.differing, d.covered / 50) << mesh;
        EXPECT_LE(d.largest, 2.0 / 255) << mesh;
    }
}

// Nothing shows through: where no pass draws, the background would be seen, here a colour that the
// light does not have.
TEST_F(PerVertex, TwoPassesLeaveNoHoles) {
    const auto assets = assets_in(smooth_environment());
    Renderer renderer(assets);
    for (const char* mesh : {"sphere", "torus", "teapot", "cube"}) {
        Scene scene = scene_with(mesh, mirror_material(), Method::dual_paraboloid_passes);
        scene.environment.background = false;
        scene.environment.background_color = {100, 0, 100};
        const SurfaceBuffer buffer = renderer.surfaces(scene, kWidth, kHeight);
        const Image image = radiance(renderer, scene, kWidth, kHeight);
        int holes = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                holes += *buffer.object.at(x, y) >= 0 && image.rgb(x, y).x > 50;
        EXPECT_EQ(holes, 0) << mesh;
    }
}

// On a piece of a polygon the plain texture of one face shows what the cube map does, except that
// at the face's edge it holds its last texel: half a texel of 32 on each side of an edge, a share of
// 6 % of a face. The light's slope is at most 0.6 for a radian, a texel's width 1/16 radian.
TEST_F(PerVertex, SplitPolygonsShowWhatTheCubeMapDoes) {
    for (const char* mesh : {"sphere", "torus", "teapot", "cube"}) {
        const Differences d =
            between(mesh, mirror_material(), Method::cube_vertex, Method::cube_split);
        EXPECT_GT(d.covered, 1000);
        EXPECT_LE(d.differing, d.covered / 5) << mesh;
        EXPECT_LE(d.largest, 0.03) << mesh;
        EXPECT_LE(d.mean, 0.001) << mesh;
    }
}

TEST_F(PerVertex, SplitPolygonsOfEveryMaterial) {
    Material material = full_material();
    material.transmission = 0;
    const Differences d = between("sphere", material, Method::cube_vertex, Method::cube_split);
    EXPECT_LE(d.largest, 0.03);
    EXPECT_LE(d.mean, 0.001);
}

// Many small triangles: what is linear over each is the truth in the limit. With four times the
// vertices each way the error of a quadratic is a sixteenth.
TEST_F(PerVertex, FinerMeshesComeNearerToPerPixel) {
    const auto assets = assets_in(smooth_environment());
    for (const int detail : {4, 16})
        assets->meshes["sphere " + std::to_string(detail)] = make_mesh("sphere", detail);
    Renderer renderer(assets);
    const auto error = [&](int detail, Method per_vertex, Method per_pixel) {
        Scene scene =
            scene_with("sphere " + std::to_string(detail), mirror_material(), per_vertex);
        scene.environment.background = false;
        const Image a = radiance(renderer, scene, kWidth, kHeight);
        scene.method = per_pixel;
        const Image b = radiance(renderer, scene, kWidth, kHeight);
        double sum = 0;
        for (std::size_t i = 0; i < a.values().size(); ++i)
            sum += std::abs(a.values()[i] - b.values()[i]);
        return sum;
    };
    for (const auto& [per_vertex, per_pixel] :
         {std::pair{Method::cube_vertex, Method::cube}, std::pair{Method::cube_split, Method::cube},
          std::pair{Method::dual_paraboloid_vertex, Method::dual_paraboloid},
          std::pair{Method::dual_paraboloid_passes, Method::dual_paraboloid},
          std::pair{Method::sphere_vertex, Method::sphere}}) {
        const double coarse = error(4, per_vertex, per_pixel);
        const double fine = error(16, per_vertex, per_pixel);
        EXPECT_GT(coarse, 0) << name(per_vertex);
        EXPECT_LT(fine, coarse / 6) << name(per_vertex);
        if (getenv("VERBOSE")) printf("%s coarse %f fine %f\n", std::string(name(per_vertex)).c_str(), coarse, fine);
    }
}

}  // namespace
}  // namespace mirrorball::gl
