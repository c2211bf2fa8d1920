// The light of the maps for a direction that is known at each pixel.
#if METHOD == SPHERE
#include "lookup_sphere.glsl"
#elif METHOD == DUAL_PARABOLOID
#include "lookup_paraboloid.glsl"
#elif METHOD == EQUIRECT
#include "lookup_equirect.glsl"
#elif METHOD == OCTAHEDRAL
#include "lookup_octahedral.glsl"
#elif METHOD == CUBE_SEAMS
#include "lookup_faces.glsl"
#else
#include "lookup_cube.glsl"
#endif

uniform MAP u_mirror_map, u_glossy_map, u_diffuse_map;
uniform mat3 u_to_map;  // from the world

// The level whose texels are as large as what a pixel sees. Directions have no seams, so neither has
// this, whatever the texture coordinates do.
float footprint_level(vec3 d) {
#ifdef FINEST_ONLY
    return 0.0;
#endif
#if PROXY == NO_PROXY
    vec3 u = d;  // what mirrors and refracts a unit vector gives one
#else
    vec3 u = normalize(d);
#endif
    vec3 across = cross(dFdx(u), dFdy(u));
    float seen2 = dot(across, across), texel = texel_solid_angle(u_mirror_map, u);
    // no number where a neighbour beyond the triangle's edge has no direction to look up
    float sure2 = seen2 > 1e-37 ? seen2 : 1e-37;
    return max(0.0, 0.25 * log2(sure2 / (texel * texel)));
}

vec3 mirrored_light(vec3 r) {
    vec3 d = u_to_map * r;
    return look_up(u_mirror_map, d, footprint_level(d));
}

vec3 glossy_light(vec3 r) {
    return look_up(u_glossy_map, u_to_map * r, 0.0);
}

vec3 irradiance(vec3 n) {
    return look_up(u_diffuse_map, u_to_map * n, 0.0);
}

#ifdef HAS_ROUGH_MAP
uniform MAP u_rough_map;       // GGX of alpha 1 at the last level, of half as much at each before
uniform float u_rough_levels;  // how many
uniform float u_mirror_alpha;  // what the width of the mirror's texels amounts to

// rough_place() of include/mirrorball/reflection_maps.h: the share of the rough map, and at what level.
vec2 rough_place(float alpha) {
    float finest = exp2(1.0 - u_rough_levels);
    if (alpha < finest) {
        float sharp = min(u_mirror_alpha, 0.5 * finest);  // the mirror up to there
        return vec2(alpha > sharp ? (1.0 - sharp / alpha) / (1.0 - sharp / finest) : 0.0, 0.0);
    }
    float level = floor(log2(alpha / finest));
    float lod = level + 2.0 * (1.0 - exp2(level) * finest / alpha);
    return vec2(1.0, min(lod, u_rough_levels - 1.0));
}

// What is seen along r by a mirror whose normals are spread as GGX with alpha spreads them.
vec3 rough_light(vec3 r, float alpha) {
    vec3 d = u_to_map * r;
    float mirror_level = footprint_level(d);  // of derivatives, which all pixels have to take
    vec2 place = rough_place(alpha);
    vec3 light = vec3(0.0);
    if (place.x > 0.0) light += place.x * look_up(u_rough_map, d, place.y);
    if (place.x < 1.0) light += (1.0 - place.x) * look_up(u_mirror_map, d, mirror_level);
    return light;
}
#endif
