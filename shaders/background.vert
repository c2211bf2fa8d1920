// One triangle that covers the picture, at the far end of what can be seen.
uniform mat3 u_ray;  // from (x, y, 1) on the picture, -1 to 1, to a direction in the world
#ifndef SIX_VIEWS  // else background.geom finds the rays
out vec3 v_ray;
#endif

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
#ifndef SIX_VIEWS
    v_ray = u_ray * vec3(corner, 1.0);
#endif
    gl_Position = vec4(corner, 1.0, 1.0);
}
