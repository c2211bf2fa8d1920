#include "scene_maps.h"

#include <algorithm>
#include <cmath>

namespace mirrorball::gl {
namespace {

// Maps with rims are cut out of cubes on the graphics card: sphere maps for each camera anew, and
// paraboloids because what goes on beyond their rims is then there to be filtered with.
bool is_warped(Method method) {
    const Projection projection = projection_of(method);
    return projection == Projection::sphere || projection == Projection::dual_paraboloid;
}

// The edge (of an equirect the width) of a map that is as fine as a cube whose faces have `size`.
int size_as_fine(const EnvironmentMap& environment, Projection projection, int size) {
    const double finer = static_cast<double>(mirror_map_size(environment, projection)) /
                         mirror_map_size(environment, Projection::cube);
    return static_cast<int>(std::lround(finer * size));
}

// Methods that find the place on the map at the vertices cannot choose a roughness at each pixel.
bool finds_pixels(Method method) {
    switch (method) {
        case Method::sphere_vertex:
        case Method::cube_vertex:
        case Method::cube_split:
        case Method::dual_paraboloid_vertex:
        case Method::dual_paraboloid_passes:
            return false;
        default:
            return true;
    }
}

MapTextures upload_all(const ReflectionMaps& maps, Method method) {
    const auto take = [&](const EnvironmentMap& map) {
        return method == Method::cube_seams ? upload_face_array(map) : upload(map);
    };
    MapTextures textures;
    textures.mirror = take(maps.mirror);
    textures.diffuse = take(maps.diffuse);
    if (maps.rough.level_count() > 0) textures.rough = take(maps.rough);
    for (const EnvironmentMap& map : maps.glossy) textures.glossy.push_back(take(map));
    if (method == Method::cube_split) {
        textures.mirror_faces = upload_faces(maps.mirror);
        for (const EnvironmentMap& map : maps.glossy)
            textures.glossy_faces.push_back(upload_faces(map));
    }
    return textures;
}

}  // namespace

SceneMaps::SceneMaps(const EnvironmentMap& environment, Method method, int size,
                     std::span<const Lobe> lobes, bool rough)
    : method_(method),
      size_(size),
      lobes_(lobes.begin(), lobes.end()) {
    const Projection projection = is_warped(method) ? Projection::cube : projection_of(method);
    axes_ = default_axes(projection);
    const int map_size = size_as_fine(environment, projection, size);
    // Before it takes time and memory.
    check_texture_size(target_for(projection), map_size, 1);
    const ReflectionMapOptions options{.rough = rough && finds_pixels(method)};
    maps_ = upload_all(
        make_reflection_maps(environment, lobes, projection, map_size, axes_, options), method);
    if (is_warped(method)) warped_.emplace(method, maps_);
}

void SceneMaps::look_from(const Axes& camera) {
    const bool for_camera = projection_of(method_) == Projection::sphere;
    if (!warped_ || (made_for_ && (!for_camera || *made_for_ == camera))) return;
    warped_->make(maps_, axes_, camera);
    made_for_ = camera;
}

LookupMaps SceneMaps::lookup(const Material& material, const SceneEnvironment& environment) const {
    const auto found = std::find(lobes_.begin(), lobes_.end(), material.lobe);
    return {method_,
            warped_ ? warped_->axes() : axes_,
            &shown(),
            &shown().diffuse,
            static_cast<std::size_t>(found - lobes_.begin()),
            mirror_alpha(size_),
            environment.intensity,
            environment.proxy,
            environment.captured_at};
}

}  // namespace mirrorball::gl
