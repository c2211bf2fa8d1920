// How much of each term of a material reaches the eye.
#define ADDED 0
#define LAYERED 1
#define SPLIT_SUM 2

const float PI = 3.14159265358979;

uniform vec3 u_base_color;
uniform sampler2D u_base_color_map;
uniform float u_mirror, u_glossy, u_diffuse, u_transmission, u_index, u_emission;
uniform sampler2D u_fresnel_map;  // section 6's: by the cosine, samples at its ends
uniform sampler2D u_dfg_table;    // by n.v and roughness: scale, bias
uniform float u_roughness;
uniform vec3 u_f0, u_f90;

vec3 fresnel(float cosine) {
    float count = float(textureSize(u_fresnel_map, 0).x);
    return texture(u_fresnel_map, vec2((cosine * (count - 1.0) + 0.5) / count, 0.5)).rgb;
}

struct Weights {
    vec3 layer, base;
    vec3 compensation;  // of microfacets, for what scatters more than once
};

Weights layer_weights(float cosine) {
#if COUPLING == ADDED
    return Weights(fresnel(cosine), vec3(1.0), vec3(1.0));
#elif COUPLING == LAYERED
    vec3 f = fresnel(cosine);
    return Weights(f, vec3(1.0) - f, vec3(1.0));
#else
    vec2 dfg = texture(u_dfg_table, vec2(cosine, u_roughness)).rg;
    vec3 compensation = vec3(1.0) + u_f0 * (1.0 / (dfg.x + dfg.y) - 1.0);
    vec3 reflected = (u_f0 * dfg.x + u_f90 * dfg.y) * compensation;
    return Weights(reflected, max(vec3(0.0), vec3(1.0) - reflected), compensation);
#endif
}

// Where light that leaves towards v came from; index is that behind the surface over that before it.
// Zero where it is reflected totally.
vec3 refracted(vec3 v, vec3 n, float index) {
    return refract(-v, n, 1.0 / index);
}
