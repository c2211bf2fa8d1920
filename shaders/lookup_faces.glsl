// Maps are the six faces of a cube as pictures that know nothing of each other: as old hardware
// filtered cube maps.
#include "projections.glsl"

#define MAP sampler2DArray

float texel_solid_angle(MAP map, vec3 d) {
    return cube_texel_solid_angle(d, float(textureSize(map, 0).x));
}

// Eq. 3 and Table 1.
vec3 face_st(vec3 r) {
    vec3 a = abs(r);
    float face, sc, tc, ma;
    if (a.x >= a.y && a.x >= a.z) {
        ma = a.x, face = r.x >= 0.0 ? 0.0 : 1.0, sc = r.x >= 0.0 ? -r.z : r.z, tc = -r.y;
    } else if (a.y >= a.z) {
        ma = a.y, face = r.y >= 0.0 ? 2.0 : 3.0, sc = r.x, tc = r.y >= 0.0 ? r.z : -r.z;
    } else {
        ma = a.z, face = r.z >= 0.0 ? 4.0 : 5.0, sc = r.z >= 0.0 ? r.x : -r.x, tc = -r.y;
    }
    return vec3((vec2(sc, tc) / ma + 1.0) / 2.0, face);
}

vec3 look_up(MAP map, vec3 d, float lod) {
    return textureLod(map, face_st(d), lod).rgb;
}
