#include "dynamic_maps.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <mirrorball/projections/cube.h>

namespace mirrorball::gl {
namespace {

// Nothing nearer to the middle of an object than this share of its own radius is in its map.
constexpr double kNearest = 0.01;

const Axes& cube_axes() {
    static const Axes axes = default_axes(Projection::cube);
    return axes;
}

// Maps of depth n need those of depth n - 1 and no others, so two sets take turns; unless only some
// of the faces are drawn and the rest has to stay.
int stored_depth_count(const ObjectMaps::Key& key) {
    const bool all_faces = key.settings.faces_per_frame == Cube::face_count;
    return all_faces ? std::min(2, key.depth_count) : key.depth_count;
}

// From the middle of its bounds, as the transform takes it along.
std::vector<View> views_from(const SceneObject& object, const Bounds& bounds) {
    const Vec3d& scale = object.transform.scale;
    const double largest = std::max({std::abs(scale.x), std::abs(scale.y), std::abs(scale.z)});
    const double nearest = kNearest * std::max(bounds.radius * largest, 1e-6);
    std::vector<View> views;
    for (int face = 0; face < Cube::face_count; ++face) {
        views.push_back(
            face_view(object.transform.point(bounds.centre()), cube_axes(), face, nearest));
    }
    return views;
}

}  // namespace

std::vector<int> FaceTurns::next(int count) {
    if (!all_drawn_) count = Cube::face_count;
    all_drawn_ = true;
    std::vector<int> faces(static_cast<std::size_t>(count));
    for (int& face : faces) face = std::exchange(next_, (next_ + 1) % Cube::face_count);
    return faces;
}

ObjectMaps::ObjectMaps(const Key& key) : key_(key) {
    for (int i = 0; i < stored_depth_count(key); ++i)
        cubes_.push_back(MapFilter::room(key.settings.size, key.material));
    if (MethodMaps::needed_for(key.method)) shown_.emplace(key.method, cubes_.front());
}

const MapTextures& ObjectMaps::cubes(int depth) const {
    const int index = std::min(depth, key_.depth_count) - 1;
    return cubes_[static_cast<std::size_t>(index) % cubes_.size()];
}

void ObjectMaps::make_shown(const Axes& camera) {
    if (shown_) shown_->make(cubes(key_.depth_count), cube_axes(), camera);
}

// They hold radiance as it is, and what they show is seen from the object itself: no proxy. There
// is no GGX chain: made for each picture, it would cost more than all else.
LookupMaps ObjectMaps::lookup_cubes(int depth) const {
    const MapTextures& textures = cubes(depth);
    return {Method::cube, cube_axes(), &textures, &textures.diffuse, 0, false, 0, 1, {}, Vec3d(0)};
}

LookupMaps ObjectMaps::lookup_shown() const {
    LookupMaps maps = lookup_cubes(key_.depth_count);
    maps.method = key_.method;
    if (!shown_) return maps;
    maps.axes = shown_->axes();
    maps.textures = &shown_->textures();
    if (!maps.textures->diffuse.empty()) maps.diffuse = &maps.textures->diffuse;
    return maps;
}

std::uint64_t ObjectMaps::bytes() const {
    return std::accumulate(
        cubes_.begin(), cubes_.end(), shown_ ? shown_->textures().bytes() : std::uint64_t{0},
        [](std::uint64_t sum, const MapTextures& cubes) { return sum + cubes.bytes(); });
}

void DynamicMaps::make_room(const Scene& scene) {
    const auto dynamic_count =
        std::count_if(scene.objects.begin(), scene.objects.end(),
                      [](const SceneObject& object) { return object.dynamic.has_value(); });
    objects_.resize(scene.objects.size());
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        const SceneObject& object = scene.objects[i];
        if (!object.dynamic) {
            objects_[i].reset();
            continue;
        }
        // One alone has nobody to send light to and fro with.
        const int depth_count = dynamic_count > 1 ? object.dynamic->bounces : 1;
        ObjectMaps::Key key{*object.dynamic, object.material, object.mesh, scene.method,
                            depth_count};
        if (objects_[i] && objects_[i]->key() == key) continue;
        objects_[i].reset();  // before the new one takes memory
        objects_[i] = std::make_unique<ObjectMaps>(key);
    }
}

const CubeTarget& DynamicMaps::target_for(const DynamicReflection& settings) {
    const auto found =
        std::find_if(targets_.begin(), targets_.end(), [&](const CubeTarget& target) {
            return target.size() == settings.size && target.drawing() == settings.drawing;
        });
    if (found != targets_.end()) return *found;
    return targets_.emplace_back(settings.size, settings.drawing);
}

void DynamicMaps::draw_cube(const Scene& scene, std::size_t object, int depth,
                            std::span<const int> faces, Painter& painter,
                            const SceneMaps& environment_cubes) {
    const SceneObject& self = scene.objects[object];
    const std::vector<View> views = views_from(self, painter.buffers_of(self).bounds());
    const auto draw = [&](std::span<const View> seen_from) {
        const Shot shot{seen_from, Output::half_floats, self.dynamic->size};
        painter.begin();
        for (std::size_t i = 0; i < scene.objects.size(); ++i) {
            if (i == object) continue;
            const SceneObject& other = scene.objects[i];
            const bool mirrors_others = objects_[i] && depth > 1;
            painter.object(scene, other,
                           mirrors_others
                               ? objects_[i]->lookup_cubes(depth - 1)
                               : environment_cubes.lookup(other.material, scene.environment),
                           shot);
        }
        painter.background(scene, shot, false);
    };
    const MapTextures& cubes = objects_[object]->cubes(depth);
    target_for(*self.dynamic).draw(cubes.mirror, views, faces, draw);
    filter_.make(cubes, self.material);
}

void DynamicMaps::update(const Scene& scene, Painter& painter, const SceneMaps& environment_cubes) {
    make_room(scene);
    updates_.clear();
    int deepest = 0;
    std::vector<std::vector<int>> faces(objects_.size());
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        if (!objects_[i]) continue;
        const ObjectMaps::Key& key = objects_[i]->key();
        faces[i] = objects_[i]->turns().next(key.settings.faces_per_frame);
        deepest = std::max(deepest, key.depth_count);
        updates_.push_back({i, faces[i], key.depth_count});
    }
    for (int depth = 1; depth <= deepest; ++depth) {
        for (std::size_t i = 0; i < objects_.size(); ++i) {
            if (!objects_[i] || depth > objects_[i]->key().depth_count) continue;
            draw_cube(scene, i, depth, faces[i], painter, environment_cubes);
        }
    }
    const Axes camera = axes(scene.camera);
    for (const auto& maps : objects_) {
        if (maps) maps->make_shown(camera);
    }
}

std::optional<LookupMaps> DynamicMaps::lookup(std::size_t object) const {
    if (object >= objects_.size() || !objects_[object]) return std::nullopt;
    return objects_[object]->lookup_shown();
}

std::uint64_t DynamicMaps::bytes() const {
    std::uint64_t sum = 0;
    for (const auto& maps : objects_) sum += maps ? maps->bytes() : 0;
    return sum;
}

}  // namespace mirrorball::gl
