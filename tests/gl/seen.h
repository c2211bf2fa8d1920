// What a pixel sees, for tests that need to know where it is looked up.
#pragma once

#include <mirrorball/direct.h>
#include <mirrorball/vector.h>

namespace mirrorball::gl {

/// A place on a surface, as an eye sees it.
struct Seen {
    Vec3d position, n, v;  ///< n on the eye's side
    bool behind = false;   ///< the mesh's normal points away from the eye

    [[nodiscard]] Vec3d r() const { return n * (2 * n.dot(v)) - v; }
    /// Refracted; 0 where all is reflected.
    [[nodiscard]] Vec3d t(double index) const {
        return refracted(v, n, behind ? 1 / index : index);
    }
};

inline Seen seen_at(const SurfaceBuffer& buffer, int x, int y, const Vec3d& eye) {
    const Vec3d position(buffer.position.rgb(x, y)), normal(buffer.normal.rgb(x, y));
    const Vec3d v = (eye - position).normalized();
    const bool behind = normal.dot(v) < 0;
    return {position, behind ? -normal : normal, v, behind};
}

inline int object_at(const SurfaceBuffer& buffer, int x, int y) {
    return static_cast<int>(*buffer.object.at(x, y));
}

}  // namespace mirrorball::gl
