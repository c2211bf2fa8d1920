#include "warp.h"

#include <algorithm>
#include <string>

#include "check.h"
#include "framebuffer_guard.h"
#include "map_textures.h"

namespace mirrorball::gl {
namespace {

std::string target(Warp::Shape shape) {
    return "TARGET " + std::to_string(static_cast<int>(shape));
}

}  // namespace

void Warp::operator()(const Texture& cube, const Axes& cube_axes, Shape shape, const Axes& axes,
                      const Texture& into, int layer, int face) {
    const Program& program = programs_.get("full.vert", "warp.frag", {target(shape)});
    program.use();
    draw(program, cube, cube_axes, axes, into, 0, layer, face);
}

void Warp::level(int level, const Texture& cube, const Axes& cube_axes, Shape shape,
                 const Axes& axes, const Texture& into, int layer, int face) {
    const Program& program =
        programs_.get("full.vert", "warp.frag", {target(shape), "LEVEL_KNOWN"});
    program.use();
    program.set("u_level", static_cast<float>(level));
    draw(program, cube, cube_axes, axes, into, level, layer, face);
}

void Warp::draw(const Program& program, const Texture& cube, const Axes& cube_axes,
                const Axes& axes, const Texture& into, int level, int layer, int face) {
    const FramebufferGuard guard;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    if (into.target == GL_TEXTURE_2D_ARRAY) {
        glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, into.name.name(), level,
                                  layer);
    } else {
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, into.target, into.name.name(),
                               level);
    }
    check_framebuffer("warping a map");
    const int width = std::max(1, into.width >> level), height = std::max(1, into.height >> level);
    glViewport(0, 0, width, height);
    glDisable(GL_DEPTH_TEST);
    make_cubes_seamless();

    cube.bind(0);
    program.set("u_cube", 0);
    program.set("u_face", face);
    program.set("u_size", Imath::V2f(static_cast<float>(width), static_cast<float>(height)));
    // From the new map's frame to the world, and from there to the cube's.
    const Axes turn{cube_axes.to_map(axes.x), cube_axes.to_map(axes.y), cube_axes.to_map(axes.z)};
    program.set("u_to_cube", to_map_matrix(turn).transposed());
    glBindVertexArray(nothing_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    check("warping a map");
}

}  // namespace mirrorball::gl
