// One level of a cube map from the next finer one. Each texel is the mean of the 4 x 4 around it,
// weighted (1 3 3 1) / 8 both ways, which four lookups between texels are. What is halfway between
// two texels goes to both: light stays where it is, which plain boxes move by half a texel.
#include "projections.glsl"

uniform samplerCube u_cube;  // the finer level only
uniform int u_face;
uniform float u_size;  // of a face of this level
uniform float u_step;  // 3/4 of a texel of the finer one
out vec4 o_color;

void main() {
    vec2 st = gl_FragCoord.xy / u_size;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        vec2 at = st + u_step * vec2((i & 1) == 0 ? -1.0 : 1.0, i < 2 ? -1.0 : 1.0);
        vec3 d = cube_direction(u_face, 2.0 * at.x - 1.0, 2.0 * at.y - 1.0);
        float solid_angle = 1.0 / (dot(d, d) * length(d));  // times a constant
        sum += solid_angle * vec4(textureLod(u_cube, d, 0.0).rgb, 1.0);
    }
    o_color = vec4(sum.rgb / sum.a, 1.0);
}
