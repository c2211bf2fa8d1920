// A cube map made into another map, texel by texel: sphere maps for a camera, paraboloids.
#include "lookup_cube.glsl"

uniform MAP u_cube;
uniform mat3 u_to_cube;  // from the frame of the new map
uniform float u_size;    // of the new map, in texels
out vec4 o_color;

vec3 direction_at(vec2 st) {
#if TARGET == 0
    return sphere_direction(st);
#else
    vec2 p = to_disc(st);
    float q = dot(p, p);
    return vec3(2.0 * p, (TARGET == 1 ? 1.0 : -1.0) * (1.0 - q));
#endif
}

// Of a texel of the new map about st: 16 / size^2 for a sphere map, 16 / ((1 + q) size)^2 for a
// paraboloid.
float solid_angle_at(vec2 st) {
    vec2 p = to_disc(st);
    float q = TARGET == 0 ? 0.0 : dot(p, p);
    return 16.0 / ((1.0 + q) * (1.0 + q) * u_size * u_size);
}

void main() {
    vec2 st = gl_FragCoord.xy / u_size;
    vec3 d = u_to_cube * direction_at(st);
    float level = max(0.0, 0.5 * log2(solid_angle_at(st) / texel_solid_angle(u_cube, d)));
    o_color = vec4(look_up(u_cube, d, level), 1.0);
}
