// Scenes to JSON: what differs from a scene that nobody touched.
#include <cmath>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <mirrorball/scene_file.h>

#include "scene/scene_fields.h"

namespace mirrorball {
namespace detail {
namespace {

using Json = nlohmann::ordered_json;

Json array(const Vec3d& v) {
    return Json::array({v.x, v.y, v.z});
}

Json one_or_three(const Vec3d& v) {
    return v.x == v.y && v.y == v.z ? Json(v.x) : array(v);
}

// The shortest number of degrees that reads as these radians, or the nearest: not all do.
double degrees_that_read_as(double radians) {
    const auto reads = [&](double degrees) { return degrees * kPi / 180 == radians; };
    const double degrees = radians * 180 / kPi;
    const double rounded = std::round(degrees * 1e9) / 1e9;
    if (reads(rounded)) return rounded;
    double below = degrees, above = degrees;
    for (int i = 0; i < 4; ++i) {
        if (reads(below)) return below;
        if (reads(above)) return above;
        below = std::nextafter(below, -1e9), above = std::nextafter(above, 1e9);
    }
    return degrees;
}

// A visitor of scene_fields.h that keeps each member as JSON.
class Members {
  public:
    void number(const char* key, double value, double, double) { add(key, value); }
    void degrees(const char* key, double value, double, double) {
        add(key, degrees_that_read_as(value));
    }
    void whole(const char* key, int value, int, int) { add(key, value); }
    void flag(const char* key, bool value) { add(key, value); }
    void text(const char* key, const std::string& value) { add(key, value); }
    void vector(const char* key, const Vec3d& value) { add(key, array(value)); }
    void scale(const char* key, const Vec3d& value) { add(key, one_or_three(value)); }
    void colour(const char* key, const Vec3d& value, double, double) {
        add(key, one_or_three(value));
    }
    template <class T, class Parse, class Print>
    void spelled(const char* key, const T& value, Parse&&, Print&& print) {
        add(key, print(value));
    }
    void pair(const char* key, const Imath::V2d& value, double, double) {
        add(key, value.x == value.y ? Json(value.x) : Json::array({value.x, value.y}));
    }
    void matrix(const char* key, const Imath::M22d& m, double, double) {
        add(key, Json::array({Json::array({m[0][0], m[0][1]}), Json::array({m[1][0], m[1][1]})}));
    }
    void bump(const char* key, const BumpMap& value);
    void floor(const char* key, const std::optional<Floor>& value);
    void proxy(const char* key, const Proxy& value);

    // Those that differ from what an untouched part has.
    [[nodiscard]] Json without(const Members& untouched) const {
        Json result = Json::object();
        for (std::size_t i = 0; i < members_.size(); ++i) {
            const auto& [key, value] = members_[i];
            if (value != untouched.members_[i].second) result[key] = value;
        }
        return result;
    }

  private:
    void add(const char* key, Json value) { members_.emplace_back(key, std::move(value)); }

    std::vector<std::pair<std::string, Json>> members_;
};

// `visit` shows a visitor the members of a part.
template <class Part, class Visit>
Json written(const Part& part, Visit&& visit) {
    const Part untouched;
    Members members, defaults;
    visit(members, part);
    visit(defaults, untouched);
    return members.without(defaults);
}

// So that the templates of scene_fields.h can be handed on.
#define MIRRORBALL_VISIT(function) [](auto& visitor, const auto& part) { function(visitor, part); }

void Members::proxy(const char* key, const Proxy& value) {
    Json json;
    if (const auto* box = std::get_if<BoxProxy>(&value))
        json["box"] = written(*box, MIRRORBALL_VISIT(visit_box));
    if (const auto* sphere = std::get_if<SphereProxy>(&value))
        json["sphere"] = written(*sphere, MIRRORBALL_VISIT(visit_sphere));
    add(key, json);
}

void Members::bump(const char* key, const BumpMap& value) {
    add(key, written(value, MIRRORBALL_VISIT(visit_bump)));
}

void Members::floor(const char* key, const std::optional<Floor>& value) {
    add(key, value ? written(*value, MIRRORBALL_VISIT(visit_floor)) : Json());
}

void add_unless_empty(Json& object, const char* key, Json value) {
    if (!value.empty()) object[key] = std::move(value);
}

Json written(const SceneObject& object) {
    const SceneObject untouched;
    Json json = Json::object();
    if (!object.name.empty()) json["name"] = object.name;
    if (object.mesh != untouched.mesh) json["mesh"] = object.mesh;
    add_unless_empty(json, "transform",
                     written(object.transform, MIRRORBALL_VISIT(visit_transform)));
    add_unless_empty(json, "material", written(object.material, MIRRORBALL_VISIT(visit_material)));
    if (object.dynamic) json["dynamic"] = written(*object.dynamic, MIRRORBALL_VISIT(visit_dynamic));
    return json;
}

Json written(const SceneLight& light) {
    Json json;
    if (const auto* point = std::get_if<ScenePointLight>(&light))
        json["point"] = written(*point, MIRRORBALL_VISIT(visit_point_light));
    if (const auto* sun = std::get_if<SceneDirectionalLight>(&light))
        json["directional"] = written(*sun, MIRRORBALL_VISIT(visit_directional_light));
    return json;
}

}  // namespace
}  // namespace detail

std::string to_json(const Scene& scene) {
    using namespace detail;
    Json json = Json::object();
    for (const SceneObject& object : scene.objects) json["objects"].push_back(written(object));
    add_unless_empty(json, "environment",
                     written(scene.environment, MIRRORBALL_VISIT(visit_environment)));
    for (const SceneLight& light : scene.lights) json["lights"].push_back(written(light));
    add_unless_empty(json, "camera", written(scene.camera, MIRRORBALL_VISIT(visit_camera)));
    json.update(written(scene, MIRRORBALL_VISIT(visit_picture)));
    return json.dump(2) + "\n";
}

}  // namespace mirrorball
