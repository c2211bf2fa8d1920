#include "map_textures.h"

namespace mirrorball::gl {

Imath::M33f to_map_matrix(const Axes& axes) {
    const auto& [x, y, z] = axes;
    return Imath::M33f(Imath::M33d(x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z));
}

std::uint64_t MapTextures::bytes() const {
    std::uint64_t sum = mirror.bytes() + diffuse.bytes() + rough.bytes();
    for (const Texture& texture : glossy) sum += texture.bytes();
    return sum;
}

}  // namespace mirrorball::gl
