// What stands behind a window: a Viewer that another program moves and draws into a framebuffer of
// its own.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <vector>

#include <epoxy/gl.h>

#include <mirrorball/error.h>
#include <mirrorball/gl/context.h>
#include <mirrorball/material_presets.h>
#include <mirrorball/viewer.h>

using namespace mirrorball;

namespace {

constexpr int kWidth = 160, kHeight = 90;
constexpr int kSkipped = 77;

void bind_framebuffer() {
    GLuint framebuffer = 0, colors = 0;
    glGenFramebuffers(1, &framebuffer);
    glGenRenderbuffers(1, &colors);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glBindRenderbuffer(GL_RENDERBUFFER, colors);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, kWidth, kHeight);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colors);
}

std::vector<std::uint8_t> drawn(Viewer& viewer) {
    viewer.draw(kWidth, kHeight);
    std::vector<std::uint8_t> codes(std::size_t{4} * kWidth * kHeight);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, codes.data());
    return codes;
}

}  // namespace

int main() {
    std::unique_ptr<gl::Context> context;
    try {
        context = std::make_unique<gl::Context>();
    } catch (const Error& error) {
        std::printf("skipped: %s\n", error.what());
        return kSkipped;
    }
    bind_framebuffer();

    Scene scene;
    scene.environment.source = "builtin:axes";
    scene.objects.push_back({.name = "pot", .mesh = "teapot", .material = preset_material("gold")});
    Viewer viewer(scene, {}, {.sample_count = 1});
    viewer.frame_all(static_cast<double>(kWidth) / kHeight);
    const std::vector<std::uint8_t> before = drawn(viewer);
    viewer.orbit(30, 0, kHeight);
    const std::vector<std::uint8_t> after = drawn(viewer);

    const auto [least, most] = std::minmax_element(before.begin(), before.end());
    const bool shows_something = *most - *least > 100, turns = before != after;
    std::printf("%s: a picture from %d to %d, %s\n", gl::driver().renderer.c_str(), *least, *most,
                turns ? "which turns" : "which does not turn");
    return shows_something && turns ? 0 : 1;
}
