// A cube map filtered with a lobe: a sum of TAP_COUNT lookups about the direction of each texel, as
// src/gl/lobe_taps.h has them. There is no chance in it, so there is no noise.
#include "lookup_cube.glsl"

uniform samplerCube u_cube;
uniform int u_face;
uniform float u_size;
uniform vec4 u_taps[TAP_COUNT];  // x, y, log2 of the texel's edge in radians, weight
out vec4 o_color;

void main() {
    vec2 at = 2.0 * gl_FragCoord.xy / u_size - 1.0;
    vec3 r = normalize(cube_direction(u_face, at.x, at.y));
    vec3 x = normalize(abs(r.y) < 0.99 ? vec3(r.z, 0.0, -r.x) : vec3(0.0, -r.z, r.y));
    vec3 y = cross(r, x);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < TAP_COUNT; ++i) {
        vec4 tap = u_taps[i];
        vec3 d = tap.x * x + tap.y * y + sqrt(max(0.0, 1.0 - dot(tap.xy, tap.xy))) * r;
        float level = tap.z - 0.5 * log2(texel_solid_angle(u_cube, d));
        sum += tap.w * textureLod(u_cube, d, max(level, 0.0)).rgb;
    }
    o_color = vec4(min(sum, vec3(65504.0)), 1.0);
}
