// Maps are cube maps.
#include "projections.glsl"

#define MAP samplerCube

// Solid angle of a texel of the map about d.
float texel_solid_angle(MAP map, vec3 d) {
    return cube_texel_solid_angle(d, float(textureSize(map, 0).x));
}

vec3 look_up(MAP map, vec3 d, float lod) {
    return textureLod(map, d, lod).rgb;
}
