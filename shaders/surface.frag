// What a surface sends to the eye: the equations at Material in include/mirrorball/scene.h.
//
// Defined by the renderer: METHOD; HAS_MIRROR, HAS_GLOSSY, HAS_DIFFUSE, HAS_TRANSMISSION,
// HAS_EMISSION; COUPLING; PROXY; DISPLAY, HALF_FLOATS or RADIANCE: how it is written.
#include "methods.glsl"
#include "normal.glsl"

in vec3 v_position, v_normal;
in vec2 v_texture_coordinate;
out vec4 o_color;

uniform vec3 u_eye;
uniform float u_intensity;     // of the environment

#if PER_VERTEX
#include "light_per_vertex.glsl"
#else
#include "light_per_pixel.glsl"
#endif
#include "proxy.glsl"
#include "material.glsl"
#include "point_lights.glsl"
#include "held.glsl"
#include "tone_map.glsl"

void main() {
    vec3 n = unit_normal(v_normal), v = normalize(u_eye - v_position);
    bool behind = dot(n, v) < 0.0;
    if (behind) n = -n;
    float cosine = clamp(dot(n, v), 0.0, 1.0);  // at which F is taken
    vec3 r = 2.0 * dot(n, v) * n - v;
#ifdef HAS_TRANSMISSION
    // F is the same along a ray to either side, and curves are for the outer one.
    vec3 t = refracted(v, n, behind ? 1.0 / u_index : u_index);
    if (behind) cosine = clamp(-dot(n, t), 0.0, 1.0);
#endif

    vec3 base_color = u_base_color;
#ifdef HAS_BASE_COLOR_MAP
    base_color *= texture(u_base_color_map, v_texture_coordinate).rgb;
#endif
    Weights weights = layer_weights(cosine);

    vec3 layer = vec3(0.0), radiance = vec3(0.0);
#ifdef HAS_MIRROR
    layer += u_mirror * mirrored_light(seen_from_capture(v_position, r));
#endif
#ifdef HAS_GLOSSY
    layer += u_glossy * glossy_light(seen_from_capture(v_position, r));
#endif
    radiance += weights.layer * layer;
#ifdef HAS_DIFFUSE
    radiance += weights.base * u_diffuse * base_color * irradiance(n) / PI;
#endif
#ifdef HAS_TRANSMISSION
    if (dot(t, t) > 0.0) {
        radiance += u_transmission * base_color * (vec3(1.0) - fresnel(cosine)) *
                    mirrored_light(seen_from_capture(v_position, t));
    }
#endif
    radiance *= u_intensity;
#ifdef HAS_EMISSION
    radiance += u_emission * base_color;
#endif
#ifdef LIGHT_COUNT
    radiance += light_of_lights(v_position, n, v, base_color, weights);
#endif
#ifdef DISPLAY
    o_color = vec4(tone_mapped(radiance), 1.0);
#elif defined(HALF_FLOATS)
    o_color = vec4(held(radiance), 1.0);
#else
    o_color = vec4(radiance, 1.0);
#endif
}
