// Maps are sphere maps.
#include "projections.glsl"

#define MAP sampler2D

float texel_solid_angle(MAP map, vec3 d) {
    float size = float(textureSize(map, 0).x);
    return 16.0 / (size * size);
}

vec3 look_up(MAP map, vec3 d, float lod) {
    return textureLod(map, sphere_st(d), lod).rgb;
}
