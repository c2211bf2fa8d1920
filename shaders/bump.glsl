// Relief in shading only: BumpMap in include/mirrorball/scene.h.
//
// Defined by the renderer: BUMP_FORM; BUMP_FILTER; HAS_RELIEF, HAS_HORIZON.
#define NORMALS 0
#define CLASSIC 1
#define NONE 0
#define MEAN 1
#define VARIANCE 2

uniform sampler2D u_bump_map;  // du, dv, their variance over all directions, height from 0 to 1
uniform float u_bump_strength;
uniform vec2 u_bump_repeat, u_bump_offset;
uniform float u_bump_relief;
uniform vec4 u_bump_matrix;     // m00, m01, m10, m11
uniform vec2 u_bump_luminance;  // scale, offset

// What a pixel sees of a bump map.
struct Bump {
    vec2 slopes;
    float variance, height;
};

// Places are in tiles, from the top left.
vec2 bump_place(vec2 texture_coordinate) {
    return texture_coordinate * u_bump_repeat + u_bump_offset;
}

Bump bump_at(vec2 place, vec2 place_dx, vec2 place_dy) {
#if BUMP_FILTER == NONE
    vec4 texel = textureLod(u_bump_map, place, 0.0);
#else
    vec4 texel = textureGrad(u_bump_map, place, place_dx, place_dy);
#endif
    float variance = 0.0;
#if BUMP_FILTER == VARIANCE
    variance = texel.b * u_bump_strength * u_bump_strength;
#endif
    return Bump(texel.rg * u_bump_strength, variance, texel.a);
}

// Slopes of a normal distribution are Beckmann's with alpha^2 = 2 variance; a GGX lobe has long
// tails, and the same median with ln 2 of that.
float added_alpha2(float variance) {
    return 1.386294 * variance;
}

#ifdef HAS_RELIEF
bool is_in_relief(vec2 place, float depth, float level) {
    return 1.0 - textureLod(u_bump_map, place, level).a <= depth;
}

// Where the eye, looking along -v, meets the relief whose top it meets at `place`; v in the tangent
// frame. Steps find it roughly, halvings finely.
vec2 seen_in_relief(vec2 place, vec3 v, vec2 place_dx, vec2 place_dy) {
    const int kSteps = 32, kHalvings = 6;
    const float kMostGrazing = 0.1;  // beyond it the relief is seen as if from there
    vec2 size = vec2(textureSize(u_bump_map, 0)), x = place_dx * size, y = place_dy * size;
    float level = max(0.0, 0.5 * log2(max(max(dot(x, x), dot(y, y)), 1e-20)));
    vec2 way = vec2(-v.x, v.y) * (u_bump_relief / max(v.z, kMostGrazing));
    if (is_in_relief(place, 0.0, level)) return place;
    float above = 0.0, inside = 1.0;
    for (int i = 1; i <= kSteps; ++i) {
        float depth = float(i) / float(kSteps);
        if (is_in_relief(place + way * depth, depth, level)) {
            inside = depth;
            break;
        }
        above = depth;
    }
    for (int i = 0; i < kHalvings; ++i) {
        float middle = 0.5 * (above + inside);
        if (is_in_relief(place + way * middle, middle, level)) {
            inside = middle;
        } else {
            above = middle;
        }
    }
    return place + way * inside;
}
#endif

// How a place on a sphere map moves.
vec2 bump_shift(vec2 slopes) {
    vec2 gradient = vec2(slopes.x, -slopes.y);  // dH/ds, dH/dt
    return vec2(dot(u_bump_matrix.xy, gradient), dot(u_bump_matrix.zw, gradient));
}

float bump_luminance(float height) {
    return clamp(u_bump_luminance.x * height + u_bump_luminance.y, 0.0, 1.0);
}

// The share of a reflection that the surface's own relief lets pass.
float above_horizon(vec3 r, vec3 smooth_normal) {
    float share = clamp(1.0 + dot(r, smooth_normal), 0.0, 1.0);
    return share * share;
}
