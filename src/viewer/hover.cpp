#include "hover.h"

#include <cmath>
#include <limits>
#include <optional>

#include <mirrorball/direct.h>

#include "scene/bump_lookup.h"

namespace mirrorball {
namespace {

struct Ray {
    Vec3d origin, direction;
};

struct Hit {
    double distance = std::numeric_limits<double>::infinity();
    std::size_t triangle = 0;
    double u = 0, v = 0;  // weights of the second and third corner
};

// Nearest triangle, seen from either side. Moeller and Trumbore 1997, "Fast, Minimum Storage
// Ray/Triangle Intersection". A ray of the mesh's own space: distances are the world's, as the
// direction is moved along with the origin and not made unit.
Hit nearest_hit(const Mesh& mesh, const Ray& ray) {
    Hit nearest;
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
        const Vec3d a(mesh.positions[mesh.indices[3 * i]]);
        const Vec3d ab = Vec3d(mesh.positions[mesh.indices[3 * i + 1]]) - a;
        const Vec3d ac = Vec3d(mesh.positions[mesh.indices[3 * i + 2]]) - a;
        const Vec3d p = ray.direction.cross(ac);
        const double determinant = ab.dot(p);
        if (determinant == 0) continue;
        const Vec3d from_a = ray.origin - a, q = from_a.cross(ab);
        const double u = from_a.dot(p) / determinant, v = ray.direction.dot(q) / determinant;
        if (!(u >= 0 && v >= 0 && u + v <= 1)) continue;
        const double distance = ac.dot(q) / determinant;
        if (distance > 0 && distance < nearest.distance) nearest = {distance, i, u, v};
    }
    return nearest;
}

// What vertices have, between them.
template <class V>
V interpolated(const std::vector<V>& values, const Mesh& mesh, const Hit& hit) {
    const auto corner = [&](std::size_t i) -> const V& {
        return values[mesh.indices[3 * hit.triangle + i]];
    };
    const auto u = static_cast<float>(hit.u), v = static_cast<float>(hit.v);
    return corner(0) * (1 - u - v) + corner(1) * u + corner(2) * v;
}

// The world's normal where bumps of the form `normals` have turned it, and by how much those of the
// classic form move places on sphere maps: as shaders/bump.glsl and direct.cpp do.
struct Bumped {
    Vec3d normal;
    std::optional<Imath::V2d> shift = std::nullopt;
};

Bumped bumped(const Vec3d& normal, const SceneObject& object, const SceneAssets& assets,
              const Hit& hit, const Vec3d& v, double time) {
    const BumpMap& map = object.material.bump;
    const Mesh& mesh = assets.meshes.at(object.mesh);
    if (map.is_smooth() || mesh.texture_coordinates.empty()) return {normal};
    const detail::BumpLookup bump(map, assets, time);
    const Vec2f at = interpolated(mesh.texture_coordinates, mesh, hit);
    Imath::V2d place = bump.place(Imath::V2d(at.x, at.y));
    if (map.form == BumpForm::classic) return {normal, bump.shift(bump.slopes(place))};

    if (mesh.tangents.empty()) return {normal};
    const Imath::M44d to_world = matrix(object.transform);
    const Vec4f stored = interpolated(mesh.tangents, mesh, hit);
    Vec3d tangent;
    to_world.multDirMatrix(Vec3d(stored.x, stored.y, stored.z), tangent);
    if (tangent == Vec3d(0)) return {normal};
    tangent.normalize();
    const double handedness = std::copysign(1, stored.w) * std::copysign(1, to_world.determinant());
    const Vec3d bitangent = normal.cross(tangent) * handedness;
    if (map.relief > 0 && normal.dot(v) > 0)
        place = bump.seen_in_relief(place, {v.dot(tangent), v.dot(bitangent), v.dot(normal)});
    const Imath::V2d slopes = bump.slopes(place);
    return {(normal - tangent * slopes.x - bitangent * slopes.y).normalized()};
}

// The ray as the object's mesh has it.
Ray to_mesh(const Ray& ray, const Transform& transform) {
    const Imath::M44d to_mesh = matrix(transform).inverse();
    Ray moved;
    to_mesh.multVecMatrix(ray.origin, moved.origin);
    to_mesh.multDirMatrix(ray.direction, moved.direction);
    return moved;
}

}  // namespace

Hover hover_at(const Scene& scene, const SceneAssets& assets, double x, double y, double aspect) {
    const Ray ray{scene.camera.eye, view_ray(scene.camera, x, y, aspect)};
    Hover hover;
    hover.reflected = seen_from_capture(scene.environment, ray.origin, ray.direction);
    Hit hit;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const SceneObject& object = scene.objects[i];
        const Hit of_object =
            nearest_hit(assets.meshes.at(object.mesh), to_mesh(ray, object.transform));
        if (of_object.distance >= hit.distance) continue;
        hit = of_object;
        hover.object = i;
    }
    if (!hover.object) return hover;

    const SceneObject& object = scene.objects[*hover.object];
    const Mesh& mesh = assets.meshes.at(object.mesh);
    const Vec3d v = -ray.direction;
    const Vec3d smooth = object.transform.normal(Vec3d(interpolated(mesh.normals, mesh, hit)));
    const Bumped bump = bumped(smooth, object, assets, hit, v, scene.time);
    hover.position = ray.origin + ray.direction * hit.distance;
    hover.normal = bump.normal;
    const bool behind = hover.normal.dot(v) < 0;
    if (behind) hover.normal = -hover.normal;
    const Vec3d& n = hover.normal;
    const auto looked_up = [&](const Vec3d& direction) {
        const Vec3d seen = seen_from_capture(scene.environment, hover.position, direction);
        // Of sphere maps, which are the camera's.
        return bump.shift ? detail::moved_direction(axes(scene.camera), seen, *bump.shift) : seen;
    };
    hover.reflected = looked_up(n * (2 * n.dot(v)) - v);
    const Material& material = object.material;
    if (material.transmission > 0) {
        const Vec3d t = refracted(v, n, behind ? 1 / material.index : material.index);
        if (t != Vec3d(0)) hover.refracted = looked_up(t);
    }
    return hover;
}

}  // namespace mirrorball
