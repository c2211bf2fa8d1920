// Lights without extent, Eq. 15.
#ifdef LIGHT_COUNT
uniform vec3 u_light_place[LIGHT_COUNT];     // position, or direction towards it
uniform vec3 u_light_strength[LIGHT_COUNT];  // W/sr, or W/m^2
uniform float u_light_is_point[LIGHT_COUNT];

vec3 point_lights(vec3 position, vec3 n, vec3 v, vec3 base_color, Weights weights) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < LIGHT_COUNT; ++i) {
        vec3 to_light = u_light_place[i] - u_light_is_point[i] * position;
        vec3 l = normalize(to_light);
        float n_dot_l = dot(n, l);
        if (n_dot_l <= 0.0) continue;
        float falloff = u_light_is_point[i] > 0.0 ? 1.0 / dot(to_light, to_light) : 1.0;
        vec3 f = weights.base * u_diffuse * base_color / PI;
        sum += f * u_light_strength[i] * falloff * n_dot_l;
    }
    return sum;
}
#endif
