// Light of lights by a sphere map made for it: light_map.frag.
#ifdef HAS_LIGHT_MAP
uniform sampler2DArray u_light_map;  // what the base reflects, of base_color 1; what the layer does

vec3 light_map_light(vec3 r, vec3 base_color) {
#if METHOD == SPHERE_VERTEX
    vec2 st = SHIFTED(v_mirror_place.xy);
#else
    vec2 st = SHIFTED(sphere_st(u_to_map * r));
#endif
    // Beyond the rim all is as on it.
    vec2 p = to_disc(st);
    st = from_disc(p / max(1.0, length(p)));
    return base_color * texture(u_light_map, vec3(st, 0.0)).rgb +
           texture(u_light_map, vec3(st, 1.0)).rgb;
}
#endif
