// DynamicMaps: what the objects that reflect each other see, made anew for each picture.
//
// An object's map is drawn from the middle of its bounds, without itself. Maps have depths. Those
// of depth 1 show the other objects as they look in the environment alone; those of depth n show
// them with their maps of depth n - 1. So no map needs one that is drawn in the same round, the
// order of objects does not matter, and the last mirror in a mirror shows the environment.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <mirrorball/gl/renderer.h>
#include <mirrorball/scene.h>

#include "cube_target.h"
#include "map_filter.h"
#include "method_maps.h"
#include "painter.h"
#include "scene_maps.h"

namespace mirrorball::gl {

/// How faces are updated in turn.
class FaceTurns {
  public:
    /// All six at first, then `count` for each call, one after the other.
    std::vector<int> next(int count);

  private:
    int next_ = 0;
    bool all_drawn_ = false;
};

/// Those of one object.
class ObjectMaps {
  public:
    /// What they are made for; if it changes, they are made anew.
    struct Key {
        DynamicReflection settings;
        Material material;
        std::string mesh;
        Method method;
        int depth_count;
        bool operator==(const Key&) const = default;
    };
    explicit ObjectMaps(const Key& key);

    [[nodiscard]] const Key& key() const { return key_; }
    [[nodiscard]] FaceTurns& turns() { return turns_; }

    /// Those of a depth from 1 on; of what is deeper than any, the deepest.
    [[nodiscard]] const MapTextures& cubes(int depth) const;
    /// In the shape of the method, from the deepest.
    void make_shown(const Axes& camera);
    [[nodiscard]] LookupMaps lookup_cubes(int depth) const;
    [[nodiscard]] LookupMaps lookup_shown() const;
    [[nodiscard]] std::uint64_t bytes() const;

  private:
    Key key_;
    FaceTurns turns_;
    std::vector<MapTextures> cubes_;
    std::optional<MethodMaps> shown_;
};

class DynamicMaps {
  public:
    /// Draws all maps of a scene's dynamic objects. `environment_cubes` are what others reflect.
    void update(const Scene& scene, Painter& painter, const SceneMaps& environment_cubes);

    /// The maps of an object as the scene's method looks them up; none if it is not dynamic.
    [[nodiscard]] std::optional<LookupMaps> lookup(std::size_t object) const;
    [[nodiscard]] const std::vector<FaceUpdate>& updates() const { return updates_; }
    [[nodiscard]] std::uint64_t bytes() const;

  private:
    void make_room(const Scene& scene);
    const CubeTarget& target_for(const DynamicReflection& settings);
    void draw_cube(const Scene& scene, std::size_t object, int depth, std::span<const int> faces,
                   Painter& painter, const SceneMaps& environment_cubes);

    std::vector<std::unique_ptr<ObjectMaps>> objects_;  // as in the scene; none if not dynamic
    std::vector<CubeTarget> targets_;
    std::vector<FaceUpdate> updates_;
    MapFilter filter_;
};

}  // namespace mirrorball::gl
