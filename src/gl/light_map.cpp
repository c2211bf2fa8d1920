#include "light_map.h"

#include "check.h"
#include "framebuffer_guard.h"

namespace mirrorball::gl {
namespace {

// A highlight of exponent 1000 is 5 texels wide at half its height.
constexpr int kSize = 256;

}  // namespace

LightMap::LightMap() : texture_(make_texture(GL_TEXTURE_2D_ARRAY, kSize, kSize, 1, 2)) {}

void LightMap::draw(int layer, const Program& program) {
    const FramebufferGuard guard;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture_.name.name(), 0, layer);
    check_framebuffer("making a light map");
    glViewport(0, 0, kSize, kSize);
    glDisable(GL_DEPTH_TEST);
    program.set("u_size", Imath::V2f(static_cast<float>(kSize)));
    glBindVertexArray(nothing_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEnable(GL_DEPTH_TEST);
    check("making a light map");
}

}  // namespace mirrorball::gl
