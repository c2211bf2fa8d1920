// An object's vertices; with methods that work per vertex, their places on the maps too.
#include "methods.glsl"
#include "normal.glsl"
#include "projections.glsl"

#ifdef SIX_VIEWS  // surface.geom comes in between
#define v_position g_position
#define v_normal g_normal
#define v_texture_coordinate g_texture_coordinate
#define v_tangent g_tangent
#endif

layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec2 a_texture_coordinate;
layout(location = 3) in vec3 a_split_place;  // (s q, t q, q), of split polygons
#ifdef HAS_TANGENTS
layout(location = 4) in vec4 a_tangent;  // and the handedness
#endif

uniform mat4 u_to_world, u_to_clip;  // to_clip from the world
uniform mat3 u_normal_to_world;
uniform float u_handedness;  // of u_to_world: 1, or -1 if it mirrors
uniform vec3 u_eye;

// Passes over one object have to meet the same pixels at the same depths.
invariant gl_Position;

out vec3 v_position;  // world
out vec3 v_normal;
out vec2 v_texture_coordinate;
#ifdef HAS_TANGENTS
out vec4 v_tangent;  // bump.h's x, unit; and the sign of its y against cross(normal, x)
#endif

#if PER_VERTEX
uniform mat3 u_to_map;  // from the world; for sphere maps to the frame of the eye
uniform mat4 u_to_front, u_to_back;  // Eq. 4 to 7: from a reflection vector to (s q, t q, -, q)
out vec4 v_mirror_place, v_normal_place;  // what they are is the method's business
out vec3 v_back_place, v_normal_back_place;

vec4 place(vec3 d) {
    vec3 in_map = u_to_map * d;
#if METHOD == SPHERE_VERTEX
    return vec4(sphere_st(in_map), 0.0, 0.0);
#else
    return vec4(in_map, 0.0);
#endif
}
#endif

void main() {
    vec4 world = u_to_world * vec4(a_position, 1.0);
    v_position = world.xyz;
    v_normal = unit_normal(u_normal_to_world * a_normal);  // what is interpolated: lengths matter
    v_texture_coordinate = a_texture_coordinate;
#ifdef HAS_TANGENTS
    v_tangent = vec4(unit_normal(mat3(u_to_world) * a_tangent.xyz), a_tangent.w * u_handedness);
#endif
#ifdef SIX_VIEWS
    gl_Position = world;
#else
    gl_Position = u_to_clip * world;
#endif
#if PER_VERTEX
    vec3 n = unit_normal(v_normal), v = normalize(u_eye - v_position);
    vec3 r = 2.0 * dot(n, v) * n - v;
#if METHOD == CUBE_SPLIT
    v_mirror_place = vec4(a_split_place, 0.0);
    v_normal_place = vec4(u_to_map * n, 0.0);
#elif METHOD == DUAL_PARABOLOID_VERTEX
    v_mirror_place = vec4((u_to_front * vec4(r, 1.0)).xyw, (u_to_map * r).z);
    v_back_place = (u_to_back * vec4(r, 1.0)).xyw;
    v_normal_place = vec4((u_to_front * vec4(n, 1.0)).xyw, (u_to_map * n).z);
    v_normal_back_place = (u_to_back * vec4(n, 1.0)).xyw;
#else
    v_mirror_place = place(r);
    v_normal_place = place(n);
#endif
#endif
}
