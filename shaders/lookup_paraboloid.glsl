// Maps are pairs of paraboloid maps, front and back, each filled beyond its rim with what goes on
// there: the same light as on the other, so there is no edge to see between the two.
#include "projections.glsl"

#define MAP sampler2DArray

float texel_solid_angle(MAP map, vec3 d) {
    vec2 p = to_disc(paraboloid_st(d).xy);
    float size = float(textureSize(map, 0).x), q = 1.0 + dot(p, p);
    return 16.0 / (q * q * size * size);
}

vec3 look_up(MAP map, vec3 d, float lod) {
    return textureLod(map, paraboloid_st(d), lod).rgb;
}
