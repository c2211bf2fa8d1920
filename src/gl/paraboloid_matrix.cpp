#include "paraboloid_matrix.h"

namespace mirrorball::gl {

// The survey writes matrices for columns, here they are for rows: transposed, and in reverse order.
Imath::M44d paraboloid_matrix(const Axes& map, bool front) {
    const auto& [x, y, z] = map;
    const Imath::M44d to_map(x.x, y.x, z.x, 0, x.y, y.y, z.y, 0, x.z, y.z, z.z, 0, 0, 0, 0, 1);
    const double d_z = front ? -1 : 1;
    const Imath::M44d s(-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, d_z, -1);
    const Imath::M44d p(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0);
    // s = x/2 + 1/2, t = -y/2 + 1/2; the 1/2 is of q, P's last row
    const double sign = front ? 0.5 : -0.5;
    const Imath::M44d t(sign, 0, 0, 0, 0, -sign, 0, 0, 0, 0, 1, 0, 0.5, 0.5, 0, 1);
    return to_map * s * p * t;
}

}  // namespace mirrorball::gl
