// A cube map filtered with a wide lobe: for each texel's direction a sum over all texels of a small
// level, by their angles to it. Divided by the weights' own sum: uniform light stays uniform.
#include "projections.glsl"

uniform samplerCube u_cube;
uniform sampler2D u_lobe;  // its weight by the sine of half the angle, samples at the ends
uniform int u_face, u_level;
uniform float u_size, u_integral;
out vec4 o_color;

void main() {
    vec2 place = 2.0 * gl_FragCoord.xy / u_size - 1.0;
    vec3 r = normalize(cube_direction(u_face, place.x, place.y));
    float samples = float(textureSize(u_lobe, 0).x);
    int count = textureSize(u_cube, u_level).x;
    vec4 sum = vec4(0.0);
    for (int face = 0; face < 6; ++face) {
        for (int row = 0; row < count; ++row) {
            for (int column = 0; column < count; ++column) {
                vec2 at = (2.0 * vec2(column, row) + 1.0) / float(count) - 1.0;
                vec3 l = cube_direction(face, at.x, at.y);
                float length2 = dot(l, l);
                float half_sine = sqrt(max(0.0, 0.5 - 0.5 * dot(r, l) * inversesqrt(length2)));
                float s = (half_sine * (samples - 1.0) + 0.5) / samples;
                float weight = textureLod(u_lobe, vec2(s, 0.5), 0.0).r;
                if (weight == 0.0) continue;
                weight *= inversesqrt(length2) / length2;  // solid angle, times a constant
                sum += weight * vec4(textureLod(u_cube, l, float(u_level)).rgb, 1.0);
            }
        }
    }
    o_color = vec4(min(u_integral * sum.rgb / sum.a, vec3(65504.0)), 1.0);
}
