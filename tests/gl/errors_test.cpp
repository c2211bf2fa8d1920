// What goes wrong is said: what was asked for, what was found, what to do.
#include <cstdio>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mirrorball/error.h>

#include "gl/gl.h"
#include "gl/program.h"
#include "gl/target.h"
#include "gl/texture.h"
#include "gl_test.h"

namespace mirrorball::gl {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class Errors : public GlTest {};

template <class Do>
void expect_error(Errc code, Do work, const ::testing::Matcher<std::string>& message) {
    try {
        work();
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        EXPECT_THAT(std::string(error.what()), message);
    }
}

TEST_F(Errors, ATextureIsTooLarge) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    expect_error(
        Errc::unsupported, [&] { (void)make_texture(GL_TEXTURE_2D, largest + 1, 1, 1); },
        AllOf(HasSubstr(std::to_string(largest + 1)), HasSubstr(std::to_string(largest) + " x ")));
    glGetIntegerv(GL_MAX_CUBE_MAP_TEXTURE_SIZE, &largest);
    expect_error(
        Errc::unsupported,
        [&] { (void)make_texture(GL_TEXTURE_CUBE_MAP, 2 * largest, 2 * largest, 1, 6); },
        HasSubstr(std::to_string(largest) + " x "));
}

// Refused before memory is taken for it, by every method.
TEST_F(Errors, AMapIsTooLarge) {
    Renderer renderer(assets_in(smooth_environment()));
    for (const Method method : all_methods()) {
        Scene scene = scene_with("sphere", mirror_material(), method);
        scene.map_size = 1 << 20;
        expect_error(
            Errc::unsupported, [&] { (void)radiance(renderer, scene, 16, 16); },
            AllOf(HasSubstr("texels was asked for"), HasSubstr("at most")));
    }
}

TEST_F(Errors, APictureIsTooLarge) {
    Renderer renderer(assets_in(smooth_environment()));
    const Scene scene = scene_with("sphere", mirror_material(), Method::cube);
    GLint largest = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
    expect_error(
        Errc::unsupported, [&] { (void)radiance(renderer, scene, largest + 1, 2); },
        AllOf(HasSubstr(std::to_string(largest + 1)), HasSubstr("at most")));
    expect_error(
        Errc::usage, [&] { (void)radiance(renderer, scene, 0, 2); }, HasSubstr("width"));
    expect_error(
        Errc::usage,
        [&] {
            (void)renderer.picture(scene, {16, 16, 2000, true, {}});
        },
        AllOf(HasSubstr("samples"), HasSubstr("2000")));
    // and then goes on
    EXPECT_EQ(radiance(renderer, scene, 16, 8).height(), 8);
}

TEST_F(Errors, AnOpenGlErrorIsAnError) {
    Renderer renderer(assets_in(smooth_environment()));
    const Scene scene = scene_with("sphere", mirror_material(), Method::cube);
    const Image before = radiance(renderer, scene, 16, 16);
    glEnable(0xdead);
    expect_error(
        Errc::unsupported, [&] { (void)radiance(renderer, scene, 16, 16); },
        AllOf(HasSubstr("OpenGL failed"), HasSubstr("GL_INVALID_ENUM")));
    // It is told once.
    const Image after = radiance(renderer, scene, 16, 16);
    EXPECT_TRUE(std::equal(before.values().begin(), before.values().end(), after.values().begin()));
}

TEST_F(Errors, AShaderDoesNotCompile) {
    expect_error(
        Errc::unsupported,
        [] {
            Program("surface.vert", "surface.frag", {"METHOD CUBE", "COUPLING oh dear"});
        },
        AllOf(HasSubstr("surface.frag"), HasSubstr("COUPLING oh dear"), HasSubstr("error")));
    expect_error(
        Errc::unsupported, [] { Program("surface.vert", "no.frag"); }, HasSubstr("\"no.frag\""));
}

TEST_F(Errors, TooManyLights) {
    Renderer renderer(assets_in(smooth_environment()));
    Scene scene = scene_with("sphere", diffuse_material(), Method::cube);
    scene.lights.assign(16, ScenePointLight{});
    EXPECT_NO_THROW((void)radiance(renderer, scene, 16, 16));
    scene.lights.assign(17, ScenePointLight{});
    expect_error(
        Errc::usage, [&] { (void)radiance(renderer, scene, 16, 16); },
        AllOf(HasSubstr("16"), HasSubstr("17")));
}

TEST_F(Errors, SamplesAreCancelled) {
    Renderer renderer(assets_in(smooth_environment()));
    const Scene scene = scene_with("sphere", mirror_material(), Method::cube);
    int calls = 0;
    expect_error(
        Errc::cancelled,
        [&] {
            (void)renderer.picture(scene, {16, 16, 100, true, [&](double share) {
                                               ++calls;
                                               return share < 0.03;
                                           }});
        },
        HasSubstr("cancelled"));
    EXPECT_EQ(calls, 3);
}

// In processes of their own, in which nothing has touched EGL yet.
[[noreturn]] void make_context_without_drivers() {
    setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent", 1);
    try {
        const Context context(Api::es);
    } catch (const Error& error) {
        std::fputs(error.what(), stderr);
        std::exit(error.code() == Errc::unsupported ? 5 : 1);
    }
    std::exit(0);
}

TEST(NoDriverDeathTest, SaysWhatWasAskedAndWhatToInstall) {
    ::testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_EXIT(make_context_without_drivers(), ::testing::ExitedWithCode(5),
                "OpenGL ES 3.0.*asked for.*EGL.*apt-get install.*libgl1-mesa-dri");
}

}  // namespace
}  // namespace mirrorball::gl
