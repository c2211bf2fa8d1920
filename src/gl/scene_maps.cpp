#include "scene_maps.h"

#include <algorithm>
#include <cmath>

#include "check.h"

namespace mirrorball::gl {
namespace {

bool is_sphere(Method method) {
    return projection_of(method) == Projection::sphere;
}

// The edge (of an equirect the width) of a map that is as fine as a cube whose faces have `size`.
int size_as_fine(const EnvironmentMap& environment, Projection projection, int size) {
    const double finer = static_cast<double>(mirror_map_size(environment, projection)) /
                         mirror_map_size(environment, Projection::cube);
    return static_cast<int>(std::lround(finer * size));
}

int full_level_count(int size) {
    return 1 + static_cast<int>(std::log2(size));
}

MapTextures upload_all(const ReflectionMaps& maps, Method method) {
    const auto take = [&](const EnvironmentMap& map) {
        return method == Method::cube_seams ? upload_face_array(map) : upload(map);
    };
    MapTextures textures{take(maps.mirror), {}, take(maps.diffuse)};
    for (const EnvironmentMap& map : maps.glossy) textures.glossy.push_back(take(map));
    return textures;
}

// Room for a sphere map as fine as a cube: twice its edge, which at the centre is as many texels a
// degree.
Texture sphere_for(const Texture& cube) {
    const int size = 2 * cube.width;
    const bool mips = cube.level_count > 1;
    return make_texture(GL_TEXTURE_2D, size, size, mips ? full_level_count(size) : 1);
}

MapTextures spheres_for(const MapTextures& cubes) {
    MapTextures spheres{sphere_for(cubes.mirror), {}, sphere_for(cubes.diffuse)};
    for (const Texture& cube : cubes.glossy) spheres.glossy.push_back(sphere_for(cube));
    return spheres;
}

}  // namespace

Imath::M33f to_map_matrix(const Axes& axes) {
    const auto& [x, y, z] = axes;
    return Imath::M33f(x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z);
}

std::uint64_t MapTextures::bytes() const {
    std::uint64_t sum = mirror.bytes() + diffuse.bytes();
    for (const Texture& texture : glossy) sum += texture.bytes();
    return sum;
}

void Warp::operator()(const Texture& cube, const Axes& cube_axes, Shape shape, const Axes& axes,
                      const Texture& into, int layer) {
    GLint drawn_into = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &drawn_into);
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
    if (epoxy_is_desktop_gl()) glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);

    const Program& program = programs_.get("full.vert", "warp.frag",
                                           {"TARGET " + std::to_string(static_cast<int>(shape))});
    program.use();
    cube.bind(0);
    program.set("u_cube", 0);
    program.set("u_size", static_cast<float>(into.width));
    // From the new map's frame to the world, and from there to the cube's.
    const Axes turn{cube_axes.to_map(axes.x), cube_axes.to_map(axes.y), cube_axes.to_map(axes.z)};
    program.set("u_to_cube", Imath::M33f(turn.x.x, turn.x.y, turn.x.z, turn.y.x, turn.y.y, turn.y.z,
                                         turn.z.x, turn.z.y, turn.z.z));
    glBindVertexArray(nothing_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);

    if (into.level_count > 1) {
        into.bind(0);
        glGenerateMipmap(into.target);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(drawn_into));
    check("warping a map");
}

SceneMaps::SceneMaps(const EnvironmentMap& environment, Method method, int size,
                     std::span<const Lobe> lobes)
    : method_(method),
      lobes_(lobes.begin(), lobes.end()) {
    // Sphere maps are made from the six faces, for each camera anew.
    const Projection projection = is_sphere(method) ? Projection::cube : projection_of(method);
    axes_ = source_axes_ = default_axes(projection);
    const int map_size = size_as_fine(environment, projection, size);
    // Before it takes time and memory.
    check_texture_size(target_for(projection), map_size, 1);
    const ReflectionMaps maps =
        make_reflection_maps(environment, lobes, projection, map_size, source_axes_);
    maps_ = upload_all(maps, method);
    if (is_sphere(method)) warped_.push_back(spheres_for(maps_));
    if (method == Method::cube_split) {
        mirror_faces_ = upload_faces(maps.mirror);
        for (const EnvironmentMap& map : maps.glossy) glossy_faces_.push_back(upload_faces(map));
    }
}

void SceneMaps::look_from(const Axes& camera) {
    if (!is_sphere(method_)) return;
    // GL_SPHERE_MAP works in the eye's frame whatever the map was made for.
    axes_ = camera;
    const Axes made_for = method_ == Method::sphere_stale ? Axes{} : camera;
    MapTextures& spheres = warped_[0];
    const auto warp = [&](const Texture& cube, const Texture& sphere) {
        warp_(cube, source_axes_, Warp::Shape::sphere, made_for, sphere);
    };
    warp(maps_.mirror, spheres.mirror);
    warp(maps_.diffuse, spheres.diffuse);
    for (std::size_t i = 0; i < spheres.glossy.size(); ++i)
        warp(maps_.glossy[i], spheres.glossy[i]);
}

std::size_t SceneMaps::index_of(const Lobe& lobe) const {
    return static_cast<std::size_t>(std::find(lobes_.begin(), lobes_.end(), lobe) - lobes_.begin());
}

const Texture& SceneMaps::glossy(const Lobe& lobe) const {
    return shown().glossy[index_of(lobe)];
}

const Texture& SceneMaps::glossy_face(const Lobe& lobe, int face) const {
    return glossy_faces_[index_of(lobe)][face];
}

std::uint64_t SceneMaps::bytes() const {
    return shown().bytes();
}

}  // namespace mirrorball::gl
