#include <array>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/projection.h>
#include <mirrorball/scene.h>

#include "scene/method_lookup.h"

namespace mirrorball {
namespace {

struct MethodFacts {
    Method method;
    std::string_view name;
    Projection projection;
    std::string_view description;
};

constexpr std::array kMethods = {
    MethodFacts{Method::sphere, "sphere", Projection::sphere,
                "sphere map, per pixel, made anew for the camera"},
    MethodFacts{Method::sphere_vertex, "sphere-vertex", Projection::sphere,
                "sphere map, per vertex, as glTexGen's GL_SPHERE_MAP"},
    MethodFacts{Method::sphere_stale, "sphere-stale", Projection::sphere,
                "sphere map, per pixel, left as made for another camera"},
    MethodFacts{Method::cube, "cube", Projection::cube, "cube map, per pixel"},
    MethodFacts{Method::cube_vertex, "cube-vertex", Projection::cube,
                "cube map, reflection vector interpolated between vertices"},
    MethodFacts{Method::cube_seams, "cube-seams", Projection::cube,
                "cube map, per pixel, each face filtered on its own"},
    MethodFacts{Method::cube_split, "cube-split", Projection::cube,
                "polygons split by the face that they reflect into, plain 2-D textures"},
    MethodFacts{Method::dual_paraboloid, "dual-paraboloid", Projection::dual_paraboloid,
                "two paraboloid maps, per pixel"},
    MethodFacts{Method::dual_paraboloid_vertex, "dual-paraboloid-vertex",
                Projection::dual_paraboloid,
                "two paraboloid maps, per vertex by the matrices of Eq. 4-7"},
    MethodFacts{Method::dual_paraboloid_passes, "dual-paraboloid-passes",
                Projection::dual_paraboloid, "the same in two passes, a mask for each map"},
    MethodFacts{Method::equirect, "equirect", Projection::equirect, "panorama, per pixel"},
    MethodFacts{Method::octahedral, "octahedral", Projection::octahedral,
                "octahedral map, per pixel"},
};

const MethodFacts& facts(Method method) {
    return kMethods[static_cast<std::size_t>(method)];
}

}  // namespace

std::vector<Method> all_methods() {
    std::vector<Method> methods;
    for (const MethodFacts& facts : kMethods) methods.push_back(facts.method);
    return methods;
}

std::string_view name(Method method) {
    return facts(method).name;
}

std::string_view describe(Method method) {
    return facts(method).description;
}

Projection projection_of(Method method) {
    return facts(method).projection;
}

Method parse_method(std::string_view name) {
    std::string names;
    for (const MethodFacts& facts : kMethods) {
        if (facts.name == name) return facts.method;
        names += fmt::format("{}{}", names.empty() ? "" : ", ", facts.name);
    }
    throw Error(Errc::usage, fmt::format("\"{}\" is not a method; there are: {}", name, names));
}

bool detail::looks_up_per_pixel(Method method) {
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

bool can_show(Method method, const BumpMap& bump) {
    if (bump.is_smooth()) return true;
    if (bump.form == BumpForm::classic) return projection_of(method) == Projection::sphere;
    return detail::looks_up_per_pixel(method);
}

}  // namespace mirrorball
