#include "hover.h"

#include <cmath>
#include <limits>

#include <mirrorball/direct.h>

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

Vec3d normal_at(const Mesh& mesh, const Hit& hit) {
    const auto corner = [&](std::size_t i) {
        return Vec3d(mesh.normals[mesh.indices[3 * hit.triangle + i]]);
    };
    return corner(0) * (1 - hit.u - hit.v) + corner(1) * hit.u + corner(2) * hit.v;
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
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const SceneObject& object = scene.objects[i];
        const Mesh& mesh = assets.meshes.at(object.mesh);
        const Hit hit = nearest_hit(mesh, to_mesh(ray, object.transform));
        if (hit.distance >= nearest) continue;
        nearest = hit.distance;
        hover.object = i;
        hover.position = ray.origin + ray.direction * hit.distance;
        hover.normal = object.transform.normal(normal_at(mesh, hit));
    }
    if (!hover.object) return hover;

    const Vec3d v = -ray.direction;
    const bool behind = hover.normal.dot(v) < 0;
    if (behind) hover.normal = -hover.normal;
    const Vec3d& n = hover.normal;
    const auto looked_up = [&](const Vec3d& direction) {
        return seen_from_capture(scene.environment, hover.position, direction);
    };
    hover.reflected = looked_up(n * (2 * n.dot(v)) - v);
    const Material& material = scene.objects[*hover.object].material;
    if (material.transmission > 0) {
        const Vec3d t = refracted(v, n, behind ? 1 / material.index : material.index);
        if (t != Vec3d(0)) hover.refracted = looked_up(t);
    }
    return hover;
}

}  // namespace mirrorball
