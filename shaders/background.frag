// The environment behind the objects.
#include "lookup_cube.glsl"
#include "held.glsl"
#include "srgb.glsl"
#include "tone_map.glsl"
#include "proxy.glsl"

in vec3 v_ray;
out vec4 o_color;

uniform MAP u_mirror_map;
uniform mat3 u_to_map;
uniform vec3 u_eye, u_background;  // background: a plain colour
uniform float u_intensity;
uniform float u_level;  // whose texels are as large as pixels, where it is known

void main() {
#ifdef PLAIN
    vec3 radiance = u_background;
#else
#if PROXY == NO_PROXY
    vec3 d = u_to_map * v_ray;
#else
    vec3 d = u_to_map * seen_from_capture(u_eye, normalize(v_ray));
#endif
#ifdef LEVEL_KNOWN
    float level = max(0.0, u_level);
#else
    d = normalize(d);
    float seen = length(cross(dFdx(d), dFdy(d)));
    float level = max(0.0, 0.5 * log2(max(seen, 1e-20) / texel_solid_angle(u_mirror_map, d)));
#endif
    vec3 radiance = u_intensity * look_up(u_mirror_map, d, level);
#endif
#ifdef DISPLAY
    o_color = vec4(tone_mapped(radiance), 1.0);
#elif defined(SCREEN)
    o_color = vec4(srgb(tone_mapped(radiance)), 1.0);
#elif defined(HALF_FLOATS)
    o_color = vec4(held(radiance), 1.0);
#else
    o_color = vec4(radiance, 1.0);
#endif
}
