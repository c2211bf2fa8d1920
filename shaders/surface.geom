// Six views in one pass: each triangle into the six layers of a cube map. Desktop OpenGL only.
layout(triangles, invocations = 6) in;
layout(triangle_strip, max_vertices = 3) out;

uniform mat4 u_face_to_clip[6];  // from the world

in vec3 g_position[], g_normal[];
in vec2 g_texture_coordinate[];
out vec3 v_position, v_normal;
out vec2 v_texture_coordinate;
#ifdef HAS_TANGENTS
in vec4 g_tangent[];
out vec4 v_tangent;
#endif

void main() {
    for (int i = 0; i < 3; ++i) {
        v_position = g_position[i];
        v_normal = g_normal[i];
        v_texture_coordinate = g_texture_coordinate[i];
#ifdef HAS_TANGENTS
        v_tangent = g_tangent[i];
#endif
        gl_Position = u_face_to_clip[gl_InvocationID] * vec4(g_position[i], 1.0);
        gl_Layer = gl_InvocationID;
        EmitVertex();
    }
}
