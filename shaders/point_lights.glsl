// Lights without extent, Eq. 15: the glossy lobe as a BRDF of its own, of which mirrors show nothing.
// The formulas are those of include/mirrorball/brdf.h.
#ifdef LIGHT_COUNT
#define PHONG 1
#define BLINN_PHONG 2
#define GGX 3
#define CHARLIE 4

uniform vec3 u_light_place[LIGHT_COUNT];     // position, or unit direction towards it
uniform vec3 u_light_strength[LIGHT_COUNT];  // W/sr, or W/m^2
uniform float u_light_is_point[LIGHT_COUNT];
uniform float u_exponent;    // of phong and blinn-phong
uniform float u_lobe_scale;  // that normalises those

// The lobe's BRDF times its weight in the layer. `added_alpha2` makes GGX rougher.
vec3 glossy_brdf(vec3 n, vec3 l, vec3 v, Weights weights, float added_alpha2) {
    vec3 h = normalize(l + v);
    float n_dot_l = dot(n, l), n_dot_v = dot(n, v), n_dot_h = dot(n, h);
#if LOBE == PHONG
    float cosine = dot(2.0 * n_dot_v * n - v, l);
    return weights.layer * (cosine > 0.0 ? u_lobe_scale * pow(cosine, u_exponent) : 0.0);
#elif LOBE == BLINN_PHONG
    return weights.layer * (n_dot_h > 0.0 ? u_lobe_scale * pow(n_dot_h, u_exponent) : 0.0);
#elif LOBE == GGX
    float alpha = u_roughness * u_roughness;
    float alpha2 = min(1.0, alpha * alpha + added_alpha2);
    if (alpha2 < 1e-8) return vec3(0.0);  // a mirror
    vec3 across = h - n_dot_h * n;  // its length is the sine, which does not cancel
    float spread = dot(across, across) / alpha2 + n_dot_h * n_dot_h;
    float d = 1.0 / (PI * alpha2 * spread * spread);
    // G / (4 n.l n.v), with Smith's Lambda times the cosine
    float to_light = 0.5 * (sqrt(n_dot_l * n_dot_l * (1.0 - alpha2) + alpha2) - n_dot_l);
    float to_eye = 0.5 * (sqrt(n_dot_v * n_dot_v * (1.0 - alpha2) + alpha2) - n_dot_v);
    float visible = 0.25 / (n_dot_l * n_dot_v + n_dot_v * to_light + n_dot_l * to_eye);
    return weights.compensation * fresnel(clamp(dot(v, h), 0.0, 1.0)) * (d * visible);
#elif LOBE == CHARLIE
    float sharpness = 1.0 / (u_roughness * u_roughness);
    float d = (2.0 + sharpness) * pow(length(h - n_dot_h * n), sharpness) / (2.0 * PI);
    return weights.layer * (d * 0.25 / (n_dot_l + n_dot_v - n_dot_l * n_dot_v));
#else
    return vec3(0.0);
#endif
}

// Radiance to the eye: of a base of base_color 1, and of the layer over it.
struct Lit {
    vec3 base, layer;
};

Lit light_of_lights(vec3 position, vec3 n, vec3 v, Weights weights, float added_alpha2) {
    Lit lit = Lit(vec3(0.0), vec3(0.0));
    for (int i = 0; i < LIGHT_COUNT; ++i) {
        vec3 to_light = u_light_place[i] - u_light_is_point[i] * position;
        float distance2 = dot(to_light, to_light);
        vec3 l = to_light * inversesqrt(max(distance2, 1e-30));
        float n_dot_l = dot(n, l);
        if (n_dot_l <= 0.0) continue;
        vec3 arriving =
            u_light_strength[i] * n_dot_l / (u_light_is_point[i] > 0.0 ? distance2 : 1.0);
        lit.base += arriving;
#ifdef HAS_GLOSSY
        lit.layer += u_glossy * glossy_brdf(n, l, v, weights, added_alpha2) * arriving;
#endif
    }
    lit.base *= weights.base * u_diffuse / PI;
    return lit;
}
#endif
