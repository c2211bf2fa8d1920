// The background of six views in one pass, each its own layer of a cube map. Desktop OpenGL only.
layout(triangles, invocations = 6) in;
layout(triangle_strip, max_vertices = 3) out;

uniform mat3 u_face_ray[6];
out vec3 v_ray;

void main() {
    for (int i = 0; i < 3; ++i) {
        v_ray = u_face_ray[gl_InvocationID] * vec3(gl_in[i].gl_Position.xy, 1.0);
        gl_Position = gl_in[i].gl_Position;
        gl_Layer = gl_InvocationID;
        EmitVertex();
    }
}
