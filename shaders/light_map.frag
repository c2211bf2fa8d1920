// A light map: what each normal of an object sends to an eye far away at +z of the map's frame, as a
// sphere map. LAYER: 0 the base, of base_color 1; 1 the layer over it.
#include "material.glsl"
#include "point_lights.glsl"
#include "projections.glsl"

uniform vec2 u_size;       // of the map in texels
uniform vec3 u_centre;     // of the object, in the world
uniform mat3 u_to_world;   // from the map's frame
out vec4 o_color;

void main() {
    vec2 p = to_disc(vec2(gl_FragCoord.x, gl_FragCoord.y) / u_size);
    float beyond = max(1.0, length(p));
    p /= beyond;  // beyond the rim what is on it
    vec3 m = vec3(p, sqrt(max(0.0, 1.0 - dot(p, p))));
    vec3 n = u_to_world * m, v = u_to_world * vec3(0.0, 0.0, 1.0);
    Lit lit = light_of_lights(u_centre, n, v, layer_weights(m.z), 0.0);
#if LAYER == 0
    o_color = vec4(lit.base, 1.0);
#else
    o_color = vec4(lit.layer, 1.0);
#endif
}
