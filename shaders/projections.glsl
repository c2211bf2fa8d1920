// From a direction (of any length but 0) in a map's own frame to its texture coordinates, and the
// solid angle of a square of that much of the texture: the formulas of include/mirrorball/projections.
// t grows downwards, and so do the rows of every texture.

const float kPi = 3.14159265358979;

vec2 from_disc(vec2 p) {
    return vec2(0.5 + 0.5 * p.x, 0.5 - 0.5 * p.y);
}

vec2 to_disc(vec2 st) {
    return vec2(2.0 * st.x - 1.0, 1.0 - 2.0 * st.y);
}

// Sphere map, Eq. 1 and 2.
vec2 sphere_st(vec3 r) {
    float m = sqrt(2.0 * length(r) * (length(r) + r.z));
    return from_disc(r.xy / max(m, 1e-20));
}

vec3 sphere_direction(vec2 st) {
    vec2 p = to_disc(st);
    float q = dot(p, p);
    if (q >= 1.0) return vec3(0.0, 0.0, -1.0);  // the rim, and all beyond
    return vec3(2.0 * sqrt(1.0 - q) * p, 1.0 - 2.0 * q);
}

// Dual paraboloid: which of the two maps, and where on it.
vec3 paraboloid_st(vec3 r) {
    return vec3(from_disc(r.xy / (length(r) + abs(r.z))), r.z >= 0.0 ? 0.0 : 1.0);
}

// Equirect: s around, t down from the pole.
vec2 equirect_st(vec3 d) {
    return vec2(0.5 + atan(d.x, -d.z) / (2.0 * kPi), acos(clamp(d.y / length(d), -1.0, 1.0)) / kPi);
}

vec3 equirect_direction(vec2 st) {
    float around = 2.0 * kPi * (st.x - 0.5), down = kPi * st.y;
    return vec3(sin(around) * sin(down), cos(down), -cos(around) * sin(down));
}

vec2 octahedral_st(vec3 d) {
    vec3 p = d / (abs(d.x) + abs(d.y) + abs(d.z));
    vec2 side = vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    return from_disc(p.z >= 0.0 ? p.xy : (1.0 - abs(p.yx)) * side);
}

vec3 octahedral_direction(vec2 st) {
    vec2 p = to_disc(st);
    float z = 1.0 - abs(p.x) - abs(p.y);
    vec2 side = vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    return vec3(z >= 0.0 ? p : (1.0 - abs(p.yx)) * side, z);
}

// Solid angle of a texel about d, a unit vector, of a cube whose faces have `size` texels a side.
float cube_texel_solid_angle(vec3 d, float size) {
    vec3 a = abs(d);
    float cosine = max(a.x, max(a.y, a.z));
    return 4.0 * cosine * cosine * cosine / (size * size);
}

// The direction of a place on a face of a cube; a and b from -1 to 1, b down.
vec3 cube_direction(int face, float a, float b) {
    if (face == 0) return vec3(1.0, -b, -a);
    if (face == 1) return vec3(-1.0, -b, a);
    if (face == 2) return vec3(a, 1.0, b);
    if (face == 3) return vec3(a, -1.0, -b);
    if (face == 4) return vec3(a, -b, 1.0);
    return vec3(-a, -b, -1.0);
}
