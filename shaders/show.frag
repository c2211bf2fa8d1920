// Pictures put on the screen: one, two side by side, or how much they differ. SHOW says which: ONE,
// WIPE or DIFFERENCE; or AVERAGE, which leaves light linear. FIRST_ENCODED and SECOND_ENCODED are
// defined where that picture is encoded as sRGB already.
#define ONE 0
#define WIPE 1
#define DIFFERENCE 2
#define AVERAGE 3
#include "srgb.glsl"

out vec4 o_color;

uniform sampler2D u_first;
#if SHOW == WIPE || SHOW == DIFFERENCE
uniform sampler2D u_second;
#endif
uniform vec2 u_origin;       // where the picture's lower left corner is
uniform float u_wipe;        // in pixels from the left
uniform float u_full_scale;  // the difference that is white

vec3 first(ivec2 pixel) {
    vec3 y = texelFetch(u_first, pixel, 0).rgb;
#if defined(FIRST_ENCODED) || SHOW == AVERAGE
    return y;
#else
    return srgb(y);
#endif
}

#if SHOW == WIPE || SHOW == DIFFERENCE
vec3 second(ivec2 pixel) {
    vec3 y = texelFetch(u_second, pixel, 0).rgb;
#ifdef SECOND_ENCODED
    return y;
#else
    return srgb(y);
#endif
}
#endif

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
#if SHOW == WIPE
    o_color = vec4(place.x < u_wipe ? first(pixel) : second(pixel), 1.0);
#elif SHOW == DIFFERENCE
    vec3 apart = abs(first(pixel) - second(pixel));
    o_color = vec4(false_color(max(apart.r, max(apart.g, apart.b)) / u_full_scale), 1.0);
#else
    o_color = vec4(first(pixel), 1.0);
#endif
}
