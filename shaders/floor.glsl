// What is seen through a surface that transmits: a level floor, or the environment.
#ifdef HAS_TRANSMISSION
#ifdef HAS_FLOOR
uniform float u_floor_height;
uniform vec3 u_floor_color, u_floor_absorption;
uniform float u_floor_width;  // of the picture, in metres
uniform sampler2D u_floor_map;

vec3 floor_light(vec3 position, vec3 t) {
    float along = (u_floor_height - position.y) / t.y;
    vec3 color = u_floor_color;
#ifdef HAS_FLOOR_MAP
    vec2 place = (position + t * along).xz / u_floor_width;
    color *= texture(u_floor_map, place).rgb;
#endif
    return color * exp(-u_floor_absorption * along) * irradiance(vec3(0.0, 1.0, 0.0)) / PI;
}
#endif

vec3 through_surface(vec3 position, vec3 t) {
#if defined(HAS_BUMP) && BUMP_FORM == CLASSIC
    place_shift = vec2(0.0);  // only what is reflected moves
#endif
#ifdef HAS_FLOOR
    if (t.y < 0.0 && position.y > u_floor_height) return floor_light(position, t);
#endif
    return mirrored_light(seen_from_capture(position, t));
}
#endif
