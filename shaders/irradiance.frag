// Irradiance, E(n) = integral of L(l) max(0, n.l) dl, for each texel's n: a sum over all texels of a
// small level of a cube map, divided by the weights' own sum, so that uniform light gives pi of it.
#include "projections.glsl"

uniform samplerCube u_cube;
uniform int u_face, u_level;
uniform float u_size;
out vec4 o_color;

void main() {
    vec2 place = 2.0 * gl_FragCoord.xy / u_size - 1.0;
    vec3 n = normalize(cube_direction(u_face, place.x, place.y));
    int count = textureSize(u_cube, u_level).x;
    vec4 sum = vec4(0.0);
    for (int face = 0; face < 6; ++face) {
        for (int row = 0; row < count; ++row) {
            for (int column = 0; column < count; ++column) {
                vec2 at = (2.0 * vec2(column, row) + 1.0) / float(count) - 1.0;
                vec3 l = cube_direction(face, at.x, at.y);
                float n_dot_l = dot(n, l);
                if (n_dot_l <= 0.0) continue;
                float length2 = dot(l, l);  // l's own length, and the solid angle's: ^-3/2
                float weight = n_dot_l / (length2 * length2);
                sum += weight * vec4(textureLod(u_cube, l, float(u_level)).rgb, 1.0);
            }
        }
    }
    o_color = vec4(min(kPi * sum.rgb / sum.a, vec3(65504.0)), 1.0);
}
