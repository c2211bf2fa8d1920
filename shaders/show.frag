// Pictures of linear light put on the screen: one, two side by side, or how much they differ.
// SHOW says which: ONE, WIPE or DIFFERENCE; or AVERAGE, which leaves the light linear.
#define ONE 0
#define WIPE 1
#define DIFFERENCE 2
#define AVERAGE 3

out vec4 o_color;

uniform sampler2D u_first;
#if SHOW == WIPE || SHOW == DIFFERENCE
uniform sampler2D u_second;
#endif
uniform vec2 u_origin;       // where the picture's lower left corner is
uniform float u_wipe;        // in pixels from the left
uniform float u_full_scale;  // the difference that is white

float srgb(float y) {
    return y <= 0.0031308 ? 12.92 * y : 1.055 * pow(y, 1.0 / 2.4) - 0.055;
}

vec3 srgb(vec3 y) {
    vec3 held = clamp(y, 0.0, 1.0);
    return vec3(srgb(held.r), srgb(held.g), srgb(held.b));
}

float ramp(float t, float from, float to) {
    return clamp((t - from) / (to - from), 0.0, 1.0);
}

// Black, violet, red, orange, white: as src/cli/false_color.cpp has them.
vec3 false_color(float t) {
    return vec3(ramp(t, 0.05, 0.6), pow(ramp(t, 0.4, 0.95), 1.5),
                max(0.35 * ramp(t, 0.0, 0.2) * (1.0 - ramp(t, 0.35, 0.6)), ramp(t, 0.8, 1.0)));
}

void main() {
    vec2 place = gl_FragCoord.xy - u_origin;
    ivec2 pixel = ivec2(place);
    vec3 first = texelFetch(u_first, pixel, 0).rgb;
#if SHOW == ONE
    o_color = vec4(srgb(first), 1.0);
#elif SHOW == WIPE
    vec3 second = texelFetch(u_second, pixel, 0).rgb;
    o_color = vec4(srgb(place.x < u_wipe ? first : second), 1.0);
#elif SHOW == DIFFERENCE
    vec3 apart = abs(srgb(first) - srgb(texelFetch(u_second, pixel, 0).rgb));
    o_color = vec4(false_color(max(apart.r, max(apart.g, apart.b)) / u_full_scale), 1.0);
#else
    o_color = vec4(first, 1.0);
#endif
}
