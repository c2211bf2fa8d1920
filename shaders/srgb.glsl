// Linear light, 0 to 1, encoded for a screen.
float srgb(float y) {
    return y <= 0.0031308 ? 12.92 * y : 1.055 * pow(y, 1.0 / 2.4) - 0.055;
}

vec3 srgb(vec3 y) {
    vec3 held = clamp(y, 0.0, 1.0);
    return vec3(srgb(held.r), srgb(held.g), srgb(held.b));
}
