// A cube map made into another map, texel by texel: TARGET says which.
#include "lookup_cube.glsl"
#define SPHERE_TARGET 0
#define FRONT_PARABOLOID_TARGET 1
#define BACK_PARABOLOID_TARGET 2
#define EQUIRECT_TARGET 3
#define OCTAHEDRAL_TARGET 4
#define FACE_TARGET 5

uniform MAP u_cube;
uniform mat3 u_to_cube;  // from the frame of the new map
uniform vec2 u_size;     // of the new map, in texels
uniform int u_face;      // if it is one of a cube
uniform float u_level;   // to read, if it is known
out vec4 o_color;

vec3 direction_at(vec2 st) {
#if TARGET == SPHERE_TARGET
    return sphere_direction(st);
#elif TARGET == EQUIRECT_TARGET
    return equirect_direction(st);
#elif TARGET == OCTAHEDRAL_TARGET
    return octahedral_direction(st);
#elif TARGET == FACE_TARGET
    return cube_direction(u_face, 2.0 * st.x - 1.0, 2.0 * st.y - 1.0);
#else
    vec2 p = to_disc(st);
    return vec3(2.0 * p, (TARGET == FRONT_PARABOLOID_TARGET ? 1.0 : -1.0) * (1.0 - dot(p, p)));
#endif
}

// Of a square of the new map about st that is as large as all of it: the map's density.
float solid_angle_at(vec2 st, vec3 d) {
#if TARGET == SPHERE_TARGET
    return 16.0;
#elif TARGET == EQUIRECT_TARGET
    return 2.0 * kPi * kPi * max(length(d.xz), 1e-4);
#elif TARGET == OCTAHEDRAL_TARGET
    vec3 u = d / (abs(d.x) + abs(d.y) + abs(d.z));
    float u2 = dot(u, u);
    return 4.0 / (u2 * sqrt(u2));
#elif TARGET == FACE_TARGET
    float u2 = dot(d, d);
    return 4.0 / (u2 * sqrt(u2));
#else
    vec2 p = to_disc(st);
    float q = 1.0 + dot(p, p);
    return 16.0 / (q * q);
#endif
}

void main() {
    vec2 st = gl_FragCoord.xy / u_size;
    vec3 d = direction_at(st);
#ifdef LEVEL_KNOWN
    float level = u_level;
    d = u_to_cube * d;
#else
    float solid_angle = solid_angle_at(st, d) / (u_size.x * u_size.y);
    d = u_to_cube * d;
    float level = max(0.0, 0.5 * log2(solid_angle / texel_solid_angle(u_cube, normalize(d))));
#endif
    o_color = vec4(look_up(u_cube, d, level), 1.0);
}
