// Maps are panoramas. The texture repeats in s; across a pole one comes back half a turn further.
#include "projections.glsl"

#define MAP sampler2D

// Of a texel on the horizon. Near the poles texels are narrower, but what is in them is no finer than
// elsewhere on the sphere.
float texel_solid_angle(MAP map, vec3 d) {
    float angle = kPi / float(textureSize(map, 0).y);
    return angle * angle;
}

vec3 look_up_level(MAP map, vec2 st, int level) {
    float height = float(textureSize(map, level).y);
    float row = st.y * height;
    float beyond = max(0.5 - row, row - (height - 0.5));  // of the last row's centre, in texels
    vec3 here = textureLod(map, st, float(level)).rgb;
    if (beyond <= 0.0) return here;
    return mix(here, textureLod(map, st + vec2(0.5, 0.0), float(level)).rgb, beyond);
}

vec3 look_up(MAP map, vec3 d, float lod) {
    vec2 st = equirect_st(d);
    int level = int(lod);
    vec3 fine = look_up_level(map, st, level);
    float rest = lod - float(level);
    return rest > 0.0 ? mix(fine, look_up_level(map, st, level + 1), rest) : fine;
}
