// The light of the maps at places that were found at the vertices and interpolated in between: the
// directions given are not used.
in vec4 v_mirror_place, v_normal_place;
in vec3 v_back_place, v_normal_back_place;

#if METHOD == SPHERE_VERTEX
#include "projections.glsl"

#ifndef SHIFTED
#define SHIFTED(st) (st)
#endif
uniform sampler2D u_mirror_map, u_glossy_map, u_diffuse_map;
#define LIGHT(map, place, back_place) texture(map, SHIFTED(place.xy)).rgb

#elif METHOD == CUBE_VERTEX
uniform samplerCube u_mirror_map, u_glossy_map, u_diffuse_map;
#define LIGHT(map, place, back_place) texture(map, place.xyz).rgb

#elif METHOD == CUBE_SPLIT
// One face as a plain texture, which is all that the polygon reflects.
uniform sampler2D u_mirror_map, u_glossy_map;
uniform samplerCube u_diffuse_map;
#define LIGHT(map, place, back_place) textureProj(map, place.xyz).rgb

#else
uniform sampler2DArray u_mirror_map, u_glossy_map, u_diffuse_map;

// PASS: 0 both maps at once, each where it is meant to be used; 1 the back map everywhere; 2 the
// front map where its mask, its disc, says that it holds.
vec3 paraboloid_light(sampler2DArray map, vec4 front, vec3 back) {
    vec2 on_front = front.xy / front.z, on_back = back.xy / back.z;
    // both are looked up, so that the level is known everywhere
    vec3 front_light = texture(map, vec3(on_front, 0.0)).rgb;
    vec3 back_light = texture(map, vec3(on_back, 1.0)).rgb;
#if PASS == 0
    return front.w >= 0.0 ? front_light : back_light;
#elif PASS == 1
    return back_light;
#else
    return front_light;
#endif
}
#define LIGHT(map, place, back_place) paraboloid_light(map, place, back_place)
#endif

vec3 mirrored_light(vec3 r) {
#if METHOD == DUAL_PARABOLOID_VERTEX && PASS == 2
    vec2 place = 2.0 * v_mirror_place.xy / v_mirror_place.z - 1.0;
    if (dot(place, place) > 1.0) discard;
#endif
    return LIGHT(u_mirror_map, v_mirror_place, v_back_place);
}

vec3 glossy_light(vec3 r) {
    return LIGHT(u_glossy_map, v_mirror_place, v_back_place);
}

vec3 irradiance(vec3 n) {
#if METHOD == CUBE_SPLIT
    return texture(u_diffuse_map, v_normal_place.xyz).rgb;
#else
    return LIGHT(u_diffuse_map, v_normal_place, v_normal_back_place);
#endif
}
