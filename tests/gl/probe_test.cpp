// Local maps: captured in a room, and looked up through a proxy as if the room were there.
#include <cmath>
#include <cstdio>
#include <memory>

#include <gtest/gtest.h>

#include <mirrorball/builtin.h>
#include <mirrorball/gl/context.h>
#include <mirrorball/gl/renderer.h>

namespace mirrorball::gl {
namespace {

constexpr int kSide = 96, kMapSize = 128;
constexpr double kMirrorHeight = -0.5;

// Bands and blotches, smooth, so that what is compared is where things are.
Image wallpaper() {
    Image image(64, 64, 3);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const double s = 2 * kPi * (x + 0.5) / 64, t = 2 * kPi * (y + 0.5) / 64;
            image.set_rgb(x, y,
                          Vec3f(Vec3d(0.5 + 0.4 * std::sin(3 * s), 0.5 + 0.4 * std::sin(2 * t + s),
                                      0.5 + 0.4 * std::cos(2 * s) * std::cos(t))));
        }
    }
    return image;
}

std::shared_ptr<SceneAssets> room_assets() {
    auto assets = std::make_shared<SceneAssets>();
    assets->environment =
        make_builtin("white", Projection::cube, 16, default_axes(Projection::cube));
    assets->meshes["cube"] = make_mesh("cube", 4);
    assets->meshes["sphere"] = make_mesh("sphere", 32);
    assets->meshes["plane"] = make_mesh("plane", 1);
    assets->pictures["wallpaper"] = wallpaper();
    return assets;
}

// Walls that look the same from everywhere.
Scene room(const char* mesh, const Vec3d& half_size) {
    SceneObject walls;
    walls.mesh = mesh;
    walls.transform.scale = half_size;
    walls.material.mirror = 0;
    walls.material.diffuse = 1;
    walls.material.coupling = Coupling::added;
    walls.material.base_color_map = "wallpaper";
    Scene scene;
    scene.objects = {walls};
    scene.camera.eye = {1.1, 0.4, 1.2};
    scene.camera.target = {0, kMirrorHeight, 0};
    scene.camera.field_of_view = 0.9;
    return scene;
}

// The eye behind the mirror sees through it what the mirror shows, left and right exchanged.
Camera behind_mirror(const Camera& camera) {
    const auto mirrored = [](Vec3d p) {
        p.y = 2 * kMirrorHeight - p.y;
        return p;
    };
    Camera result = camera;
    result.eye = mirrored(camera.eye);
    result.target = mirrored(camera.target);
    result.up.y = -camera.up.y;
    return result;
}

Image radiance(Renderer& renderer, const Scene& scene) {
    PictureOptions options;
    options.width = options.height = kSide;
    options.sample_count = 1;
    options.display = false;
    return renderer.picture(scene, options);
}

// Over the mirror's pixels, next to what is there.
double error(const Image& found, const Image& seen_from_behind, const SurfaceBuffer& surfaces) {
    double sum = 0, all = 0;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            if (*surfaces.object.at(x, y) != 0) continue;
            for (int c = 0; c < 3; ++c) {
                const double truth = seen_from_behind.at(kSide - 1 - x, y)[c];
                const double difference = found.at(x, y)[c] - truth;
                sum += difference * difference;
                all += truth * truth;
            }
        }
    }
    return std::sqrt(sum / all);
}

struct Errors {
    double with_proxy, without;
};

Errors errors_of_reflection(const Scene& walls, const Vec3d& captured_at, const Proxy& proxy) {
    const auto assets = room_assets();
    Renderer room_renderer(assets);
    Scene from_behind = walls;
    from_behind.camera = behind_mirror(walls.camera);
    const Image truth = radiance(room_renderer, from_behind);

    auto with_map = std::make_shared<SceneAssets>(*assets);
    with_map->environment = room_renderer.capture(walls, captured_at, kMapSize);
    Renderer renderer(with_map);
    Scene scene;
    scene.camera = walls.camera;
    scene.environment.captured_at = captured_at;
    SceneObject mirror;
    mirror.mesh = "plane";
    mirror.transform.position = {0, kMirrorHeight, 0};
    scene.objects = {mirror};
    const SurfaceBuffer surfaces = renderer.surfaces(scene, kSide, kSide);
    const double without = error(radiance(renderer, scene), truth, surfaces);
    scene.environment.proxy = proxy;
    return {error(radiance(renderer, scene), truth, surfaces), without};
}

TEST(Probe, BoxProxyShowsARoomWhereItIs) {
    const Context context;
    const Vec3d half_size(2, 1.5, 2.5);
    const Errors errors = errors_of_reflection(room("cube", half_size), {0.3, 0.2, -0.4},
                                               BoxProxy{-half_size, half_size});
    std::printf("box: rms error %.4f, without proxy %.4f\n", errors.with_proxy, errors.without);
    EXPECT_LT(errors.with_proxy, 0.05);  // the room's edges, blurred over a texel
    EXPECT_GT(errors.without, 0.4);
}

TEST(Probe, SphereProxyShowsADomeWhereItIs) {
    const Context context;
    const Errors errors = errors_of_reflection(room("sphere", Vec3d(2.2)), {-0.5, 0.3, 0.2},
                                               SphereProxy{Vec3d(0), 2.2});
    std::printf("sphere: rms error %.4f, without proxy %.4f\n", errors.with_proxy, errors.without);
    EXPECT_LT(errors.with_proxy, 0.005);  // no edges: half floats, and chords for arcs
    EXPECT_GT(errors.without, 0.3);
}

// Where the map was captured, there is nothing to correct: a camera there sees the room itself.
TEST(Probe, CaptureIsWhatACameraThereSees) {
    const Context context;
    const auto assets = room_assets();
    Renderer room_renderer(assets);
    Scene scene = room("cube", {2, 1.5, 2.5});
    const Image truth = radiance(room_renderer, scene);
    auto with_map = std::make_shared<SceneAssets>(*assets);
    with_map->environment = room_renderer.capture(scene, scene.camera.eye, kMapSize);
    Renderer renderer(with_map);
    Scene empty;
    empty.camera = scene.camera;
    const Image found = radiance(renderer, empty);
    double sum = 0, all = 0;
    for (std::size_t i = 0; i < truth.values().size(); ++i) {
        sum += std::pow(found.values()[i] - truth.values()[i], 2);
        all += std::pow(truth.values()[i], 2);
    }
    EXPECT_LT(std::sqrt(sum / all), 0.04);  // edges, over texels of 0.7 degrees
}

}  // namespace
}  // namespace mirrorball::gl
