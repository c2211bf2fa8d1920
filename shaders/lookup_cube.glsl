// Maps are cube maps.
#include "projections.glsl"

#define MAP samplerCube

// Solid angle of a texel of the map about d.
float texel_solid_angle(MAP map, vec3 d) {
    vec3 a = abs(d);
    float major = max(a.x, max(a.y, a.z));
    float size = float(textureSize(map, 0).x);
    float cosine = major / length(d);
    return 4.0 * cosine * cosine * cosine / (size * size);
}

vec3 look_up(MAP map, vec3 d, float lod) {
    return textureLod(map, d, lod).rgb;
}
