// The viewer in a context without a window.
#include <mirrorball/viewer.h>

#include <cmath>
#include <fstream>

#include <mirrorball/error.h>
#include <mirrorball/io.h>
#include <mirrorball/material_presets.h>
#include <mirrorball/scene_file.h>

#include "gl/gl.h"
#include "gl/gl_test.h"
#include "gl/objects.h"
#include "gl/seen.h"
#include "support.h"

namespace mirrorball {
namespace {

constexpr int kWidth = 96, kHeight = 72;

class ViewerTest : public gl::GlTest {
  protected:
    // Small, so that software draws it at once.
    static Scene small_scene(const std::string& material = "mirror") {
        Scene scene;
        SceneObject object;
        object.material = preset_material(material);
        scene.objects.push_back(object);
        scene.environment.source = chart();
        scene.camera.eye = {1.5, 1, 4};
        scene.map_size = 64;
        return scene;
    }
    // Directions in colours: small, since built-in environments take a second to draw.
    static std::string chart() {
        static const TemporaryFolder folder;
        static const std::string name = [] {
            const std::string path = (folder / "chart.hdr").string();
            write_map(path, gl::builtin_environment("axes"));
            return path;
        }();
        return name;
    }
    static Viewer make_viewer(const Scene& scene, int samples = 1) {
        return Viewer(scene, {}, {.sample_count = samples});
    }
};

// A screen of 8 bits, and what a viewer puts on it.
class Screen {
  public:
    Screen(int width, int height, bool with_depth = false) : width_(width), height_(height) {
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
        glBindRenderbuffer(GL_RENDERBUFFER, picture_.name());
        glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                                  picture_.name());
        if (!with_depth) return;
        glBindRenderbuffer(GL_RENDERBUFFER, depth_.name());
        glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                  depth_.name());
    }

    /// Codes, three a pixel, top row first.
    std::vector<int> show(Viewer& viewer, int draws = 1) {
        return show(viewer, draws, width_, height_, 0, 0);
    }
    std::vector<int> show(Viewer& viewer, int draws, int width, int height, int left, int bottom) {
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
        for (int i = 0; i < draws; ++i) viewer.draw(width, height, left, bottom);
        GLint bound = 0;
        glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
        EXPECT_EQ(static_cast<GLuint>(bound), framebuffer_.name());
        return codes();
    }

    void fill(float grey) const {
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
        glClearColor(grey, grey, grey, 1);
        glClear(GL_COLOR_BUFFER_BIT);
    }

    [[nodiscard]] std::vector<int> codes() const {
        std::vector<std::uint8_t> bytes(std::size_t{4} * width_ * height_);
        glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
        std::vector<int> codes;
        for (int y = height_ - 1; y >= 0; --y)
            for (int x = 0; x < width_; ++x)
                for (int c = 0; c < 3; ++c) codes.push_back(bytes[4 * (y * width_ + x) + c]);
        return codes;
    }

  private:
    int width_, height_;
    gl::Framebuffer framebuffer_;
    gl::Renderbuffer picture_, depth_;
};

std::vector<int> codes_of(const Image& linear) {
    std::vector<int> codes;
    for (const float y : linear.values())
        codes.push_back(static_cast<int>(std::lround(gl::srgb(y) * 255)));
    return codes;
}

int largest_difference(const std::vector<int>& a, const std::vector<int>& b) {
    EXPECT_EQ(a.size(), b.size());
    int largest = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
}

std::vector<int> rendered(const Viewer& viewer, Method method, int samples) {
    Scene scene = viewer.scene();
    scene.method = method;
    gl::Renderer renderer(std::make_shared<const SceneAssets>(viewer.assets()));
    return codes_of(renderer.picture(scene, {.width = kWidth,
                                             .height = kHeight,
                                             .sample_count = samples,
                                             .display = true,
                                             .progress = {}}));
}

// Half floats in between, with 11 bits, can tip a code over.
constexpr int kHalfFloatCodes = 1;
// The mean of eight is rounded to half floats as often.
constexpr int kMeanCodes = 2;

TEST_F(ViewerTest, ShowsWhatTheRendererDraws) {
    Viewer viewer = make_viewer(small_scene());
    Screen screen(kWidth, kHeight);
    EXPECT_LE(largest_difference(screen.show(viewer), rendered(viewer, Method::cube, 1)),
              kHalfFloatCodes);
    EXPECT_TRUE(viewer.is_smooth());
}

TEST_F(ViewerTest, GetsSmoothWhileNothingMoves) {
    Viewer viewer = make_viewer(small_scene(), 8);
    Screen screen(kWidth, kHeight);
    EXPECT_LE(largest_difference(screen.show(viewer), rendered(viewer, Method::cube, 1)),
              kHalfFloatCodes);
    EXPECT_FALSE(viewer.is_smooth());
    EXPECT_LE(largest_difference(screen.show(viewer, 8), rendered(viewer, Method::cube, 8)),
              kMeanCodes);
    EXPECT_TRUE(viewer.is_smooth());
    viewer.orbit(10, 0, kHeight);
    screen.show(viewer);
    EXPECT_FALSE(viewer.is_smooth());
}

TEST_F(ViewerTest, WipesBetweenTwoMethods) {
    Viewer viewer = make_viewer(small_scene());
    viewer.set_comparison(
        {.showing = Showing::wipe, .other = Method::sphere_stale, .wipe = 0.25, .full_scale = 1});
    Screen screen(kWidth, kHeight);
    const std::vector<int> shown = screen.show(viewer);
    const std::vector<int> left = rendered(viewer, Method::cube, 1);
    const std::vector<int> right = rendered(viewer, Method::sphere_stale, 1);
    ASSERT_GT(largest_difference(left, right), 50);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (int c = 0; c < 3; ++c) {
                const std::size_t i = 3 * (static_cast<std::size_t>(y) * kWidth + x) + c;
                ASSERT_NEAR(shown[i], x < kWidth / 4 ? left[i] : right[i], kHalfFloatCodes);
            }
    // The line moves without anything being drawn anew, to either end.
    viewer.set_comparison(
        {.showing = Showing::wipe, .other = Method::sphere_stale, .wipe = 1, .full_scale = 1});
    EXPECT_LE(largest_difference(screen.show(viewer), left), kHalfFloatCodes);
    viewer.set_comparison(
        {.showing = Showing::wipe, .other = Method::cube, .wipe = 0, .full_scale = 1});
    EXPECT_LE(largest_difference(screen.show(viewer), left), kHalfFloatCodes);
}

// Black where two methods agree, and white where they differ by all of the scale.
// Where there is a depth buffer, pictures that move are not drawn elsewhere first.
TEST_F(ViewerTest, ScreensWithDepthShowTheSame) {
    const Scene scene = small_scene("gold");
    Screen plain(kWidth, kHeight), with_depth(kWidth, kHeight, true);
    for (const Showing showing : {Showing::one, Showing::wipe, Showing::difference}) {
        for (const int samples : {1, 4}) {
            Viewer one = make_viewer(scene, samples), other = make_viewer(scene, samples);
            for (Viewer* viewer : {&one, &other})
                viewer->set_comparison({.showing = showing,
                                        .other = Method::sphere_stale,
                                        .wipe = 0.401,
                                        .full_scale = 0.1});
            for (int draws = 0; draws < samples + 2; ++draws) {
                EXPECT_EQ(plain.show(one), with_depth.show(other))
                    << name(showing) << ", draw " << draws << " of " << samples;
                EXPECT_EQ(one.is_smooth(), other.is_smooth());
            }
            EXPECT_EQ(plain.show(one), plain.show(other)) << "the other way of two";
            // Only the line moves.
            for (Viewer* viewer : {&one, &other}) {
                Comparison comparison = viewer->comparison();
                comparison.wipe = 0.7;
                viewer->set_comparison(comparison);
            }
            EXPECT_EQ(plain.show(one), with_depth.show(other)) << name(showing);
        }
    }
}

// What is held is not made smooth, and of lobes that take long to prefilter shows the chain.
TEST_F(ViewerTest, HeldPicturesAreQuick) {
    Scene scene = small_scene();
    Material& material = scene.objects[0].material;
    material.mirror = 0, material.glossy = 1;
    material.lobe = {Lobe::Kind::ggx, 0.08};
    Screen screens[] = {{kWidth, kHeight, false}, {kWidth, kHeight, true}};
    for (Screen& screen : screens) {
        Viewer viewer = make_viewer(scene, 4);
        viewer.hold(true);
        const std::vector<int> held = screen.show(viewer);
        EXPECT_TRUE(viewer.is_smooth());
        EXPECT_EQ(screen.show(viewer), held);
        for (const Showing showing : {Showing::difference, Showing::one}) {
            viewer.set_comparison({.showing = showing, .other = Method::cube});
            screen.show(viewer, 2);
        }
        EXPECT_EQ(screen.show(viewer), held);
        viewer.hold(false);
        const std::vector<int> smooth = screen.show(viewer, 4);
        EXPECT_TRUE(viewer.is_smooth());
        EXPECT_EQ(screen.show(viewer), smooth);
        EXPECT_LE(largest_difference(smooth, rendered(viewer, Method::cube, 4)), kMeanCodes);
        EXPECT_GT(largest_difference(smooth, held), kMeanCodes);
    }
}

TEST_F(ViewerTest, TouchesNothingAroundItsPicture) {
    // Even: derivatives are taken by pairs of pixels.
    constexpr int kLeft = 8, kBottom = 6, kMargin = 20;
    for (const bool with_depth : {false, true}) {
        Viewer viewer = make_viewer(small_scene());
        const std::vector<int> alone = Screen(kWidth, kHeight, with_depth).show(viewer);
        Screen screen(kWidth + kMargin, kHeight + kMargin, with_depth);
        screen.fill(0.2f);
        const std::vector<int> codes = screen.show(viewer, 1, kWidth, kHeight, kLeft, kBottom);
        const int top = kMargin - kBottom;
        for (int y = 0; y < kHeight + kMargin; ++y) {
            for (int x = 0; x < kWidth + kMargin; ++x) {
                const int there_x = x - kLeft, there_y = y - top;
                const bool inside =
                    there_x >= 0 && there_x < kWidth && there_y >= 0 && there_y < kHeight;
                const int expected = inside ? alone[3 * (there_y * kWidth + there_x)] : 51;
                // Elsewhere, pixels' places are other numbers.
                ASSERT_NEAR(codes[3 * (y * (kWidth + kMargin) + x)], expected, inside ? 1 : 0)
                    << x << ", " << y << (with_depth ? ", with depth" : "");
            }
        }
    }
}

TEST_F(ViewerTest, ShowsDifferencesInFalseColours) {
    Viewer viewer = make_viewer(small_scene());
    Screen screen(kWidth, kHeight);
    viewer.set_comparison(
        {.showing = Showing::difference, .other = Method::cube, .wipe = 0, .full_scale = 0.1});
    for (const int code : screen.show(viewer)) ASSERT_EQ(code, 0);

    constexpr double kScale = 0.5;
    viewer.set_comparison({.showing = Showing::difference,
                           .other = Method::sphere_stale,
                           .wipe = 0,
                           .full_scale = kScale});
    const std::vector<int> shown = screen.show(viewer);
    const std::vector<int> a = rendered(viewer, Method::cube, 1);
    const std::vector<int> b = rendered(viewer, Method::sphere_stale, 1);
    int whites = 0, blacks = 0;
    for (std::size_t i = 0; i < shown.size(); i += 3) {
        int apart = 0;
        for (std::size_t c = 0; c < 3; ++c) apart = std::max(apart, std::abs(a[i + c] - b[i + c]));
        if (apart > kScale * 255 + 2) {
            ++whites;
            ASSERT_EQ(shown[i] + shown[i + 1] + shown[i + 2], 3 * 255);
        } else if (apart == 0) {
            ++blacks;
            ASSERT_LE(shown[i] + shown[i + 1] + shown[i + 2], 8);
        }
    }
    EXPECT_GT(whites, 20);
    EXPECT_GT(blacks, 1000);
}

// The ray on the processor and the graphics card's triangles: what pixels see, at their centres.
// The card has positions in floats.
TEST_F(ViewerTest, HoverSeesWhatThePixelSees) {
    for (const char* material : {"mirror", "glass", "bumped"}) {
        Scene scene = small_scene(material == std::string("bumped") ? "mirror" : material);
        scene.objects[0].transform = {{0.2, 0.1, 0}, 0.5, 0.2, 0.1, {1, 0.8, 1.2}};
        if (material == std::string("bumped")) {
            scene.objects[0].material.bump.source = "ripples";
            scene.objects[0].material.bump.size = 64;
        }
        SCOPED_TRACE(material);
        const Viewer viewer = make_viewer(scene);
        gl::Renderer renderer(std::make_shared<const SceneAssets>(viewer.assets()));
        const SurfaceBuffer buffer = renderer.surfaces(scene, kWidth, kHeight);
        int on_object = 0;
        for (int y = 0; y < kHeight; y += 5) {
            for (int x = 0; x < kWidth; x += 5) {
                const Hover hover = viewer.hover(x, y, kWidth, kHeight);
                const bool is_there = gl::object_at(buffer, x, y) >= 0;
                ASSERT_EQ(hover.object.has_value(), is_there) << x << " " << y;
                if (!is_there) {
                    const Vec3d ray =
                        view_ray(scene.camera, (x + 0.5) / kWidth, (y + 0.5) / kHeight,
                                 static_cast<double>(kWidth) / kHeight);
                    ASSERT_NEAR((hover.reflected - ray).length(), 0, 1e-9);
                    continue;
                }
                ++on_object;
                const gl::Seen seen = gl::seen_at(buffer, x, y, scene.camera.eye);
                ASSERT_NEAR((hover.position - seen.position).length(), 0, 1e-4);
                if (material == std::string("bumped")) {
                    ASSERT_NEAR(hover.normal.length(), 1, 1e-9);
                    continue;
                }
                ASSERT_NEAR((hover.normal - seen.n).length(), 0, 1e-3);
                ASSERT_NEAR((hover.reflected - seen.r()).length(), 0, 1e-3);
                if (material == std::string("glass")) {
                    ASSERT_TRUE(hover.refracted);
                    ASSERT_NEAR((*hover.refracted - seen.t(1.5)).length(), 0, 1e-3);
                }
            }
        }
        EXPECT_GT(on_object, 50);
    }
}

// In light that changes slowly: what the picture has is what the sphere map shows at the marked
// place, also of bumps that move places, and of a map that was made for another camera.
TEST_F(ViewerTest, HoverMarksWhatSphereMapsShow) {
    for (const Method method : {Method::sphere, Method::sphere_stale}) {
        Scene scene = small_scene();
        scene.method = method;
        scene.map_size = 256;
        BumpMap& bump = scene.objects[0].material.bump;
        bump.source = "ripples", bump.size = 64, bump.repeat = {1, 1};
        bump.form = BumpForm::classic, bump.filter = BumpFilter::none;
        const Viewer viewer = make_viewer(scene);
        auto assets = std::make_shared<SceneAssets>(viewer.assets());
        assets->environment = gl::smooth_environment(512);
        gl::Renderer renderer(assets);
        const Image picture = gl::radiance(renderer, scene, kWidth, kHeight);
        scene.objects[0].material.bump = {};
        const Viewer smooth = make_viewer(scene);

        const Axes shown = method == Method::sphere ? axes(scene.camera) : Axes{};
        int on_object = 0, moved = 0, apart = 0;
        for (int y = 0; y < kHeight; y += 3) {
            for (int x = 0; x < kWidth; x += 3) {
                const Hover hover = viewer.hover(x, y, kWidth, kHeight);
                if (!hover.object || hover.normal.dot(axes(scene.camera).z) < 0.3) continue;
                ++on_object;
                const MapPlace place = viewer.place_on_map(Projection::sphere, hover.reflected);
                const Vec3d there =
                    shown.to_world(SphereMap::direction(FacePoint<double>{0, place.s, place.t}));
                apart += (Vec3d(picture.rgb(x, y)) - smooth_light(there)).length() > 0.05;
                const Hover without = smooth.hover(x, y, kWidth, kHeight);
                moved += (hover.reflected - without.reflected).length() > 0.02;
            }
        }
        EXPECT_GT(on_object, 100);
        EXPECT_GT(moved, on_object / 2);
        EXPECT_LE(apart, on_object / 50) << name(method);
    }
}

TEST_F(ViewerTest, RubbishIsToldAndChangesNothing) {
    const TemporaryFolder folder;
    const auto write = [&](const std::string& name, const std::string& text) {
        std::ofstream(folder / name, std::ios::binary) << text;
        return folder / name;
    };
    Viewer viewer = make_viewer(small_scene());
    Screen screen(kWidth, kHeight);
    const std::vector<int> before = screen.show(viewer);
    const std::string state = viewer.state();
    const struct {
        std::filesystem::path path;
        const char* says;
    } rubbish[] = {
        {folder / "not-there.hdr", "not-there.hdr"},
        {write("empty.hdr", ""), "empty.hdr"},
        {write("noise.exr", std::string("\x76\x2f\x31\x01\x02\0\0\0rubbish", 15)), "noise.exr"},
        {write("text.txt", "hello"), "text.txt"},
        {write("broken.obj", "f 1 2 3\n"), "broken.obj"},
        {write("empty.obj", ""), "empty.obj"},
        {write("broken.gltf", "{"), "broken.gltf"},
        {write("broken.json", "{\"objects\": 1}"), "broken.json"},
        {write("names.json", R"({"objects": [{"mesh": "none.obj"}]})"), "none.obj"},
        {write("lost.json", R"({"environment": {"source": "lost.hdr"}})"), "lost.hdr"},
        {folder.path(), "is a folder"},
    };
    for (const auto& [path, says] : rubbish) {
        const Dropped dropped = viewer.drop(path);
        EXPECT_FALSE(dropped.taken) << path;
        EXPECT_NE(dropped.message.find(says), std::string::npos) << dropped.message;
        EXPECT_EQ(viewer.state(), state) << path;
    }
    EXPECT_EQ(screen.show(viewer), before);
}

TEST_F(ViewerTest, TakesEnvironmentsMeshesAndScenes) {
    const TemporaryFolder folder;
    write_map((folder / "light.hdr").string(), gl::builtin_environment("white"));
    std::ofstream(folder / "triangle.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    Viewer viewer = make_viewer(small_scene());
    Screen screen(kWidth, kHeight);

    EXPECT_TRUE(viewer.drop(folder / "light.hdr").taken);
    EXPECT_EQ(viewer.scene().environment.source, (folder / "light.hdr").string());
    const std::vector<int> white = screen.show(viewer);
    for (const int code : white) ASSERT_NEAR(code, white[0], 1);  // no one sees a mirror in white

    EXPECT_TRUE(viewer.drop(folder / "triangle.obj").taken);
    EXPECT_EQ(viewer.assets().meshes.at(viewer.scene().objects[0].mesh).triangle_count(), 1);

    std::ofstream(folder / "scene.json") << R"({"objects": [{"mesh": "triangle.obj"}, {}],
                                               "environment": {"source": "light.hdr"}})";
    EXPECT_TRUE(viewer.drop(folder / "scene.json").taken);
    EXPECT_EQ(viewer.scene().objects.size(), 2);
    EXPECT_EQ(viewer.folder(), folder.path());
    screen.show(viewer);
}

// A scene that cannot be drawn does not stay.
TEST_F(ViewerTest, GoesBackToTheSceneThatCouldBeDrawn) {
    Viewer viewer = make_viewer(small_scene());
    Screen screen(kWidth, kHeight);
    const std::vector<int> before = screen.show(viewer);
    Scene scene = viewer.scene();
    scene.lights.resize(17);
    viewer.set_scene(scene);
    EXPECT_THROW(viewer.draw(kWidth, kHeight), Error);
    EXPECT_TRUE(viewer.scene().lights.empty());
    EXPECT_EQ(screen.show(viewer), before);
}

TEST_F(ViewerTest, SavesScenesThatReadBack) {
    const TemporaryFolder folder;
    write_map((folder / "light.hdr").string(), gl::builtin_environment("white"));
    Viewer viewer = make_viewer(small_scene("satin-gold"));
    viewer.drop(folder / "light.hdr");
    viewer.turn_environment(20, kHeight);
    viewer.set_exposure_stops(1.5);
    viewer.save_scene(folder / "saved.json");
    const Scene saved = read_scene(folder / "saved.json");
    EXPECT_EQ(saved.environment.source, "light.hdr");  // beside it
    EXPECT_EQ(saved.objects[0].material, viewer.scene().objects[0].material);
    EXPECT_NEAR(saved.exposure, viewer.exposure(), 1e-9 * saved.exposure);
    Viewer again = make_viewer(small_scene());
    EXPECT_TRUE(again.drop(folder / "saved.json").taken);
    Screen screen(kWidth, kHeight);
    EXPECT_EQ(screen.show(viewer), screen.show(again));
    EXPECT_THROW(viewer.save_scene(folder / "none" / "saved.json"), Error);
}

TEST_F(ViewerTest, StateIsALineOfTextThatReadsBack) {
    Viewer viewer = make_viewer(small_scene("satin-plastic"));
    Scene scene = viewer.scene();
    scene.objects[0].name = "a \"ball\" & more\\";
    scene.lights.push_back(ScenePointLight{});
    scene.environment.yaw = 0.5;
    viewer.set_scene(scene);
    viewer.set_comparison(
        {.showing = Showing::wipe, .other = Method::octahedral, .wipe = 0.375, .full_scale = 0.25});
    const std::string state = viewer.state();
    EXPECT_EQ(state.find('\n'), std::string::npos);
    Viewer other = make_viewer(small_scene());
    other.set_state(state);
    EXPECT_EQ(other.state(), state);
    EXPECT_EQ(other.scene().objects, viewer.scene().objects);
    EXPECT_EQ(other.comparison(), viewer.comparison());
    for (const char* wrong : {"nothing=1", "showing=two", "wipe=x", "scene={", "other=spher",
                              "scene={\"objects\":[{\"mesh\":\"no such\"}]}"}) {
        EXPECT_THROW(other.set_state(wrong), Error) << wrong;
        EXPECT_EQ(other.state(), state) << wrong;
    }
}

TEST_F(ViewerTest, ExposureIsInStopsFromTheUsual) {
    Viewer viewer = make_viewer(small_scene());
    const double usual = viewer.exposure();
    EXPECT_EQ(viewer.exposure_stops(), 0);
    viewer.set_exposure_stops(2);
    EXPECT_NEAR(viewer.exposure(), 4 * usual, 1e-9 * usual);
    EXPECT_NEAR(viewer.exposure_stops(), 2, 1e-12);
    viewer.set_exposure_stops(0);
    EXPECT_EQ(viewer.scene().exposure, 0);
}

// The environment that is turned in the viewer is that of a scene that says so.
TEST_F(ViewerTest, TurnsTheEnvironmentAsScenesDo) {
    Viewer viewer = make_viewer(small_scene());
    Screen screen(kWidth, kHeight);
    screen.show(viewer);
    viewer.turn_environment(kHeight / 2.0, kHeight);
    EXPECT_NEAR(viewer.scene().environment.yaw, -kPi / 2, 1e-12);
    Viewer other = make_viewer(viewer.scene());
    EXPECT_EQ(screen.show(viewer), screen.show(other));
}

TEST_F(ViewerTest, EveryKeyDoesWhatItSays) {
    Viewer viewer = make_viewer(small_scene());
    Screen screen(kWidth, kHeight);
    for (const char* key :
         {"ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "+", "-", "a", "d", "s",
          "w",         "f",          "[",       "]",         ",", ".", "0", "m", "M",
          "n",         "c",          "x",       "e",         "E", "o", "O", "b"}) {
        EXPECT_TRUE(viewer.press(key, 1.5)) << key;
        EXPECT_NO_THROW(screen.show(viewer)) << key;
    }
    EXPECT_FALSE(viewer.press("?", 1.5));
    const Method method = viewer.scene().method;
    viewer.press("m", 1.5);
    EXPECT_NE(viewer.scene().method, method);
    viewer.press("M", 1.5);
    EXPECT_EQ(viewer.scene().method, method);
}

TEST_F(ViewerTest, PicturesOfMapsAreKeptUntilTheyChange) {
    Viewer viewer = make_viewer(small_scene("satin-gold"));
    const auto version = [&](MapContent content, Projection projection) {
        return viewer.map_picture(content, projection, 48).version;
    };
    const auto cube = version(MapContent::environment, Projection::cube);
    const auto sphere = version(MapContent::environment, Projection::sphere);
    const auto glossy = version(MapContent::glossy, Projection::equirect);
    EXPECT_EQ(version(MapContent::environment, Projection::cube), cube);
    viewer.orbit(10, 5, kHeight);  // sphere maps are the camera's
    EXPECT_EQ(version(MapContent::environment, Projection::cube), cube);
    EXPECT_NE(version(MapContent::environment, Projection::sphere), sphere);
    Scene scene = viewer.scene();
    scene.objects[0].material.lobe.parameter = 0.6;
    viewer.set_scene(scene);
    EXPECT_EQ(version(MapContent::environment, Projection::cube), cube);
    EXPECT_NE(version(MapContent::glossy, Projection::equirect), glossy);
    viewer.set_exposure_stops(1);
    EXPECT_NE(version(MapContent::environment, Projection::cube), cube);
}

TEST_F(ViewerTest, DrawsOnePixelAndNoObject) {
    Scene scene = small_scene();
    scene.objects.clear();
    Viewer viewer = make_viewer(scene);
    EXPECT_NO_THROW(Screen(1, 1).show(viewer));
    EXPECT_FALSE(viewer.hover(0, 0, 1, 1).object);
    viewer.frame_all(1);
    viewer.press("o", 1);
}

}  // namespace
}  // namespace mirrorball
