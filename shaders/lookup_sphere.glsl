// Maps are sphere maps. SHIFTED: what becomes of a place on one.
#include "projections.glsl"

#ifndef SHIFTED
#define SHIFTED(st) (st)
#endif

#define MAP sampler2D

float texel_solid_angle(MAP map, vec3 d) {
    float size = float(textureSize(map, 0).x);
    return 16.0 / (size * size);
}

vec3 look_up(MAP map, vec3 d, float lod) {
    return textureLod(map, SHIFTED(sphere_st(d)), lod).rgb;
}
