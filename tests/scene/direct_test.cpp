// Direct evaluation against its equations by hand, energy, and geometry by brute force.
#include <mirrorball/direct.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <tbb/global_control.h>

#include <mirrorball/brdf.h>
#include <mirrorball/builtin.h>
#include <mirrorball/dfg.h>
#include <mirrorball/fresnel.h>
#include <mirrorball/lookup.h>

#include "synthetic.h"

namespace mirrorball {
namespace {

constexpr Coupling kCouplings[] = {Coupling::added, Coupling::layered, Coupling::split_sum};

// A scene of one object with all that it takes to shade it.
struct Stage {
    Scene scene;
    SceneAssets assets;
    ReflectionMaps maps;

    Stage(const Material& material, EnvironmentMap environment, int size = 64) {
        scene.objects.resize(1);
        scene.objects[0].material = material;
        assets.environment = std::move(environment);
        maps = make_reflection_maps(assets.environment, lobes_of(scene), Projection::cube, size,
                                    default_axes(Projection::cube));
    }

    // From `cosine` to the normal (0, 0, 1), at the origin.
    [[nodiscard]] Vec3d at(double cosine) const { return from(eye(cosine)); }
    [[nodiscard]] Vec3d from(const Vec3d& place) const {
        return DirectShading(scene, assets, maps).surface(0, {{0, 0, 0}, {0, 0, 1}}, place);
    }
    static Vec3d eye(double cosine) { return {3 * std::sqrt(1 - cosine * cosine), 0, 3 * cosine}; }
};

EnvironmentMap white() {
    return sampled(Projection::cube, 8, [](const Vec3d&) { return Vec3d(1); });
}

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance) {
    EXPECT_NEAR((a - b).length(), 0, tolerance) << a << " and " << b;
}

// Energy: light from everywhere is 1. Tolerance: of the glossy maps and the cosine's, 1e-4.

TEST(DirectFurnace, LayeredAndSplitSumGiveBackAllLight) {
    for (const Coupling coupling : {Coupling::layered, Coupling::split_sum}) {
        for (const double cosine : {0.02, 0.3, 0.7, 1.0}) {
            for (const bool glossy : {false, true}) {
                Material m;
                m.mirror = glossy ? 0 : 1, m.glossy = glossy ? 1 : 0;
                m.diffuse = 1;
                m.coupling = coupling;
                m.fresnel = Fresnel::dielectric(1.5);
                expect_near(Stage(m, white()).at(cosine), Vec3d(1), 2e-4);
            }
        }
    }
}

TEST(DirectFurnace, AddedGivesMoreThanThereIsByTheFresnelTerm) {
    Material m;
    m.diffuse = 1;
    m.coupling = Coupling::added;
    m.fresnel = Fresnel::dielectric(1.5);
    for (const double cosine : {0.1, 0.5, 1.0})
        expect_near(Stage(m, white()).at(cosine), Vec3d(1 + fresnel_dielectric(cosine, 1.5)), 2e-4);
}

TEST(DirectFurnace, RoughMetalReflectsAllThatItIsToldTo) {
    Material m;
    m.mirror = 0, m.glossy = 1;
    m.lobe = {Lobe::Kind::ggx, 1};
    m.coupling = Coupling::split_sum;
    expect_near(Stage(m, white()).at(0.4), Vec3d(1), 2e-4);
}

TEST(DirectFurnace, ClearGlassIsNotSeen) {
    Material m;
    m.transmission = 1;
    m.fresnel = Fresnel::dielectric(1.5);
    const Stage stage(m, white());
    for (const double cosine : {-1.0, -0.8, -0.2, 0.1, 0.9}) {
        for (const Coupling coupling : {Coupling::added, Coupling::layered}) {
            Stage glass = stage;
            glass.scene.objects[0].material.coupling = coupling;
            expect_near(glass.at(cosine), Vec3d(1), 1e-6);
        }
    }
}

// Equations 20 and 21 by hand, in an environment that differs everywhere.

TEST(Direct, Equations20And21) {
    Material m;
    m.mirror = 0.75, m.diffuse = 0.5;
    m.base_color = {0.2, 0.4, 0.8};
    m.fresnel = Fresnel::conductor("copper");
    for (const double cosine : {0.05, 0.4, 0.95}) {
        for (const Coupling coupling : {Coupling::added, Coupling::layered}) {
            m.coupling = coupling;
            Stage stage(m, sampled(Projection::cube, 64, smooth_light));
            stage.scene.environment.intensity = 2;
            const Vec3d v = Stage::eye(cosine) / 3, r(-v.x, 0, v.z), f = m.fresnel(cosine);
            const Vec3d mirror(look_up(stage.maps.mirror, r));
            const Vec3d irradiance(look_up(stage.maps.diffuse, {0, 0, 1}));
            const Vec3d base = coupling == Coupling::added ? Vec3d(1) : Vec3d(1) - f;
            expect_near(stage.at(cosine),
                        (f * mirror * 0.75 + base * m.base_color * irradiance * (0.5 / kPi)) * 2.0,
                        1e-12);
            // and the maps are what they should be: E of this light is pi + 2 pi/3 times its linear
            // part, its quadratic one being 0 at n
            expect_near(mirror, smooth_light(r), 2e-3);
            expect_near(irradiance, Vec3d(1, 1.2, 0.9) * kPi + Vec3d(0, 0, 0.4) * (2 * kPi / 3),
                        2e-3);
        }
    }
}

// Tolerance: of the tabulated A and B.
TEST(Direct, SplitSum) {
    for (const double roughness : {0.0, 0.05, 0.2, 0.6, 1.0}) {
        Material m;
        m.mirror = 0, m.glossy = 1;
        m.lobe = {Lobe::Kind::ggx, roughness};
        m.coupling = Coupling::split_sum;
        m.fresnel = Fresnel::schlick({0.9, 0.5, 0.1});
        const Stage stage(m, sampled(Projection::cube, 16, smooth_light), 16);
        const DirectShading shading(stage.scene, stage.assets, stage.maps);
        double worst = 0;
        for (double cosine = 1e-4; cosine < 1; cosine += 0.003) {
            const Vec3d eye = Stage::eye(cosine), v = eye / 3, r(-v.x, 0, v.z);
            const Vec3d f0 = m.fresnel.f0(), light(look_up(stage.maps.glossy[0], r));
            const Dfg dfg = ggx_dfg(cosine, roughness);
            const Vec3d expected =
                light * dfg.reflectance(f0) * energy_compensation(f0, dfg.albedo());
            const Vec3d found = shading.surface(0, {{0, 0, 0}, {0, 0, 1}}, eye);
            worst = std::max(worst, (found - expected).length());
        }
        EXPECT_LT(worst, 2e-5) << roughness;
    }
}

// What is seen where.

// A ray tracer's sphere: what it mirrors is on the right side, the right way up.
TEST(Direct, MirrorSphereShowsTheRightAxis) {
    const EnvironmentMap chart =
        make_builtin("axes", Projection::cube, 128, default_axes(Projection::cube));
    Stage stage(Material(), chart, 128);
    const DirectShading shading(stage.scene, stage.assets, stage.maps);
    const Vec3d eye(0, 0, 100);
    const auto in_sphere = [&](const Vec3d& n) { return shading.surface(0, {n, n}, eye); };
    // The chart's own colour in a direction a little beside each axis, not on its label's strokes.
    const auto in_chart = [&](const Vec3d& d) { return Vec3d(look_up(chart, d)); };
    const double s = std::sqrt(0.5);
    const Vec3d beside(0.013, 0.021, 0.008);
    const Vec3d normals[] = {{s, 0, s}, {-s, 0, s}, {0, s, s}, {0, -s, s}, {0, 0, 1}};
    for (const Vec3d& axis : normals) {
        const Vec3d n = (axis + beside).normalized(), v = (eye - n).normalized();
        const Vec3d r = n * (2 * n.dot(v)) - v;
        expect_near(in_sphere(n), in_chart(r), 1e-5);
    }
    // The right of the ball mirrors +x, its top +y: those of the chart's colours.
    expect_near(in_sphere({s, 0, s}), in_chart({1, 0, -0.01}), 0.2);
    expect_near(in_sphere({0, s, s}), in_chart({0, 1, -0.01}), 0.2);
    EXPECT_GT((in_chart({1, 0.2, 0.2}) - in_chart({-1, 0.2, 0.2})).length(), 0.1)
        << "the chart tells the sides apart";
}

TEST(Direct, BackIsSeenAsFront) {
    Material m;
    m.diffuse = 0.5;
    m.fresnel = Fresnel::dielectric(1.5);
    const Stage stage(m, sampled(Projection::cube, 32, smooth_light));
    const DirectShading shading(stage.scene, stage.assets, stage.maps);
    expect_near(shading.surface(0, {{0, 0, 0}, {0, 0, -1}}, {1, 1, 1}),
                shading.surface(0, {{0, 0, 0}, {0, 0, 1}}, {1, 1, 1}), 0);
}

TEST(Direct, BackgroundIsTheEnvironmentOrAColour) {
    Stage stage(Material(), sampled(Projection::cube, 32, smooth_light));
    stage.scene.environment.intensity = 3;
    const Vec3d d(0.3, -0.4, -1);
    const DirectShading shading(stage.scene, stage.assets, stage.maps);
    expect_near(shading.background({5, 6, 7}, d), smooth_light(d.normalized()) * 3.0, 5e-3);
    stage.scene.environment.background = false;
    stage.scene.environment.background_color = {0.1, 0.2, 0.3};
    expect_near(shading.background({5, 6, 7}, d), {0.1, 0.2, 0.3}, 0);
}

// Glass: Snell, and what the exact Fresnel equations let through.

TEST(Refraction, FollowsSnell) {
    const Vec3d n(0, 0, 1);
    for (const double index : {0.7, 1.0, 1.33, 2.4}) {
        for (double angle = 0; angle < 1.57; angle += 0.1) {
            const Vec3d v(std::sin(angle), 0, std::cos(angle));
            const Vec3d t = refracted(v, n, index);
            if (std::sin(angle) >= index) {
                EXPECT_EQ(t, Vec3d(0)) << "total reflection";
                continue;
            }
            EXPECT_NEAR(t.length(), 1, 1e-12);
            EXPECT_NEAR(-t.x * index, std::sin(angle), 1e-12);
            EXPECT_LE(t.z, 0);
        }
    }
}

TEST(Refraction, GlassAgainstTheFresnelEquations) {
    Material m;
    m.transmission = 1;
    m.base_color = {0.9, 0.8, 0.7};
    m.fresnel = Fresnel::dielectric(1.5);
    const Stage stage(m, sampled(Projection::cube, 64, smooth_light));
    const auto light = [&](const Vec3d& d) { return Vec3d(look_up(stage.maps.mirror, d)); };
    for (const double cosine : {0.1, 0.5, 0.9, -0.1, -0.6, -0.75, -0.9}) {
        const Vec3d v = Stage::eye(cosine) / 3, n(0, 0, cosine < 0 ? -1 : 1);
        // negative: the eye is in the glass, which fresnel_dielectric() takes so
        const double f = fresnel_dielectric(cosine, 1.5);
        const Vec3d r = n * (2 * n.dot(v)) - v, t = refracted(v, n, cosine < 0 ? 1 / 1.5 : 1.5);
        const Vec3d through = f < 1 ? light(t) * m.base_color * (1 - f) : Vec3d(0);
        expect_near(stage.at(cosine), light(r) * f + through, 1e-9);
    }
    EXPECT_EQ(fresnel_dielectric(-0.6, 1.5), 1) << "this test has a case of total reflection";
}

// Proxies, by walking along the ray in small steps.

template <class Inside>
Vec3d walked(const Vec3d& p, const Vec3d& d, Inside&& inside) {
    double t = 0;
    for (const double step : {0.1, 1e-3, 1e-5, 1e-7}) {
        while (inside(p + d * (t + step))) t += step;
    }
    return p + d * t;
}

TEST(Proxy, RaysMeetTheWalls) {
    SceneEnvironment box, sphere;
    const Vec3d least(-1, -2, -3), most(2, 1, 4), centre(0.5, 0, 1);
    box.proxy = BoxProxy{least, most};
    sphere.proxy = SphereProxy{centre, 4};
    box.captured_at = sphere.captured_at = {0.2, -0.3, 0.4};
    std::mt19937 random(3);
    std::uniform_real_distribution<double> u(-0.9, 0.9);
    for (int i = 0; i < 100; ++i) {
        const Vec3d p(u(random), u(random), u(random));
        const Vec3d d = Vec3d(u(random), u(random), u(random)).normalized();
        const Vec3d on_box = walked(p, d, [&](const Vec3d& q) {
            return q.x > least.x && q.y > least.y && q.z > least.z && q.x < most.x &&
                   q.y < most.y && q.z < most.z;
        });
        const Vec3d on_sphere =
            walked(p, d, [&](const Vec3d& q) { return (q - centre).length() < 4; });
        expect_near(seen_from_capture(box, p, d), on_box - box.captured_at, 1e-6);
        expect_near(seen_from_capture(sphere, p, d), on_sphere - sphere.captured_at, 1e-6);
    }
}

TEST(Proxy, MissedFromOutsideIsLeftAlone) {
    SceneEnvironment box, sphere;
    box.proxy = BoxProxy{};
    sphere.proxy = SphereProxy{};
    for (const SceneEnvironment* e : {&box, &sphere}) {
        EXPECT_EQ(seen_from_capture(*e, {5, 0, 0}, {1, 0, 0}), Vec3d(1, 0, 0)) << "away from it";
        EXPECT_EQ(seen_from_capture(*e, {5, 5, 0}, {-1, 0, 0}), Vec3d(-1, 0, 0)) << "beside it";
        EXPECT_EQ(seen_from_capture(*e, {5, 5, 5}, {-1, -0.1, -0.2}), Vec3d(-1, -0.1, -0.2))
            << "askew beside it";
        expect_near(seen_from_capture(*e, {5, 0, 0}, {-1, 0, 0}), {-1, 0, 0}, 1e-12);
        expect_near(seen_from_capture(*e, {0, 0, 0}, {0, 0, -1}), {0, 0, -1}, 1e-12);
    }
    EXPECT_EQ(seen_from_capture(SceneEnvironment(), {5, 0, 0}, {0, 1, 0}), Vec3d(0, 1, 0));
}

// A mirror in a room sees the wall where a ray tracer would, wherever it stands.
TEST(Proxy, AMirrorShowsTheRoom) {
    const auto wall_light = [](const Vec3d& place) {
        return Vec3d(2, 2, 2) + Vec3d(place.x, place.y, place.z) * 0.3;
    };
    const BoxProxy room{{-3, -2, -4}, {3, 2, 4}};
    SceneEnvironment captured;
    captured.proxy = room;
    captured.captured_at = {1, 0.5, -1};
    const auto light = [&](const Vec3d& d) {
        return wall_light(seen_from_capture(captured, captured.captured_at, d) +
                          captured.captured_at);
    };
    Stage stage(Material(), sampled(Projection::cube, 256, light), 256);
    stage.scene.environment = captured;
    const DirectShading shading(stage.scene, stage.assets, stage.maps);
    for (const Vec3d& p : {Vec3d(-2, -1, 3), Vec3d(2, 1, 0), Vec3d(0, 0, -3)}) {
        const Vec3d n = Vec3d(0.3, 0.5, 1).normalized(), eye = p + Vec3d(0.5, 1, 0.7);
        const Vec3d v = (eye - p).normalized(), r = n * (2 * n.dot(v)) - v;
        const Vec3d wall = p + r * [&] {
            double t = 1e9;
            for (int i = 0; i < 3; ++i)
                t = std::min(t,
                             std::max((room.least[i] - p[i]) / r[i], (room.most[i] - p[i]) / r[i]));
            return t;
        }();
        // a texel of the map is up to 5/128 of the room's light
        expect_near(shading.surface(0, {p, n}, eye), wall_light(wall), 0.02);
    }
}

// Lights.

TEST(DirectLights, LambertUnderALamp) {
    Material m;
    m.mirror = 0, m.diffuse = 0.5;
    m.base_color = {0.2, 0.4, 0.6};
    m.fresnel = Fresnel::schlick(Vec3d(0), Vec3d(0));
    Stage stage(m, sampled(Projection::cube, 8, [](const Vec3d&) { return Vec3d(0); }));
    stage.scene.lights = {ScenePointLight{{0, 3, 4}, {10, 20, 30}}};
    // I/d^2 cos: 10/25 * 4/5
    expect_near(stage.at(0.5), m.base_color * Vec3d(10, 20, 30) * (0.5 / kPi / 25 * 0.8), 1e-12);
    stage.scene.lights = {SceneDirectionalLight{{0, 6, 8}, Vec3d(2)},
                          ScenePointLight{{0, 0, -1}, Vec3d(9)},
                          ScenePointLight{{0, 0, 0}, Vec3d(9)}};
    expect_near(stage.at(0.5), m.base_color * (0.5 / kPi * 2 * 0.8), 1e-12);
}

// A small bright spot of an environment and a light of the same strength do nearly the same to a
// glossy surface: the map leaves out only what changes between v = n and v = r.
TEST(DirectLights, GlossyHighlights) {
    const Vec3d l = Vec3d(0.1, 0.2, 1).normalized(), v = Vec3d(-0.1, -0.1, 1).normalized();
    for (const Lobe& lobe : {Lobe{Lobe::Kind::phong, 20}, Lobe{Lobe::Kind::blinn_phong, 80}}) {
        Material m;
        m.mirror = 0, m.glossy = 1;
        m.lobe = lobe;
        const EnvironmentMap dark =
            sampled(Projection::cube, 8, [](const Vec3d&) { return Vec3d(0); });
        Stage stage(m, dark);
        stage.scene.lights = {SceneDirectionalLight{l, Vec3d(1)}};
        const Vec3d r = Vec3d(0, 0, 1) * (2 * v.z) - v;
        EXPECT_NEAR(stage.from(v * 3).x / lobe.value(r.dot(l)), 1, 0.1) << to_string(lobe);
    }
}

// In the frame of the surface itself, where the normal is z.
TEST(DirectLights, GgxIsTheMicrofacetBrdf) {
    const Vec3d l = Vec3d(0.5, 0.2, 1).normalized(), v = Vec3d(-0.1, -0.4, 1).normalized();
    Material m;
    m.mirror = 0, m.glossy = 0.5;
    m.lobe = {Lobe::Kind::ggx, 0.5};
    m.fresnel = Fresnel::conductor("gold");
    Stage stage(m, sampled(Projection::cube, 8, [](const Vec3d&) { return Vec3d(0); }));
    stage.scene.lights = {SceneDirectionalLight{l, Vec3d(2)}};
    const Brdf brdf = parse_brdf("ggx:roughness=0.5,metal=gold");
    expect_near(stage.from(v * 3), brdf.evaluate(l, v) * l.z, 1e-9);
}

TEST(Direct, PicturesColourTheBase) {
    Material m;
    m.mirror = 0, m.diffuse = 1;
    m.base_color_map = "p";
    m.fresnel = Fresnel::schlick(Vec3d(0), Vec3d(0));
    Stage stage(m, white());
    Image picture(2, 2, 3);
    picture.set_rgb(0, 0, {1, 0, 0}), picture.set_rgb(1, 0, {0, 1, 0});
    picture.set_rgb(0, 1, {0, 0, 1}), picture.set_rgb(1, 1, {1, 1, 1});
    stage.assets.pictures["p"] = picture;
    const DirectShading shading(stage.scene, stage.assets, stage.maps);
    const auto at = [&](float s, float t) {
        return shading.surface(0, {{0, 0, 0}, {0, 0, 1}, {s, t}}, {0, 0, 1});
    };
    expect_near(at(0.25f, 0.25f), {1, 0, 0}, 1e-4);
    expect_near(at(-0.25f, 3.25f), {0, 1, 0}, 1e-4);
    expect_near(at(0.25f, 1.75f), {0, 0, 1}, 1e-4);
    expect_near(at(0, 0), {0.5, 0.5, 0.5}, 1e-4);
    stage.scene.objects[0].material.diffuse = 0;
    stage.scene.objects[0].material.emission = 4;
    expect_near(at(0.25f, 1.75f), {0, 0, 4}, 1e-6);
}

TEST(Direct, EmissionIsAddedToWhatIsReflected) {
    Material m;
    m.mirror = 0.5;
    m.base_color = {0.2, 0.4, 0.8};
    for (const Coupling coupling : kCouplings) {
        m.coupling = coupling;
        m.emission = 0;
        Stage dark(m, sampled(Projection::cube, 16, smooth_light));
        dark.scene.environment.intensity = 3;
        Stage lamp = dark;
        lamp.scene.objects[0].material.emission = 5;
        for (const double cosine : {-0.7, 0.1, 1.0})
            expect_near(lamp.at(cosine) - dark.at(cosine), m.base_color * 5.0, 1e-12);
    }
}

// Nothing is ever no number: any material, from anywhere, edges and degenerate points included.
TEST(Direct, NeverNoNumber) {
    const Lobe lobes[] = {{Lobe::Kind::phong, 0},
                          {Lobe::Kind::ggx, 0},
                          {Lobe::Kind::ggx, 1},
                          {Lobe::Kind::charlie, 0.3},
                          {Lobe::Kind::blinn_phong, 1e6}};
    Stage stage(Material(), sampled(Projection::cube, 16, smooth_light), 16);
    stage.maps = make_reflection_maps(stage.assets.environment, lobes, Projection::cube, 16,
                                      default_axes(Projection::cube));
    stage.scene.lights = {ScenePointLight{{0, 0, 0}, Vec3d(1)}, SceneDirectionalLight{}};
    Material& m = stage.scene.objects[0].material;
    m.glossy = m.diffuse = m.transmission = 1;
    m.fresnel = Fresnel::dielectric(1.5);
    for (const Coupling coupling : kCouplings) {
        for (const Lobe& lobe : lobes) {
            m.coupling = coupling;
            m.lobe = lobe;
            for (const Proxy& proxy : {Proxy(), Proxy(BoxProxy{{0, -1, -1}, {1, 1, 1}}),
                                       Proxy(SphereProxy{{0, 0, -1}, 1})}) {
                stage.scene.environment.proxy = proxy;
                const DirectShading shading(stage.scene, stage.assets, stage.maps);
                for (const Vec3d& n : {Vec3d(0, 0, 1), Vec3d(0, 0, 0)}) {
                    for (const Vec3d& eye : {Vec3d(0, 0, 1), Vec3d(1, 0, 0), Vec3d(0, 0, -1),
                                             Vec3d(0, 0, 0), Vec3d(1, 0, -1e-9), Vec3d(2, 1, -1)}) {
                        const Vec3d radiance = shading.surface(0, {{0, 0, 0}, n}, eye);
                        for (int i = 0; i < 3; ++i) {
                            EXPECT_TRUE(std::isfinite(radiance[i]) && radiance[i] >= 0)
                                << radiance << " of " << to_string(m.lobe) << " from " << eye;
                        }
                    }
                }
            }
        }
    }
}

// A picture: each pixel as its point alone, whatever the threads.
TEST(Direct, PicturesAreTheirPoints) {
    Material m;
    m.diffuse = 0.5;
    Stage stage(m, sampled(Projection::cube, 32, smooth_light));
    const int width = 40, height = 30;
    SurfaceBuffer surfaces{Image(width, height, 3), Image(width, height, 3),
                           Image(width, height, 1), Image(width, height, 2)};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Vec3d n((x - 20) / 10.0, (15 - y) / 10.0, 0);
            const double z2 = 1 - n.dot(n);
            *surfaces.object.at(x, y) = z2 > 0 ? 0 : -1;
            const Vec3f p(Vec3d(n.x, n.y, std::sqrt(std::max(z2, 0.0))));
            surfaces.position.set_rgb(x, y, p);
            surfaces.normal.set_rgb(x, y, p);
        }
    }
    const Image picture = shade(stage.scene, stage.assets, stage.maps, surfaces);
    const DirectShading shading(stage.scene, stage.assets, stage.maps);
    const Vec3d n(surfaces.normal.rgb(23, 11));
    EXPECT_EQ(picture.rgb(23, 11), Vec3f(shading.surface(0, {n, n}, stage.scene.camera.eye)));
    const Vec3d ray = view_ray(stage.scene.camera, 2.5 / width, 3.5 / height, 4.0 / 3);
    EXPECT_EQ(picture.rgb(2, 3), Vec3f(shading.background(stage.scene.camera.eye, ray)));
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const Image again = shade(stage.scene, stage.assets, stage.maps, surfaces);
    EXPECT_TRUE(std::equal(again.values().begin(), again.values().end(), picture.values().begin()));
}

}  // namespace
}  // namespace mirrorball
