// What each pixel sees: position, normal, tangent frame, texture coordinates, object.
#include "normal.glsl"

in vec3 v_position, v_normal;
in vec2 v_texture_coordinate;
in vec4 v_tangent;
uniform float u_object;
layout(location = 0) out vec4 o_position;  // and the object's number
layout(location = 1) out vec4 o_normal;    // and s
layout(location = 2) out vec4 o_tangent;   // and t
layout(location = 3) out vec4 o_bitangent;

void main() {
    // The frame's vectors as they are to the interpolated normal, which is not of unit length.
    float squared = dot(v_normal, v_normal);
    float unit = squared > 0.0 ? inversesqrt(squared) : 0.0;
    vec3 bitangent = v_tangent.w * cross(v_normal, v_tangent.xyz);
    o_position = vec4(v_position, u_object);
    o_normal = vec4(unit_normal(v_normal), v_texture_coordinate.x);
    o_tangent = vec4(unit * v_tangent.xyz, v_texture_coordinate.y);
    o_bitangent = vec4(unit * bitangent, 0.0);
}
