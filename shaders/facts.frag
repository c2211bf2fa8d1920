// What each pixel sees: position, normal, texture coordinates, object.
#include "normal.glsl"

in vec3 v_position, v_normal;
in vec2 v_texture_coordinate;
uniform float u_object;
layout(location = 0) out vec4 o_position;  // and the object's number
layout(location = 1) out vec4 o_normal;
layout(location = 2) out vec4 o_texture_coordinate;

void main() {
    o_position = vec4(v_position, u_object);
    o_normal = vec4(unit_normal(v_normal), 0.0);
    o_texture_coordinate = vec4(v_texture_coordinate, 0.0, 0.0);
}
