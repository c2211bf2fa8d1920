// Linear light, 0 to 1, encoded for a screen.
// 1.055 y^(1/2.4) - 0.055 by a polynomial in the fourth root, within 4e-5, a hundredth of what a
// screen's steps are: drivers without a graphics card take a power for several roots.
float srgb(float y) {
    float r = sqrt(sqrt(y));
    float power = -0.0646115 + r * (0.1961359 + r * (1.1226815 + r * (-0.3355014 + r * 0.0813299)));
    return y <= 0.0031308 ? 12.92 * y : power;
}

vec3 srgb(vec3 y) {
    vec3 held = clamp(y, 0.0, 1.0);
    return vec3(srgb(held.r), srgb(held.g), srgb(held.b));
}
