// What a half float holds of a colour: NaN and negative light are 0, what is too bright the brightest.
float held(float x) {
    return x > 0.0 ? min(x, 65504.0) : 0.0;
}

vec3 held(vec3 color) {
    return vec3(held(color.r), held(color.g), held(color.b));
}
