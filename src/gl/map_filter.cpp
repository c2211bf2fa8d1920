#include "map_filter.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <mirrorball/projections/cube.h>
#include <mirrorball/reflection_maps.h>

#include "check.h"
#include "framebuffer_guard.h"
#include "lobe_taps.h"

namespace mirrorball::gl {
namespace {

// Faces of the irradiance, and of the level that it is a sum over.
constexpr int kDiffuseFace = 16, kDiffuseSourceFace = 16;

Texture cube_room(int size, bool levels) {
    const int level_count = levels ? 1 + static_cast<int>(std::log2(size)) : 1;
    return make_texture(GL_TEXTURE_CUBE_MAP, size, size, level_count, Cube::face_count);
}

// What can be looked up until further notice.
void show_levels(const Texture& cube, int first, int last) {
    cube.bind(0);
    glTexParameteri(cube.target, GL_TEXTURE_BASE_LEVEL, first);
    glTexParameteri(cube.target, GL_TEXTURE_MAX_LEVEL, last);
}

}  // namespace

MapTextures MapFilter::room(int size, const Material& material) {
    MapTextures maps;
    maps.mirror = cube_room(size, true);
    if (material.glossy > 0) {
        const int wanted = glossy_map_size(material.lobe, Projection::cube);
        maps.glossy.push_back(cube_room(std::min(size, wanted), false));
    }
    if (material.diffuse > 0) maps.diffuse = cube_room(std::min(size, kDiffuseFace), false);
    return maps;
}

void MapFilter::make(const MapTextures& maps, const Material& material) {
    make_levels(maps.mirror);
    if (!maps.glossy.empty()) blur(maps.mirror, material.lobe, maps.glossy[0]);
    if (!maps.diffuse.empty()) make_irradiance(maps.mirror, maps.diffuse);
}

void MapFilter::draw_faces(const Program& program, const Texture& into, int level) const {
    const FramebufferGuard guard;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    const int size = std::max(1, into.width >> level);
    glViewport(0, 0, size, size);
    glDisable(GL_DEPTH_TEST);
    if (epoxy_is_desktop_gl()) glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    glBindVertexArray(nothing_.name());
    program.set("u_size", static_cast<float>(size));
    for (int face = 0; face < Cube::face_count; ++face) {
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
                               GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face),
                               into.name.name(), level);
        if (face == 0) check_framebuffer("filtering a cube map");
        program.set("u_face", face);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    check("filtering a cube map");
}

void MapFilter::make_levels(const Texture& cube) {
    const Program& program = programs_.get("full.vert", "halve.frag");
    program.use();
    program.set("u_cube", 0);
    for (int level = 1; level < cube.level_count; ++level) {
        show_levels(cube, level - 1, level - 1);
        program.set("u_step", 0.75f / static_cast<float>(std::max(1, cube.width >> (level - 1))));
        draw_faces(program, cube, level);
    }
    show_levels(cube, 0, cube.level_count - 1);
}

const std::vector<Imath::V4f>& MapFilter::taps_for(const Lobe& lobe, int source_size) {
    const auto found = std::find_if(taps_.begin(), taps_.end(), [&](const Taps& taps) {
        return taps.lobe == lobe && taps.source_size == source_size;
    });
    if (found != taps_.end()) return found->taps;
    // A texel's edge in the middle of a face is 2 / size.
    return taps_.emplace_back(Taps{lobe, source_size, lobe_taps(lobe, 2.0 / source_size)}).taps;
}

void MapFilter::blur(const Texture& cube, const Lobe& lobe, const Texture& into, int level) {
    const std::vector<Imath::V4f>& taps = taps_for(lobe, cube.width);
    const Program& program =
        programs_.get("full.vert", "blur.frag", {fmt::format("TAP_COUNT {}", taps.size())});
    program.use();
    cube.bind(0);
    program.set("u_cube", 0);
    program.set("u_taps", taps);
    draw_faces(program, into, level);
}

void MapFilter::make_irradiance(const Texture& cube, const Texture& into) {
    int level = 0;
    while (cube.width >> level > kDiffuseSourceFace) ++level;
    const Program& program = programs_.get("full.vert", "irradiance.frag");
    program.use();
    cube.bind(0);
    program.set("u_cube", 0);
    program.set("u_level", level);
    draw_faces(program, into, 0);
}

}  // namespace mirrorball::gl
