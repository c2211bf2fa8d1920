// Methods that work per pixel, against the equations evaluated at each pixel.
//
// Both see the same place: Renderer::surfaces() has it. Maps are small, so that a pixel sees less
// than a texel and the finest level is looked up; pixels that see more are left out, and
// silhouettes where a pixel's neighbours, which the driver's derivatives come from, see something
// else. What remains is rounding: half floats in textures (2^-11 of the value, about 1/4000 of what
// is shown) and the weights of bilinear filters, for which OpenGL asks of 8 bits only (half of
// 1/256 of the step between texels). Bound: 1/255 of what is shown, after the sRGB curve.
#include <functional>

#include <gtest/gtest.h>
#include <mirrorball/projections/sphere.h>
#include <mirrorball/resample.h>

#include "gl_test.h"
#include "seen.h"
#include "truth_maps.h"
#include "warped_map.h"

namespace mirrorball::gl {
namespace {

constexpr int kWidth = 160, kHeight = 120;
constexpr double kTolerance = 1.0 / 255;

// Beyond the rims of sphere maps and paraboloids the graphics card has texels with what goes on
// there, and the processor looks on the map's other side; a cube's faces that are filtered apart
// have edges where each holds its last texel.
bool near_border(const Scene& scene, const EnvironmentMap& map, const Vec3d& world) {
    const Vec3d d = map.axes.to_map(world).normalized();
    const bool is_sphere = map.projection == Projection::sphere;
    if (is_sphere || map.projection == Projection::dual_paraboloid) {
        const auto place = is_sphere ? SphereMap::project(d) : DualParaboloid::project(d);
        const double to_rim = 0.5 - std::hypot(place.s - 0.5, place.t - 0.5);
        return to_rim * map.width() < 1.5;
    }
    if (scene.method == Method::cube_seams) {
        const FacePoint<double> place = Cube::project(d);
        const double to_edge = std::min({place.s, 1 - place.s, place.t, 1 - place.t});
        return to_edge * map.width() < 0.5;
    }
    return false;
}

struct Comparison {
    double largest = 0;  // of what is shown
    int compared = 0, left_out = 0;
    int x = 0, y = 0;
};

// The most of directions that a pixel may see, from whichever of its neighbours the driver takes.
double footprint(const std::function<Vec3d(int, int)>& direction) {
    const Vec3d d = direction(0, 0);
    double solid_angle = 0;
    for (const int i : {-1, 1}) {
        for (const int j : {-1, 1}) {
            const Vec3d across = direction(i, 0) - d, down = direction(0, j) - d;
            solid_angle = std::max(solid_angle, across.cross(down).length());
        }
    }
    return solid_angle;
}

Comparison compare(Renderer& renderer, const SceneAssets& assets, const Scene& scene) {
    const SurfaceBuffer buffer = renderer.surfaces(scene, kWidth, kHeight);
    const Image drawn = renderer.picture(scene, {kWidth, kHeight, 1, true, {}});
    const ReflectionMaps maps = maps_for(scene, assets.environment);
    const Image expected =
        tone_mapped(shade(scene, assets, maps, buffer), scene.exposure, scene.tone_map);

    // Is it seen finer than the map's texels are, and where both filter in the same way?
    const auto is_magnified = [&](int x, int y, auto direction) {
        const auto looked_up = [&](int i, int j) {
            const Seen seen = seen_at(buffer, x + i, y + j, scene.camera.eye);
            return seen_from_capture(scene.environment, seen.position, direction(seen))
                .normalized();
        };
        const Vec3d d = looked_up(0, 0);
        return footprint(looked_up) < 0.7 * texel_solid_angle(maps.mirror, d) &&
               !near_border(scene, maps.mirror, d);
    };
    const auto is_compared = [&](int x, int y) {
        const int object = object_at(buffer, x, y);
        for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i)
                if (object_at(buffer, x + i, y + j) != object) return false;
        const Material& material = scene.objects[static_cast<std::size_t>(object)].material;
        const auto r = [](const Seen& seen) { return seen.r(); };
        const auto t = [&](const Seen& seen) { return seen.t(material.index); };
        const Vec3d n = seen_at(buffer, x, y, scene.camera.eye).n;
        return (material.mirror + material.glossy == 0 || is_magnified(x, y, r)) &&
               (material.transmission == 0 || is_magnified(x, y, t)) &&
               (material.diffuse == 0 || !near_border(scene, maps.diffuse, n));
    };
    Comparison result;
    for (int y = 1; y + 1 < kHeight; ++y) {
        for (int x = 1; x + 1 < kWidth; ++x) {
            if (object_at(buffer, x, y) < 0) continue;
            if (!is_compared(x, y)) {
                ++result.left_out;
                continue;
            }
            ++result.compared;
            for (int c = 0; c < 3; ++c) {
                const double error =
                    std::abs(srgb(drawn.rgb(x, y)[c]) - srgb(expected.rgb(x, y)[c]));
                if (!(error <= result.largest)) result.largest = error, result.x = x, result.y = y;
            }
        }
    }
    return result;
}

void expect_truth(const Comparison& c, double most_left_out, const std::string& what) {
    EXPECT_LE(c.largest, kTolerance) << what << ": pixel " << c.x << ", " << c.y;
    EXPECT_LE(c.left_out, most_left_out * (c.left_out + c.compared)) << what;
    EXPECT_GT(c.compared, 1000) << what;
}

struct NamedMaterial {
    std::string name;
    Material material;
};

std::vector<NamedMaterial> materials() {
    std::vector<NamedMaterial> all = {{"mirror", mirror_material()},
                                      {"diffuse", diffuse_material()}};
    Material glossy = mirror_material();
    glossy.mirror = 0, glossy.glossy = 1;
    all.push_back({"ggx", glossy});
    glossy.lobe = parse_lobe("phong:40");
    all.push_back({"phong", glossy});
    Material coated = full_material();
    coated.transmission = 0;
    all.push_back({"layered", coated});
    coated.coupling = Coupling::added;
    all.push_back({"added", coated});
    coated.coupling = Coupling::split_sum;
    all.push_back({"split sum", coated});
    Material glass = mirror_material();
    glass.transmission = 1, glass.coupling = Coupling::layered;
    glass.fresnel = Fresnel::dielectric(1.5);
    glass.base_color = {0.8, 1, 0.9};
    all.push_back({"glass", glass});
    return all;
}

class PerPixel : public GlTest, public ::testing::WithParamInterface<Method> {};

// A few materials that have all of the terms, for each method; each takes a program, which a
// processor takes long to compile.
TEST_P(PerPixel, LooksUpWhatItsEquationSays) {
    const auto assets = assets_in(builtin_environment("sunset"));
    Renderer renderer(assets);
    const std::string method(name(GetParam()));
    Scene scene = scene_with("sphere", mirror_material(), GetParam());
    scene.map_size = 16;
    expect_truth(compare(renderer, *assets, scene), 0.16, method + ", mirror");
    scene.objects[0].material = full_material();
    scene.objects[0].material.lobe = parse_lobe("phong:40");
    // What is behind a ball of glass is all near the rim of a sphere map.
    if (GetParam() == Method::sphere) scene.objects[0].material.transmission = 0;
    expect_truth(compare(renderer, *assets, scene), 0.16, method + ", all terms");
}

TEST_P(PerPixel, OfAnythingInARoom) {
    const auto assets = assets_in(smooth_environment());
    Renderer renderer(assets);
    Material material = full_material();
    material.transmission = 0;
    Scene scene = scene_with("torus", material, GetParam());
    scene.objects[0].transform = {{0.1, -0.2, 0.3}, 0.4, 0.5, -0.3, {1, 0.8, 1.2}};
    scene.map_size = 16;
    scene.environment.intensity = 0.7;
    scene.environment.captured_at = {0.5, 0.2, -0.3};
    scene.environment.proxy = BoxProxy{{-3, -2, -4}, {3, 4, 5}};
    expect_truth(compare(renderer, *assets, scene), 0.28, std::string(name(GetParam())));
}

INSTANTIATE_TEST_SUITE_P(Methods, PerPixel,
                         ::testing::Values(Method::cube, Method::sphere, Method::dual_paraboloid,
                                           Method::equirect, Method::octahedral,
                                           Method::cube_seams),
                         [](const auto& method) {
                             std::string text(name(method.param));
                             std::replace(text.begin(), text.end(), '-', '_');
                             return text;
                         });

// What does not depend on how maps are looked up.
class OneMethod : public GlTest {};

TEST_F(OneMethod, EveryMaterialIsItsEquation) {
    const auto assets = assets_in(builtin_environment("sunset"));
    Renderer renderer(assets);
    for (const NamedMaterial& named : materials()) {
        Scene scene = scene_with("sphere", named.material, Method::cube);
        scene.map_size = 16;
        expect_truth(compare(renderer, *assets, scene), 0.08, named.name);
    }
}

TEST_F(OneMethod, EveryToneMap) {
    const auto assets = assets_in(smooth_environment());
    Renderer renderer(assets);
    Scene scene = scene_with("sphere", mirror_material(), Method::cube);
    scene.map_size = 16;
    scene.exposure = 0.4;
    for (const ToneMap tone_map :
         {ToneMap::none, ToneMap::reinhard, ToneMap::aces, ToneMap::agx, ToneMap::film}) {
        scene.tone_map = tone_map;
        expect_truth(compare(renderer, *assets, scene), 0.08, std::string(name(tone_map)));
    }
}

TEST_F(OneMethod, EveryProxy) {
    const auto assets = assets_in(smooth_environment());
    Renderer renderer(assets);
    Scene scene = scene_with("torus", mirror_material(), Method::cube);
    scene.map_size = 16;
    scene.environment.captured_at = {0.5, 0.2, -0.3};
    const std::pair<const char*, Proxy> proxies[] = {
        {"in a ball", SphereProxy{{0.5, 0.5, 0}, 6}},
        // Parts of the torus are outside; some rays from there meet the proxy, others miss it.
        {"half in a box", BoxProxy{{-0.2, -0.3, -3}, {0.8, 0.3, 3}}},
        {"half in a ball", SphereProxy{{1, 0, 0}, 1.5}},
    };
    for (const auto& [what, proxy] : proxies) {
        scene.environment.proxy = proxy;
        expect_truth(compare(renderer, *assets, scene), 0.25, what);
    }
}

TEST_F(OneMethod, InsideABallOfGlass) {
    const auto assets = assets_in(smooth_environment());
    Renderer renderer(assets);
    Material glass = mirror_material();
    glass.transmission = 1, glass.fresnel = Fresnel::dielectric(1.5);
    glass.coupling = Coupling::layered;
    Scene scene = scene_with("sphere", glass, Method::cube);
    scene.map_size = 16;
    scene.camera = {{0.4, 0.2, 0.3}, {2, 1, 1}, {0, 1, 0}, 1.2};
    expect_truth(compare(renderer, *assets, scene), 0.08, "glass");
}

TEST_F(OneMethod, PicturesAndLobesInTheLightOfLamps) {
    const auto assets = assets_in(smooth_environment());
    Image checks(4, 4, 3);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x)
            checks.set_rgb(x, y, (x + y) % 2 ? Vec3f(0.8f, 0.7f, 0.2f) : Vec3f(0.1f, 0.2f, 0.5f));
    assets->pictures["checks"] = checks;
    Renderer renderer(assets);
    Material material = full_material();
    material.transmission = material.mirror = 0;
    material.base_color_map = "checks";
    Scene scene = scene_with("sphere", material, Method::cube);
    scene.map_size = 16;
    scene.lights = {ScenePointLight{{2, 3, 4}, {12, 10, 8}},
                    SceneDirectionalLight{{-2, 1, 0.5}, {0.5, 0.6, 0.9}}};
    const std::pair<const char*, Coupling> cases[] = {{"ggx:0.3", Coupling::layered},
                                                      {"ggx:0.3", Coupling::split_sum},
                                                      {"phong:30", Coupling::added},
                                                      {"blinn-phong:80", Coupling::layered},
                                                      {"charlie:0.5", Coupling::layered}};
    for (const auto& [lobe, coupling] : cases) {
        scene.objects[0].material.lobe = parse_lobe(lobe);
        scene.objects[0].material.coupling = coupling;
        expect_truth(compare(renderer, *assets, scene), 0.08, lobe);
    }
}

}  // namespace
}  // namespace mirrorball::gl
