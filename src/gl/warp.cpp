#include "warp.h"

#include "check.h"
#include "framebuffer_guard.h"
#include "map_textures.h"

namespace mirrorball::gl {

void Warp::operator()(const Texture& cube, const Axes& cube_axes, Shape shape, const Axes& axes,
                      const Texture& into, int layer, int face) {
    const FramebufferGuard guard;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    if (into.target == GL_TEXTURE_2D_ARRAY) {
        glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, into.name.name(), 0, layer);
    } else {
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, into.target, into.name.name(),
                               0);
    }
    check_framebuffer("warping a map");
    glViewport(0, 0, into.width, into.height);
    glDisable(GL_DEPTH_TEST);
    make_cubes_seamless();

    const Program& program = programs_.get("full.vert", "warp.frag",
                                           {"TARGET " + std::to_string(static_cast<int>(shape))});
    program.use();
    cube.bind(0);
    program.set("u_cube", 0);
    program.set("u_face", face);
    program.set("u_size",
                Imath::V2f(static_cast<float>(into.width), static_cast<float>(into.height)));
    // From the new map's frame to the world, and from there to the cube's.
    const Axes turn{cube_axes.to_map(axes.x), cube_axes.to_map(axes.y), cube_axes.to_map(axes.z)};
    program.set("u_to_cube", to_map_matrix(turn).transposed());
    glBindVertexArray(nothing_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    check("warping a map");
}

}  // namespace mirrorball::gl
