// Where a map was captured is one place; a ray from another place meets the walls elsewhere. The
// direction from the capture to where the ray meets the proxy is what to look up.
#define NO_PROXY 0
#define BOX_PROXY 1
#define SPHERE_PROXY 2

uniform vec3 u_captured_at;
uniform vec3 u_proxy_least, u_proxy_most;  // of a box
uniform vec3 u_proxy_centre;               // of a sphere
uniform float u_proxy_radius;

vec3 seen_from_capture(vec3 position, vec3 d) {
#if PROXY == BOX_PROXY
    vec3 a = (u_proxy_least - position) / d, b = (u_proxy_most - position) / d;
    vec3 enter = min(a, b), leave = max(a, b);
    float near = max(0.0, max(enter.x, max(enter.y, enter.z)));
    float far = min(leave.x, min(leave.y, leave.z));
    return near <= far ? position + far * d - u_captured_at : d;
#elif PROXY == SPHERE_PROXY
    vec3 from_centre = position - u_proxy_centre;
    float b = dot(from_centre, d);
    float inside = b * b - dot(from_centre, from_centre) + u_proxy_radius * u_proxy_radius;
    float t = sqrt(max(inside, 0.0)) - b;
    return inside >= 0.0 && t > 0.0 ? position + t * d - u_captured_at : d;
#else
    return d;
#endif
}
