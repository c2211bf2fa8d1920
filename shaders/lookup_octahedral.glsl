// Maps are octahedral. Each edge of the picture meets itself, folded about its middle: half a texel
// from it, what lies across is mixed in by hand.
#include "projections.glsl"

#define MAP sampler2D

float texel_solid_angle(MAP map, vec3 d) {
    vec3 u = d / (abs(d.x) + abs(d.y) + abs(d.z));
    float size = float(textureSize(map, 0).x), u2 = dot(u, u);
    return 4.0 / (u2 * sqrt(u2) * size * size);
}

// How far beyond the centre of the last texel, in texels.
float beyond_edge(float x, float size) {
    return max(0.0, max(0.5 - x * size, x * size - (size - 0.5)));
}

vec3 look_up_level(MAP map, vec2 st, int level) {
    float size = float(textureSize(map, level).x), lod = float(level);
    float over_s = beyond_edge(st.x, size), over_t = beyond_edge(st.y, size);
    vec3 here = textureLod(map, st, lod).rgb;
    if (over_s == 0.0 && over_t == 0.0) return here;
    vec3 folded_t = textureLod(map, vec2(st.x, 1.0 - st.y), lod).rgb;
    vec3 folded_s = textureLod(map, vec2(1.0 - st.x, st.y), lod).rgb;
    vec3 folded = textureLod(map, vec2(1.0) - st, lod).rgb;
    // across the left or right edge t is mirrored, across the upper or lower one s
    return mix(mix(here, folded_t, over_s), mix(folded_s, folded, over_s), over_t);
}

vec3 look_up(MAP map, vec3 d, float lod) {
    vec2 st = octahedral_st(d);
    int level = int(lod);
    vec3 fine = look_up_level(map, st, level);
    float rest = lod - float(level);
    return rest > 0.0 ? mix(fine, look_up_level(map, st, level + 1), rest) : fine;
}
