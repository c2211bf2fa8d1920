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
    vec3 u = normalize(d);
    float seen = length(cross(dFdx(u), dFdy(u)));
    // no number where a neighbour beyond the triangle's edge has no direction to look up
    float sure = seen > 1e-20 ? seen : 1e-20;
    return max(0.0, 0.5 * log2(sure / texel_solid_angle(u_mirror_map, d)));
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
