// Normals as meshes have them, interpolated: where they cancel out, or files had none, up is as good as
// any. What is no number would spread.
vec3 unit_normal(vec3 n) {
    float squared = dot(n, n);
    return squared > 0.0 ? n * inversesqrt(squared) : vec3(0.0, 1.0, 0.0);
}
