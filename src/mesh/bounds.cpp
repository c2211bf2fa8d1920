#include <algorithm>
#include <cassert>

#include <mirrorball/mesh.h>

namespace mirrorball {

Bounds bounds(const Mesh& mesh) {
    assert(!mesh.positions.empty());
    Bounds result{Vec3d(mesh.positions.front()), Vec3d(mesh.positions.front())};
    for (const Vec3f& position : mesh.positions) {
        for (int i = 0; i < 3; ++i) {
            result.least[i] = std::min(result.least[i], static_cast<double>(position[i]));
            result.most[i] = std::max(result.most[i], static_cast<double>(position[i]));
        }
    }
    return result;
}

}  // namespace mirrorball
