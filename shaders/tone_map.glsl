// Tone mapping: from radiance without a limit to linear light from 0 to 1, as tone_map.h has it.
// Formulas and sources are there and in src/image/tone_map.cpp; the numbers are the same.
// For GLSL 4.50 and GLSL ES 3.00; whoever includes this says the version and the precision.

// Defined where pictures are tone mapped: TONE_MAP, as below. A choice at run time would cost software
// that draws without a graphics card all five, for it has no branches.
#define NO_TONE_MAP 0
#define REINHARD 1
#define ACES 2
#define AGX 3
#define FILM 4

uniform float u_exposure;

vec3 reinhard(vec3 x) {
    return x / (1.0 + x);
}

vec3 aces(vec3 x) {
    vec3 u = 0.6 * min(x, 1e6);
    return min(u * (2.51 * u + 0.03) / (u * (2.43 * u + 0.59) + 0.14), 1.0);
}

// From the pivot: `scale` is such that the curve ends at 0 or 1.
float agx_half(float z, float scale, float power) {
    z *= 2.0 / scale;
    return scale * z / pow(1.0 + pow(z, power), 1.0 / power);
}

float agx_curve(float x) {
    const float pivot_u = 0.606060606, pivot_y = 0.458656447;
    float u = clamp((log2(max(x, 1e-10) / 0.18) + 10.0) / 16.5, 0.0, 1.0);
    return u < pivot_u ? pivot_y - agx_half(pivot_u - u, 0.467251881, 3.0)
                       : pivot_y + agx_half(u - pivot_u, 0.602899376, 3.25);
}

vec3 agx(vec3 x) {
    const mat3 mix_colours = mat3(0.8425, 0.0423, 0.0424,   // columns
                                  0.0784, 0.8785, 0.0784,
                                  0.0791, 0.0792, 0.8792);
    const mat3 unmix_colours = mat3(1.1968381468, -0.0528494118, -0.0530056228,
                                    -0.0979877515, 1.1518560180, -0.0979877515,
                                    -0.0988503952, -0.0990066062, 1.1509933743);
    x = mix_colours * x;
    vec3 y = unmix_colours * vec3(agx_curve(x.r), agx_curve(x.g), agx_curve(x.b));
    return pow(clamp(y, 0.0, 1.0), vec3(2.2));
}

vec3 film(vec3 x) {
    vec3 y = x * sqrt(sqrt(x));
    return y / (y + 0.534111561);
}

// What is no number or negative is black, what is infinite as bright as can be.
float exposed(float radiance) {
    float x = radiance * u_exposure;
    return x > 0.0 ? min(x, 1e10) : 0.0;
}

#ifdef TONE_MAP
vec3 tone_mapped(vec3 radiance) {
    vec3 x = vec3(exposed(radiance.r), exposed(radiance.g), exposed(radiance.b));
#if TONE_MAP == NO_TONE_MAP
    return min(x, 1.0);
#elif TONE_MAP == REINHARD
    return reinhard(x);
#elif TONE_MAP == ACES
    return aces(x);
#elif TONE_MAP == AGX
    return agx(x);
#else
    return film(x);
#endif
}
#endif
