// Bump mapping, section 7 of the survey: against the equations, pixel by pixel, and by its laws.
//
// Where the renderer and the equations differ: half floats in textures (2^-11 of a slope), the
// weights of bilinear filters, for which OpenGL asks of 8 bits only (1/256 of the step between
// texels, of slopes and of what is reflected), and the texels of light maps.
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mirrorball/bump.h>
#include <mirrorball/error.h>
#include <mirrorball/projections/sphere.h>

#include "bumpy_assets.h"
#include "gl_test.h"
#include "seen.h"
#include "truth_maps.h"

namespace mirrorball::gl {
namespace {

constexpr int kWidth = 160, kHeight = 120;

std::shared_ptr<const BumpTexels> texels_of(const HeightMap& relief) {
    Image heights(1, 1, 1);
    *heights.at(0, 0) = 1;
    return std::make_shared<const BumpTexels>(BumpTexels{slopes(relief), heights});
}

BumpMap bump_of(const std::string& source, int size = 64) {
    BumpMap bump;
    bump.source = source;
    bump.size = size;
    bump.repeat = {2, 1};
    bump.filter = BumpFilter::none;
    return bump;
}

Scene bumpy_scene(const std::string& mesh, Material material, Method method, const BumpMap& bump) {
    material.bump = bump;
    Scene scene = scene_with(mesh, material, method);
    scene.map_size = 16;
    return scene;
}

void expect_same_bits(const Image& a, const Image& b, const std::string& what) {
    ASSERT_EQ(a.values().size(), b.values().size()) << what;
    EXPECT_TRUE(std::equal(a.values().begin(), a.values().end(), b.values().begin())) << what;
}

struct Difference {
    double largest = 0, mean = 0;  // of what is shown, 0 to 1
    double largest_linear = 0;     // of the same as linear light
    int compared = 0, left_out = 0;

    void add(const Image& drawn, const Image& expected, int x, int y) {
        ++compared;
        for (int c = 0; c < 3; ++c) {
            const double error = std::abs(srgb(drawn.rgb(x, y)[c]) - srgb(expected.rgb(x, y)[c]));
            if (!(error <= largest)) largest = error;
            largest_linear = std::max<double>(largest_linear,
                                              std::abs(drawn.rgb(x, y)[c] - expected.rgb(x, y)[c]));
            mean += (error - mean) / (3.0 * compared - 2 + c);
        }
    }
};

// Is the place on a sphere map so far inside that its rim does not matter?
bool is_inside(const EnvironmentMap& map, const Vec3d& direction, double margin) {
    const FacePoint<double> place = SphereMap::project(map.axes.to_map(direction));
    return std::hypot(place.s - 0.5, place.t - 0.5) < 0.5 - margin;
}

// Next to silhouettes derivatives, and so levels, may be those of something else; sphere maps and
// paraboloids differ at their rims, see per_pixel_test.cpp.
Difference compare(Renderer& renderer, const SceneAssets& assets, const Scene& scene,
                   double rim_margin = 0) {
    const SurfaceBuffer buffer = renderer.surfaces(scene, kWidth, kHeight);
    const Image drawn = renderer.picture(scene, {kWidth, kHeight, 1, true, {}});
    const ReflectionMaps maps = maps_for(scene, assets.environment);
    const Image expected =
        tone_mapped(shade(scene, assets, maps, buffer), scene.exposure, scene.tone_map);
    Difference result;
    for (int y = 1; y + 1 < kHeight; ++y) {
        for (int x = 1; x + 1 < kWidth; ++x) {
            const int object = object_at(buffer, x, y);
            if (object < 0) continue;
            const bool at_silhouette =
                object_at(buffer, x - 1, y) != object || object_at(buffer, x + 1, y) != object ||
                object_at(buffer, x, y - 1) != object || object_at(buffer, x, y + 1) != object;
            const bool at_rim =
                rim_margin > 0 &&
                !is_inside(maps.mirror, seen_at(buffer, x, y, scene.camera.eye).r(), rim_margin);
            if (at_silhouette || at_rim) {
                ++result.left_out;
            } else {
                result.add(drawn, expected, x, y);
            }
        }
    }
    return result;
}

class Bump : public GlTest {};

// Every method that can, each form, with all terms and a light.
TEST_F(Bump, FlatOnesChangeNoBit) {
    Material material = full_material();
    for (const BumpForm form : {BumpForm::normals, BumpForm::classic}) {
        BumpMap flat = bump_of("flat"), still = bump_of("hammered"), unmoved = still;
        for (BumpMap* bump : {&flat, &still, &unmoved}) {
            bump->form = form;
            bump->filter = form == BumpForm::normals ? BumpFilter::variance : BumpFilter::mean;
        }
        still.strength = 0;
        unmoved.matrix = Imath::M22d(0, 0, 0, 0);
        const auto assets = bumpy_assets(smooth_environment(), {flat, still});
        Renderer renderer(assets);
        for (const Method method : all_methods()) {
            if (!can_show(method, flat)) continue;
            const std::string what = fmt::format("{}, {}", name(method), name(form));
            Scene scene = bumpy_scene("torus", material, method, {});
            // The light map is another way to get at the light of lights.
            if (form == BumpForm::normals) scene.lights = {ScenePointLight{{2, 3, 4}, {9, 8, 7}}};
            const Image smooth = radiance(renderer, scene, kWidth, kHeight);
            const auto with = [&](const BumpMap& bump) {
                scene.objects[0].material.bump = bump;
                return radiance(renderer, scene, kWidth, kHeight);
            };
            expect_same_bits(with(flat), smooth, what + ": flat");
            expect_same_bits(with(still), smooth, what + ": strength 0");
            if (form == BumpForm::classic)
                expect_same_bits(with(unmoved), smooth, what + ": matrix 0");
            BumpMap relief = flat;
            relief.relief = 0.3;
            expect_same_bits(with(relief), smooth, what + ": a relief of level heights");
        }
    }
}

class BumpByNormals : public GlTest, public ::testing::WithParamInterface<Method> {};

TEST_P(BumpByNormals, PerturbsReflectsAndLooksUp) {
    const BumpMap bump = bump_of("hammered");
    const auto assets = bumpy_assets(smooth_environment(), {bump});
    Renderer renderer(assets);
    Material material = full_material();
    if (projection_of(GetParam()) != Projection::cube) material.transmission = 0;
    Scene scene = bumpy_scene("torus", material, GetParam(), bump);
    scene.objects[0].transform = {{0.1, -0.1, 0}, 0.4, 0.5, -0.3, {1, -0.8, 1.2}};  // mirrored
    scene.lights = {ScenePointLight{{2, 3, 4}, {9, 8, 7}}};
    const bool has_rim = projection_of(GetParam()) == Projection::sphere;
    const Difference d = compare(renderer, *assets, scene, has_rim ? 0.1 : 0);
    // A hundredth of pixels, where dents meet, has slopes that differ much from texel to texel.
    EXPECT_LT(d.mean, 0.25 / 255);
    EXPECT_LT(d.largest, 4.0 / 255);
    EXPECT_GT(d.compared, 3000);
    EXPECT_LT(d.left_out, (has_rim ? 0.9 : 0.35) * d.compared);
    RecordProperty("mean_255", fmt::format("{:.3f}", 255 * d.mean));
    RecordProperty("largest_255", fmt::format("{:.3f}", 255 * d.largest));
}

INSTANTIATE_TEST_SUITE_P(Methods, BumpByNormals,
                         ::testing::Values(Method::cube, Method::cube_seams, Method::sphere,
                                           Method::dual_paraboloid, Method::equirect,
                                           Method::octahedral),
                         [](const auto& test) {
                             std::string text(name(test.param));
                             for (char& c : text) c = c == '-' ? '_' : c;
                             return text;
                         });

// Light whose radiance tells the direction that it comes from.
EnvironmentMap directions() {
    return sampled(Projection::cube, 64,
                   [](const Vec3d& d) { return Vec3d(1) + d.normalized() * 0.5; });
}

TEST_F(Bump, ARampTiltsTheNormalByItsAngle) {
    for (const auto& [du, dv] : {std::pair{0.3, 0.0}, {0.0, -0.25}, {-0.1, 0.2}}) {
        HeightMap ramp{Image(8, 8, 1), 1, 1, Wrap::clamp};
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x)  // y upwards
                *ramp.heights.at(x, y) = static_cast<float>((du * x - dv * y) / 8);
        BumpMap bump = bump_of("ramp");
        bump.wrap = Wrap::clamp;
        bump.horizon = false;
        const auto assets = bumpy_assets(directions(), {});
        assets->bumps[bump_key(bump)] = texels_of(ramp);
        Renderer renderer(assets);
        Scene scene = bumpy_scene("plane", mirror_material(), Method::cube, bump);
        scene.map_size = 64;
        scene.camera = {{0.2, 4, 0.3}, {0.2, 0, 0.3}, {0, 0, -1}, 0.3};
        const SurfaceBuffer buffer = renderer.surfaces(scene, 16, 16);
        const Image drawn = radiance(renderer, scene, 16, 16);
        // The plane's texture has s along x and t along z, so that the frame is x, -z, y.
        const Vec3d n = Vec3d(-du, 1, dv).normalized();
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 16; ++x) {
                const Vec3d v = (scene.camera.eye - Vec3d(buffer.position.rgb(x, y))).normalized();
                const Vec3d found = ((Vec3d(drawn.rgb(x, y)) - Vec3d(1)) * 2).normalized();
                const Vec3d half = (found + v).normalized();
                // Half floats of radiance above 1 are 2^-10 apart, a step of 2e-3 in each component
                // of the direction, half of that off at most; the normal turns by half as much.
                EXPECT_LT(std::acos(std::min(1.0, half.dot(n))), 1.5e-3)
                    << du << ", " << dv << " at " << x << ", " << y;
            }
        }
    }
}

TEST_F(Bump, TilesHaveNoSeam) {
    for (const char* source : {"noise", "waves", "bark"}) {
        BumpMap bump = bump_of(source, 32);
        bump.repeat = {3, 3};
        const auto assets = bumpy_assets(smooth_environment(), {bump});
        Renderer renderer(assets);
        Scene scene = bumpy_scene("plane", mirror_material(), Method::cube, bump);
        scene.camera = {{0, 6, 0}, {0, 0, 0}, {0, 0, -1}, 0.4};
        constexpr int kSize = 192;
        const SurfaceBuffer buffer = renderer.surfaces(scene, kSize, kSize);
        const Image drawn = radiance(renderer, scene, kSize, kSize);
        double at_edges = 0, inside = 0;
        int edge_count = 0, inside_count = 0;
        for (int y = 0; y < kSize; ++y) {
            for (int x = 1; x < kSize; ++x) {
                if (object_at(buffer, x - 1, y) < 0 || object_at(buffer, x, y) < 0) continue;
                const double before = 3 * buffer.texture_coordinates.at(x - 1, y)[0],
                             here = 3 * buffer.texture_coordinates.at(x, y)[0];
                const double step = std::abs(drawn.rgb(x, y).y - drawn.rgb(x - 1, y).y);
                if (std::floor(before) != std::floor(here)) {
                    at_edges += step * step, ++edge_count;
                } else {
                    inside += step * step, ++inside_count;
                }
            }
        }
        ASSERT_GT(edge_count, 300) << source;
        // Of 64 rows at an edge, against all: a step there is no larger than anywhere.
        EXPECT_LT(std::sqrt(at_edges / edge_count), 2 * std::sqrt(inside / inside_count)) << source;
    }
}

class ClassicBump : public GlTest {};

TEST_F(ClassicBump, MovesPlacesOnSphereMapsByItsMatrix) {
    BumpMap bump = bump_of("hammered");
    bump.form = BumpForm::classic;
    const auto assets = bumpy_assets(smooth_environment(), {bump});
    Renderer renderer(assets);
    Material material = full_material();
    material.transmission = 0;
    const std::pair<const char*, Imath::M22d> matrices[] = {
        {"as normals would", {-0.5, 0, 0, -0.5}},
        {"turned", {0.1, -0.3, 0.25, 0.05}},
        {"along s alone", {0.2, 0, 0, 0}},
    };
    for (const auto& [what, matrix] : matrices) {
        bump.matrix = matrix;
        for (const double scale : {0.0, 0.8}) {
            bump.luminance_scale = scale, bump.luminance_offset = 1 - scale;
            const Scene scene = bumpy_scene("sphere", material, Method::sphere, bump);
            const Difference d = compare(renderer, *assets, scene, 0.2);
            EXPECT_LT(d.mean, 0.3 / 255) << what;
            EXPECT_LT(d.largest, 4.0 / 255) << what;
            EXPECT_GT(d.compared, 1500) << what;
        }
    }
}

// Of the light map, with lights of both kinds that turn.
TEST_F(ClassicBump, LightsComeFromALightMap) {
    BumpMap bump = bump_of("hammered");
    bump.form = BumpForm::classic;
    const auto assets = bumpy_assets(smooth_environment(), {bump});
    Material material = full_material();
    material.transmission = material.mirror = material.emission = 0;
    for (const char* lobe : {"phong:30", "ggx:0.4"}) {
        material.lobe = parse_lobe(lobe);
        Scene scene = bumpy_scene("sphere", material, Method::sphere, bump);
        scene.environment.intensity = 0;
        scene.lights = {ScenePointLight{{3, 2, 3}, {18, 15, 12}, 0.6},
                        SceneDirectionalLight{{-1, 1, 1}, {0.2, 0.3, 0.6}, -0.4}};
        Renderer renderer(assets);
        for (const double time : {0.0, 1.0, 2.5}) {
            scene.time = time;
            // The light map has 256 texels across: at the terminator and at the rim, where light
            // has kinks, it is off by what a bilinear filter makes of them, in the dark.
            const Difference d = compare(renderer, *assets, scene);
            EXPECT_LT(d.mean, 0.3 / 255) << lobe << " at " << time;
            EXPECT_LT(d.largest_linear, 0.04) << lobe << " at " << time;

            // Moved lights are the same as lights that were there from the start.
            Renderer fresh(assets);
            Scene still = scene;
            still.lights = lights_now(scene);
            for (SceneLight& light : still.lights) std::visit([](auto& l) { l.turn = 0; }, light);
            still.time = 0;
            expect_same_bits(radiance(renderer, scene, kWidth, kHeight),
                             radiance(fresh, still, kWidth, kHeight), lobe);
        }
    }
}

// An eye far away, a surface that faces it: there the classic form is what turned normals are.
TEST_F(ClassicBump, AgreesWithTurnedNormalsOfASurfaceThatFacesTheEye) {
    BumpMap bump = bump_of("noise");
    bump.strength = 0.1;
    const auto assets = bumpy_assets(smooth_environment(), {bump});
    Renderer renderer(assets);
    Scene scene = bumpy_scene("plane", mirror_material(), Method::sphere, bump);
    scene.map_size = 128;
    scene.camera = {{0, 100, 0}, {0, 0, 0}, {0, 0, -1}, 0.01};
    const Image turned = radiance(renderer, scene, 64, 64);
    scene.objects[0].material.bump.form = BumpForm::classic;
    const Image classic = radiance(renderer, scene, 64, 64);
    double largest = 0, moved = 0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            largest = std::max<double>(largest, (turned.rgb(x, y) - classic.rgb(x, y)).length());
            moved = std::max<double>(moved, (turned.rgb(x, y) - turned.rgb(0, 0)).length());
        }
    }
    // Slopes of 0.1 on average: the terms of third order are 1e-3 of them.
    EXPECT_LT(largest, 0.02 * moved);
}

// Fine bumps against 256 samples a pixel of the finest level, in radiance.
TEST_F(Bump, VarianceIsWhatManySamplesShow) {
    for (const char* source : {"noise", "hammered"}) {
        BumpMap bump = bump_of(source, 256);
        bump.repeat = {16, 8};
        const auto assets = bumpy_assets(builtin_environment("studio", 256), {bump});
        Renderer renderer(assets);
        Scene scene = bumpy_scene("sphere", mirror_material(), Method::cube, bump);
        scene.map_size = 64;
        constexpr int kSize = 64;
        const auto drawn = [&](BumpFilter filter, int samples) {
            scene.objects[0].material.bump.filter = filter;
            return renderer.picture(scene, {kSize, kSize, samples, false, {}});
        };
        const SurfaceBuffer buffer = renderer.surfaces(scene, kSize, kSize);
        const Image truth = drawn(BumpFilter::none, 256);
        const auto error = [&](const Image& image) {  // relative, rms
            double sum = 0, total = 0;
            for (int y = 1; y + 1 < kSize; ++y) {
                for (int x = 1; x + 1 < kSize; ++x) {
                    if (object_at(buffer, x - 1, y) < 0 || object_at(buffer, x + 1, y) < 0)
                        continue;
                    sum += (image.rgb(x, y) - truth.rgb(x, y)).length2();
                    total += truth.rgb(x, y).length2();
                }
            }
            return std::sqrt(sum / total);
        };
        const double none = error(drawn(BumpFilter::none, 1)),
                     mean = error(drawn(BumpFilter::mean, 1)),
                     variance = error(drawn(BumpFilter::variance, 1));
        std::printf("    %s against 256 samples: none %.3f, mean %.3f, variance %.3f\n", source,
                    none, mean, variance);
        // 0.37 and 0.25 of the truth, in the light of a few small lamps: the slopes are not quite
        // normally distributed, and GGX's tails are long.
        EXPECT_LT(variance, 0.45) << source;
        EXPECT_LT(variance, 0.6 * mean) << source;
        EXPECT_LT(variance, 0.4 * none) << source;
    }
}

TEST_F(Bump, ReliefIsWhereTheRayMeetsIt) {
    BumpMap bump = bump_of("hammered");
    bump.relief = 0.15;
    const auto assets = bumpy_assets(smooth_environment(), {bump});
    Renderer renderer(assets);
    Material material = full_material();
    material.transmission = 0;
    Scene scene = bumpy_scene("plane", material, Method::cube, bump);
    scene.camera = {{0.5, 1.5, 2.5}, {0, 0, 0}, {0, 1, 0}, 0.6};
    const Difference with = compare(renderer, *assets, scene);
    // Steps of a 32nd of the depth miss the edge of a dent now and then.
    EXPECT_LT(with.mean, 0.6 / 255);
    const Image deep = radiance(renderer, scene, kWidth, kHeight);
    scene.objects[0].material.bump.relief = 0;
    const Image level = radiance(renderer, scene, kWidth, kHeight);
    double difference = 0;
    for (std::size_t i = 0; i < deep.values().size(); ++i)
        difference = std::max<double>(difference, std::abs(deep.values()[i] - level.values()[i]));
    EXPECT_GT(difference, 0.05);
}

TEST_F(Bump, WaterShowsItsFloorAndTheSky) {
    BumpMap bump = bump_of("waves");
    Material water = mirror_material();
    water.coupling = Coupling::layered;
    water.fresnel = Fresnel::dielectric(1.33), water.index = 1.33;
    water.transmission = 1, water.base_color = {0.9, 1, 1};
    water.floor = Floor{-0.7, {0.7, 0.6, 0.5}, "checks", 0.4, {0.8, 0.3, 0.2}};
    const auto assets = bumpy_assets(smooth_environment(), {});
    Image checks(2, 2, 3);
    for (int i = 0; i < 4; ++i) checks.set_rgb(i % 2, i / 2, Vec3f(i % 3 == 0 ? 0.9f : 0.3f));
    assets->pictures["checks"] = checks;
    Renderer renderer(assets);
    Scene scene = bumpy_scene("plane", water, Method::cube, bump);
    scene.camera = {{0, 1, 3}, {0, 0, 0}, {0, 1, 0}, 0.5};
    Image first;
    for (const double time : {0.0, 0.7}) {
        scene.time = time;
        const Difference d = compare(renderer, *assets, scene);
        // The floor's checks have steps from texel to texel, and 8 bits for the place between them.
        EXPECT_LT(d.mean, 0.6 / 255) << time;
        EXPECT_LT(d.largest, 12.0 / 255) << time;
        const Image drawn = radiance(renderer, scene, kWidth, kHeight);
        if (first.empty()) {
            first = drawn;
        } else {
            EXPECT_FALSE(
                std::equal(first.values().begin(), first.values().end(), drawn.values().begin()));
        }
    }
}

TEST_F(Bump, ReflectionsBelowTheHorizonGetDarker) {
    // Slopes of 3 at a grazing view: many reflections point into the plane.
    HeightMap ramp{Image(8, 8, 1), 1, 1, Wrap::clamp};
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) *ramp.heights.at(x, y) = static_cast<float>(y * 0.3 / 8);
    BumpMap bump = bump_of("ramp");
    bump.wrap = Wrap::clamp;
    const auto assets = bumpy_assets(builtin_environment("white"), {});
    assets->bumps[bump_key(bump)] = texels_of(ramp);
    Renderer renderer(assets);
    Scene scene = bumpy_scene("plane", mirror_material(), Method::cube, bump);
    scene.camera = {{0, 1, 4}, {0, 0, 0}, {0, 1, 0}, 0.05};
    const SurfaceBuffer buffer = renderer.surfaces(scene, 8, 8);
    const Image dark = radiance(renderer, scene, 8, 8);
    scene.objects[0].material.bump.horizon = false;
    const Image light = radiance(renderer, scene, 8, 8);
    const Vec3d v = (scene.camera.eye - Vec3d(buffer.position.rgb(4, 4))).normalized();
    // dH/dv = -0.3: the normal leans away from the eye, along -z... and up to +t, which is +z.
    for (const double sign : {-1.0, 1.0}) {
        const Vec3d n = Vec3d(0, 1, sign * 0.3).normalized();
        const double up = (n * (2 * n.dot(v)) - v).y;
        if (sign < 0) {
            const double share = std::pow(std::clamp(1 + up, 0.0, 1.0), 2);
            EXPECT_LT(up, 0);
            EXPECT_NEAR(dark.rgb(4, 4).y / light.rgb(4, 4).y, share, 2e-3);
        }
    }
}

TEST_F(Bump, BadMeshesDrawNumbers) {
    // All texture coordinates the same, a triangle without area, and normals that face away.
    Mesh mesh = make_mesh("plane", 2);
    for (Vec2f& st : mesh.texture_coordinates) st = {0.5f, 0.5f};
    mesh.indices.insert(mesh.indices.end(), {0, 0, 1});
    const BumpMap bump = bump_of("hammered");
    const auto assets = bumpy_assets(smooth_environment(), {bump});
    assets->meshes["bad"] = with_tangents(mesh);
    Renderer renderer(assets);
    for (const BumpFilter filter : {BumpFilter::none, BumpFilter::mean, BumpFilter::variance}) {
        Scene scene = bumpy_scene("bad", full_material(), Method::cube, bump);
        scene.objects[0].material.bump.filter = filter;
        for (const double relief : {0.0, 0.2}) {
            scene.objects[0].material.bump.relief = relief;
            const Image drawn = radiance(renderer, scene, 64, 48);
            for (const float value : drawn.values())
                ASSERT_TRUE(std::isfinite(value)) << name(filter);
        }
    }
}

TEST_F(Bump, MethodsThatCannotAreRefused) {
    BumpMap bump = bump_of("hammered");
    const auto assets = bumpy_assets(smooth_environment(), {bump});
    Renderer renderer(assets);
    for (const BumpForm form : {BumpForm::normals, BumpForm::classic}) {
        bump.form = form;
        int able = 0;
        for (const Method method : all_methods()) {
            const Scene scene = bumpy_scene("sphere", mirror_material(), method, bump);
            if (can_show(method, bump)) {
                ++able;
                EXPECT_NO_THROW((void)radiance(renderer, scene, 8, 8)) << name(method);
                continue;
            }
            try {
                (void)radiance(renderer, scene, 8, 8);
                ADD_FAILURE() << name(method) << " was not refused";
            } catch (const Error& error) {
                EXPECT_EQ(error.code(), Errc::usage);
                EXPECT_NE(std::string(error.what()).find(name(method)), std::string::npos);
            }
        }
        EXPECT_EQ(able, form == BumpForm::classic ? 3 : 7);
    }
}

}  // namespace
}  // namespace mirrorball::gl
