// No pixel that is no number, and no seam.
#include <gtest/gtest.h>

#include "gl_test.h"
#include "seen.h"

namespace mirrorball::gl {
namespace {

int count_of_non_finite(const Image& image) {
    int count = 0;
    for (const float value : image.values()) count += !std::isfinite(value);
    return count;
}

class EveryMethod : public GlTest, public ::testing::WithParamInterface<Method> {};

TEST_P(EveryMethod, EveryPixelIsANumber) {
    const auto assets = assets_in(smooth_environment());
    Renderer renderer(assets);
    Scene scene = scene_with("", full_material(), GetParam());
    // Lamps take long to compile: once is enough. One lies on a surface.
    if (GetParam() == Method::cube)
        scene.lights = {ScenePointLight{{2, 3, 4}, {12, 10, 8}},
                        ScenePointLight{{0, 0, 1}, {1, 1, 1}}};
    const auto check = [&](const std::string& what) {
        const Image image = radiance(renderer, scene, 96, 72);
        EXPECT_EQ(count_of_non_finite(image), 0) << what;
        const auto brightest = std::max_element(image.values().begin(), image.values().end());
        EXPECT_GT(*brightest, 0.5) << what;
    };
    for (const BuiltinMesh& mesh : builtin_meshes()) {
        scene.objects[0].mesh = mesh.name;
        check(mesh.name);
    }
    scene.objects[0].mesh = "sphere";
    scene.camera = {{0.2, 0.3, 0.1}, {1, 1, 1}, {0, 1, 0}, 1};
    check("from within");
    // What is looked up lies on axes, edges and corners, poles and rims.
    scene.camera = {{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 0.5};
    check("from the front");
    scene.camera = {{0, 4, 0}, {0, 0, 0}, {0, 1, 0}, 0.5};
    check("from above");
    scene.objects[0].mesh = "plane";
    scene.camera = {{4, 0, 0}, {0, 0, 0}, {0, 1, 0}, 0.5};
    check("edge on");
}

// Files have them: triangles that are points or lines, normals of no length.
TEST_P(EveryMethod, BrokenMeshesShowNumbersToo) {
    const auto assets = assets_in(smooth_environment());
    Mesh& mesh = assets->meshes["broken"];
    mesh.positions = {{0, 0, 0},   {0, 0, 0},  {0, 0, 0}, {-1, -1, 0}, {1, 1, 0}, {0, 0, 0},
                      {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {-1, 0, 1},  {1, 0, 1}, {0, -1, 1}};
    mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
    for (const std::size_t i : {6, 7, 8}) mesh.normals[i] = {0, 0, 0};
    mesh.normals[9] = {0, 0, -1};  // cancels with the others somewhere on the triangle
    for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) mesh.indices.push_back(i);
    Renderer renderer(assets);
    const Scene scene = scene_with("broken", full_material(), GetParam());
    EXPECT_EQ(count_of_non_finite(radiance(renderer, scene, 96, 72)), 0);
    EXPECT_EQ(count_of_non_finite(renderer.surfaces(scene, 96, 72).normal), 0);
}

// In light without an edge the largest step from a pixel to its neighbour is what the reflection
// vector's own is, plus what bilinear filters make of it: they are linear within a texel, so a step
// is at most the steepest one nearby.
TEST_P(EveryMethod, LightWithoutEdgesShowsNone) {
    const auto assets = assets_in(smooth_environment());
    Renderer renderer(assets);
    const int width = 320, height = 240;
    double most_over_direct = 0;
    for (const char* mesh : {"sphere", "torus"}) {
        Scene scene = scene_with(mesh, mirror_material(), GetParam());
        // Next to the others' texels those of old cubes have to be large, so that edges show.
        scene.map_size = GetParam() == Method::cube_seams ? 16 : 32;
        const SurfaceBuffer buffer = renderer.surfaces(scene, width, height);
        const Image image = radiance(renderer, scene, width, height);
        double largest = 0, largest_direct = 0;
        const auto compare = [&](int x0, int y0, int x1, int y1) {
            const int object = object_at(buffer, x0, y0);
            if (object < 0 || object_at(buffer, x1, y1) != object) return;
            const Seen a = seen_at(buffer, x0, y0, scene.camera.eye),
                       b = seen_at(buffer, x1, y1, scene.camera.eye);
            // Not where the surface turns away, and each pixel sees much of it.
            if (std::min(a.n.dot(a.v), b.n.dot(b.v)) < 0.3) return;
            if ((a.position - b.position).length() > 0.1) return;  // one part hides another
            largest = std::max<double>(largest, (image.rgb(x0, y0) - image.rgb(x1, y1)).length());
            largest_direct =
                std::max(largest_direct, (smooth_light(a.r()) - smooth_light(b.r())).length());
        };
        for (int y = 0; y + 1 < height; ++y) {
            for (int x = 0; x + 1 < width; ++x) {
                compare(x, y, x + 1, y);
                compare(x, y, x, y + 1);
            }
        }
        most_over_direct = std::max(most_over_direct, largest / largest_direct);
    }
    switch (GetParam()) {
        case Method::cube:
        case Method::dual_paraboloid:
        case Method::equirect:
            EXPECT_LE(most_over_direct, 1.05);
            break;
        case Method::octahedral:
            // steeper, by a quarter of a texel, where rows of texels turn at a fold
            EXPECT_LE(most_over_direct, 1.25);
            break;
        case Method::cube_seams:
            EXPECT_GE(most_over_direct, 1.25) << "its seams are what it is there to show";
            break;
        default:
            break;  // seams at a sphere map's rim, and kinks between triangles, are the method's
                    // own
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod, ::testing::ValuesIn(all_methods()),
                         [](const auto& method) {
                             std::string text(name(method.param));
                             std::replace(text.begin(), text.end(), '-', '_');
                             return text;
                         });

}  // namespace
}  // namespace mirrorball::gl
