// What a surface sends to the eye: the equations at Material in include/mirrorball/scene.h.
//
// Defined by the renderer: METHOD; HAS_MIRROR, HAS_GLOSSY, HAS_DIFFUSE, HAS_TRANSMISSION,
// HAS_EMISSION, HAS_BASE_COLOR_MAP, HAS_FLOOR, HAS_BUMP (bump.glsl); COUPLING; PROXY; DISPLAY,
// HALF_FLOATS or RADIANCE: how it is written.
#include "methods.glsl"
#include "normal.glsl"

in vec3 v_position, v_normal;
in vec2 v_texture_coordinate;
#ifdef HAS_BUMP
in vec4 v_tangent;  // and the handedness
#include "bump.glsl"
#if BUMP_FORM == CLASSIC
vec2 place_shift = vec2(0.0);  // of what is looked up on sphere maps
#define SHIFTED(st) ((st) + place_shift)
#endif
#endif
out vec4 o_color;

uniform vec3 u_eye;
uniform float u_intensity;     // of the environment

#include "proxy.glsl"
#if PER_VERTEX
#include "light_per_vertex.glsl"
#else
#include "light_per_pixel.glsl"
#endif
#include "material.glsl"
#include "point_lights.glsl"
#include "light_map.glsl"
#include "floor.glsl"
#include "held.glsl"
#include "srgb.glsl"
#include "tone_map.glsl"

// What a point of the surface is like, the normal on the eye's side.
struct Point {
    vec3 n, smooth_normal, v;
    bool behind;
    vec2 texture_coordinate;
    float added_alpha2;  // to the square of GGX's alpha, for bumps too fine to be seen
    float luminance;     // what light of maps is multiplied by
};

#ifdef HAS_BUMP
void add_bump(inout Point point) {
    vec2 place = bump_place(v_texture_coordinate);
    vec2 place_dx = dFdx(place), place_dy = dFdy(place);
#if BUMP_FORM == CLASSIC
    Bump bump = bump_at(place, place_dx, place_dy);
    place_shift = bump_shift(bump.slopes);
    point.luminance = bump_luminance(bump.height);
#else
    vec3 bitangent = v_tangent.w * cross(v_normal, v_tangent.xyz);
#ifdef HAS_RELIEF
    if (!point.behind) {
        vec3 v = vec3(dot(point.v, unit_normal(v_tangent.xyz)), dot(point.v, unit_normal(bitangent)),
                      dot(point.v, point.smooth_normal));
        place = seen_in_relief(place, v, place_dx, place_dy);
        point.texture_coordinate = (place - u_bump_offset) / u_bump_repeat;
    }
#endif
    Bump bump = bump_at(place, place_dx, place_dy);
    vec3 n = v_normal - bump.slopes.x * v_tangent.xyz - bump.slopes.y * bitangent;
    point.n = unit_normal(point.behind ? -n : n);
    point.added_alpha2 = added_alpha2(bump.variance);
#endif
}
#endif

Point point_seen() {
    Point point;
    point.smooth_normal = unit_normal(v_normal);
    point.v = normalize(u_eye - v_position);
    point.behind = dot(point.smooth_normal, point.v) < 0.0;
    if (point.behind) point.smooth_normal = -point.smooth_normal;
    point.n = point.smooth_normal;
    point.texture_coordinate = v_texture_coordinate;
    point.added_alpha2 = 0.0;
    point.luminance = 1.0;
#ifdef HAS_BUMP
    add_bump(point);
#endif
    return point;
}

// What a mirror and a lobe show of direction r, where bumps too fine to be seen add to alpha^2.
vec3 mirrored_layer(vec3 r, float added) {
#ifdef HAS_ROUGH_MAP
    return rough_light(r, sqrt(min(1.0, added)));
#else
    return mirrored_light(r);
#endif
}

vec3 glossy_layer(vec3 r, float added) {
#ifdef HAS_ROUGH_MAP
    float alpha2 = u_roughness * u_roughness * u_roughness * u_roughness;
    vec3 rougher = rough_light(r, sqrt(min(1.0, alpha2 + added)));
    // The exact lobe goes over into the chain's while the two are still much the same.
    return mix(glossy_light(r), rougher, clamp(10.0 * added / max(alpha2, 1e-10), 0.0, 1.0));
#else
    return glossy_light(r);
#endif
}

void main() {
    Point point = point_seen();
    vec3 n = point.n, v = point.v;
    float cosine = clamp(dot(n, v), 0.0, 1.0);  // at which F is taken
    vec3 r = 2.0 * dot(n, v) * n - v;
#ifdef HAS_TRANSMISSION
    // F is the same along a ray to either side, and curves are for the outer one.
    vec3 t = refracted(v, n, point.behind ? 1.0 / u_index : u_index);
    if (point.behind) cosine = clamp(-dot(n, t), 0.0, 1.0);
#endif

    vec3 base_color = u_base_color;
#ifdef HAS_BASE_COLOR_MAP
    base_color *= texture(u_base_color_map, point.texture_coordinate).rgb;
#endif
    Weights weights = layer_weights(cosine);
    // A slope across the plane of v and n turns r by its cosine's share of what one in it does.
    float added = point.added_alpha2 * 0.5 * (1.0 + cosine * cosine);

    vec3 layer = vec3(0.0), radiance = vec3(0.0);
#ifdef HAS_MIRROR
    layer += u_mirror * mirrored_layer(seen_from_capture(v_position, r), added);
#endif
#ifdef HAS_GLOSSY
    layer += u_glossy * glossy_layer(seen_from_capture(v_position, r), added);
#endif
#ifdef HAS_HORIZON
    layer *= above_horizon(r, point.smooth_normal);
#endif
    radiance += weights.layer * layer;
#ifdef HAS_DIFFUSE
    radiance += weights.base * u_diffuse * base_color * irradiance(n) / PI;
#endif
    radiance *= point.luminance;
#ifdef HAS_TRANSMISSION
    if (dot(t, t) > 0.0) {
        vec3 seen = through_surface(v_position, t);
        radiance += u_transmission * base_color * (vec3(1.0) - fresnel(cosine)) * seen;
    }
#endif
    radiance *= u_intensity;
#ifdef HAS_EMISSION
    radiance += u_emission * base_color;
#endif
#ifdef HAS_LIGHT_MAP
    radiance += light_map_light(r, base_color) * point.luminance;
#elif defined(LIGHT_COUNT)
    Lit lit = light_of_lights(v_position, n, v, weights, point.added_alpha2);
    radiance += lit.base * base_color + lit.layer;
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
