// How much of each term of a material reaches the eye.
#define ADDED 0
#define LAYERED 1
#define SPLIT_SUM 2

const float PI = 3.14159265358979;

uniform vec3 u_base_color;
uniform sampler2D u_base_color_map;
uniform float u_mirror, u_glossy, u_diffuse, u_transmission, u_index;
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
};

Weights layer_weights(float n_dot_v) {
#if COUPLING == ADDED
    return Weights(fresnel(n_dot_v), vec3(1.0));
#elif COUPLING == LAYERED
    vec3 f = fresnel(n_dot_v);
    return Weights(f, vec3(1.0) - f);
#else
    vec2 dfg = texture(u_dfg_table, vec2(n_dot_v, u_roughness)).rg;
    float albedo = dfg.x + dfg.y;
    vec3 several_bounces = vec3(1.0) + u_f0 * (1.0 / albedo - 1.0);
    vec3 reflected = (u_f0 * dfg.x + u_f90 * dfg.y) * several_bounces;
    return Weights(reflected, max(vec3(0.0), vec3(1.0) - reflected));
#endif
}

vec3 transmitted(float n_dot_v) {
    return vec3(1.0) - fresnel(n_dot_v);
}
