// Methods that work per vertex, each in its two ways.
#include <gtest/gtest.h>
#include <mirrorball/projections/cube.h>

#include "gl_test.h"
#include "seen.h"

namespace mirrorball::gl {
namespace {

constexpr int kWidth = 160, kHeight = 120;

struct Differences {
    int covered = 0, differing = 0;
    double largest = 0, mean = 0;  // of what is shown
    double farthest = 0;  // from the map's border to the place that a pixel that differs looks up
};

class PerVertex : public GlTest {
  protected:
    /// `to_border` tells how far a direction is from where the two ways may differ.
    template <class Distance>
    Differences between(const std::string& mesh, const Material& material, Method a, Method b,
                        Distance to_border) {
        const auto assets = assets_in(smooth_environment());
        // So fine that what is interpolated is nearly what a pixel would find.
        assets->meshes[mesh] = make_mesh(mesh, 64);
        Renderer renderer(assets);
        Scene scene = scene_with(mesh, material, a);
        scene.map_size = kMapSize;
        const SurfaceBuffer buffer = renderer.surfaces(scene, kWidth, kHeight);
        const Image first = renderer.picture(scene, {kWidth, kHeight, 1, true, {}});
        scene.method = b;
        const Image second = renderer.picture(scene, {kWidth, kHeight, 1, true, {}});
        const Axes map = default_axes(projection_of(a));
        Differences result;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                if (object_at(buffer, x, y) < 0) {
                    EXPECT_EQ(first.rgb(x, y), second.rgb(x, y)) << x << ", " << y;
                    continue;
                }
                ++result.covered;
                double error = 0;
                for (int c = 0; c < 3; ++c)
                    error = std::max(
                        error, std::abs(srgb(first.rgb(x, y)[c]) - srgb(second.rgb(x, y)[c])));
                result.largest = std::max(result.largest, error);
                result.mean += error;
                if (error < kRounding) continue;
                ++result.differing;
                // Where a triangle turns away, what it reflects is nothing like linear.
                const Seen seen = seen_at(buffer, x, y, scene.camera.eye);
                if (seen.n.dot(seen.v) > 0.3)
                    result.farthest = std::max(result.farthest, to_border(map.to_map(seen.r())));
            }
        }
        result.mean /= result.covered;
        return result;
    }

    // So coarse that what is seen is magnified: how each way finds a level does not matter.
    static constexpr int kMapSize = 8;
    // Less than a step of a screen. Where a surface turns away, a pixel sees more than a texel, and
    // how much of the next level is mixed in is up to the driver, apart for cubes and plain
    // textures.
    static constexpr double kRounding = 1.0 / 255;
};

// Where r passes from one map to the other, one pass decides by r_z at the pixel and two passes by
// the front map's disc. Both say the same of a unit r; the interpolated one is a little shorter, by
// 1 % in a mesh's triangles as wide as 1/6 radian between reflections. In between both maps hold
// the same light.
TEST_F(PerVertex, TwoPassesShowWhatOneDoes) {
    for (const char* mesh : {"sphere", "torus"}) {
        const Differences d =
            between(mesh, mirror_material(), Method::dual_paraboloid_vertex,
                    Method::dual_paraboloid_passes, [](const Vec3d& r) { return std::abs(r.z); });
        EXPECT_GT(d.covered, 2000);
        EXPECT_LE(d.farthest, 0.02) << mesh;
        EXPECT_LE(d.largest, 3.0 / 255) << mesh;
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
                holes += object_at(buffer, x, y) >= 0 && image.rgb(x, y).x > 50;
        EXPECT_EQ(holes, 0) << mesh;
    }
}

// In texels of a cube's face, to its border.
double texels_to_border(const Vec3d& r, int size) {
    const FacePoint<double> place = Cube::project(r);
    return size * std::min({place.s, 1 - place.s, place.t, 1 - place.t});
}

// On a piece of a polygon the plain texture of one face shows what the cube map does, except that
// beyond the centres of the outermost texels it holds their values: half a texel from the border, a
// whole one where the next level is mixed in. (Interpolated, r points a little elsewhere than at
// the pixel: some tenths of a texel.) There it may be off by what the light changes in half a
// texel, 1/8 radian times 0.6.
TEST_F(PerVertex, SplitPolygonsShowWhatTheCubeMapDoes) {
    Material coated = full_material();
    coated.transmission = coated.glossy = 0;
    for (const auto& [mesh, material] :
         {std::pair{"sphere", mirror_material()}, std::pair{"torus", mirror_material()},
          std::pair{"cube", mirror_material()}, std::pair{"sphere", coated}}) {
        const Differences d = between(mesh, material, Method::cube_vertex, Method::cube_split,
                                      [](const Vec3d& r) { return texels_to_border(r, kMapSize); });
        EXPECT_GT(d.covered, 2000);
        EXPECT_LE(d.farthest, 1.3) << mesh;
        EXPECT_LE(d.largest, 0.075) << mesh;
    }
}

// Many small triangles: what is linear over each is the truth in the limit. With four times the
// vertices each way the error of a quadratic is a sixteenth; what levels and seams differ by stays.
TEST_F(PerVertex, FinerMeshesComeNearerToPerPixel) {
    const auto assets = assets_in(smooth_environment());
    for (const int detail : {4, 16})
        assets->meshes["sphere " + std::to_string(detail)] = make_mesh("sphere", detail);
    Renderer renderer(assets);
    const auto error = [&](int detail, Method per_vertex, Method per_pixel) {
        Scene scene = scene_with("sphere " + std::to_string(detail), mirror_material(), per_vertex);
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
        EXPECT_LT(fine, coarse / 4) << name(per_vertex);
    }
}

}  // namespace
}  // namespace mirrorball::gl
