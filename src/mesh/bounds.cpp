#include <algorithm>
#include <cassert>

#include <mirrorball/mesh.h>

namespace mirrorball {

Bounds bounds(const Mesh& mesh) {
    assert(!mesh.positions.empty());
    Bounds result{Vec3d(mesh.positions.front()), Vec3d(mesh.positions.front()), 0};
    for (const Vec3f& position : mesh.positions) {
        for (int i = 0; i < 3; ++i) {
            result.least[i] = std::min(result.least[i], static_cast<double>(position[i]));
            result.most[i] = std::max(result.most[i], static_cast<double>(position[i]));
        }
    }
    for (const Vec3f& position : mesh.positions)
        result.radius = std::max(result.radius, (Vec3d(position) - result.centre()).length());
    return result;
}

}  // namespace mirrorball
