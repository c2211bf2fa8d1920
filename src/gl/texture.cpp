#include "texture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <fmt/format.h>

#include <mirrorball/error.h>

#include "check.h"
#include "io/packed.h"

namespace mirrorball::gl {
namespace {

// Four half floats a texel, which drivers take as they are. What is too large for one becomes the
// largest there is, and what is no number 0: it would spread.
std::vector<std::uint16_t> half_texels(const Image& image) {
    constexpr std::uint16_t kSign = 0x8000, kInfinite = 0x7c00, kLargest = 0x7bff;
    std::vector<std::uint16_t> halves(static_cast<std::size_t>(image.texel_count()) * 4);
    detail::pack(detail::Packing::rgba16f, image, std::as_writable_bytes(std::span(halves)));
    for (std::uint16_t& half : halves) {
        const std::uint16_t size = half & ~kSign, sign = half & kSign;
        half = size < kInfinite ? half : size > kInfinite ? 0 : sign | kLargest;
    }
    return halves;
}

void set_parameters(const Texture& texture) {
    const GLenum target = texture.target;
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER,
                    texture.level_count > 1 ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, texture.level_count - 1);
}

int largest_size(GLenum target) {
    GLint size = 0;
    glGetIntegerv(
        target == GL_TEXTURE_CUBE_MAP ? GL_MAX_CUBE_MAP_TEXTURE_SIZE : GL_MAX_TEXTURE_SIZE, &size);
    return size;
}

// Writes a picture into one layer or face of a level of the texture that is bound.
void fill(const Texture& texture, int level, int layer, const Image& image) {
    const std::vector<std::uint16_t> texels = half_texels(image);
    const int width = image.width(), height = image.height();
    if (texture.target == GL_TEXTURE_2D_ARRAY) {
        glTexSubImage3D(texture.target, level, 0, 0, layer, width, height, 1, GL_RGBA,
                        GL_HALF_FLOAT, texels.data());
    } else {
        const GLenum target = texture.target == GL_TEXTURE_CUBE_MAP
                                  ? GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(layer)
                                  : texture.target;
        glTexSubImage2D(target, level, 0, 0, width, height, GL_RGBA, GL_HALF_FLOAT, texels.data());
    }
}

Texture upload_as(GLenum target, const EnvironmentMap& map) {
    const int face_count = mirrorball::face_count(map.projection);
    Texture texture =
        make_texture(target, map.width(), map.height(), map.level_count(), face_count);
    for (int level = 0; level < map.level_count(); ++level) {
        for (int face = 0; face < face_count; ++face) {
            fill(texture, level, face, map.levels[level].faces[face]);
        }
    }
    check("taking an environment map");
    return texture;
}

}  // namespace

void Texture::bind(int unit) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(target, name.name());
}

std::uint64_t Texture::bytes() const {
    if (empty()) return 0;
    std::uint64_t texels = 0;
    for (int level = 0; level < level_count; ++level) {
        texels += static_cast<std::uint64_t>(std::max(1, width >> level)) *
                  static_cast<std::uint64_t>(std::max(1, height >> level));
    }
    return texels * static_cast<std::uint64_t>(layer_count) * 8;
}

void make_cubes_seamless() {
    if (is_desktop()) glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
}

GLenum target_for(Projection projection) {
    switch (projection) {
        case Projection::cube:
            return GL_TEXTURE_CUBE_MAP;
        case Projection::dual_paraboloid:
            return GL_TEXTURE_2D_ARRAY;
        default:
            return GL_TEXTURE_2D;
    }
}

void check_texture_size(GLenum target, int width, int height) {
    const int largest = largest_size(target);
    if (std::max(width, height) <= largest) return;
    throw Error(Errc::unsupported,
                fmt::format("a map of {} x {} texels was asked for, but this OpenGL driver takes "
                            "{} x {} at most",
                            width, height, largest, largest));
}

Texture make_texture(GLenum target, int width, int height, int level_count, int layer_count) {
    check_texture_size(target, width, height);
    Texture texture{{}, target, width, height, level_count, layer_count};
    texture.bind(0);
    if (target == GL_TEXTURE_2D_ARRAY) {
        glTexStorage3D(target, level_count, GL_RGBA16F, width, height, layer_count);
    } else {
        glTexStorage2D(target, level_count, GL_RGBA16F, width, height);
    }
    set_parameters(texture);
    check(fmt::format("making room for a map of {} x {} texels", width, height));
    return texture;
}

Texture upload(const Image& image, bool mips) {
    const int largest = std::max(image.width(), image.height());
    const int level_count = mips ? 1 + static_cast<int>(std::log2(largest)) : 1;
    Texture texture = make_texture(GL_TEXTURE_2D, image.width(), image.height(), level_count);
    fill(texture, 0, 0, image);
    if (mips) glGenerateMipmap(GL_TEXTURE_2D);
    check("taking a picture");
    return texture;
}

Texture upload(std::span<const Image> levels) {
    const Image& first = levels.front();
    Texture texture =
        make_texture(GL_TEXTURE_2D, first.width(), first.height(), static_cast<int>(levels.size()));
    for (int level = 0; level < texture.level_count; ++level)
        fill(texture, level, 0, levels[static_cast<std::size_t>(level)]);
    check("taking the levels of a picture");
    return texture;
}

Texture upload(const EnvironmentMap& map) {
    Texture texture = upload_as(target_for(map.projection), map);
    if (map.projection == Projection::equirect)
        glTexParameteri(texture.target, GL_TEXTURE_WRAP_S, GL_REPEAT);
    return texture;
}

Texture upload_face_array(const EnvironmentMap& cube) {
    return upload_as(GL_TEXTURE_2D_ARRAY, cube);
}

std::vector<Texture> upload_faces(const EnvironmentMap& cube) {
    std::vector<Texture> textures;
    for (int face = 0; face < Cube::face_count; ++face) {
        Texture& texture = textures.emplace_back(
            make_texture(GL_TEXTURE_2D, cube.width(), cube.height(), cube.level_count()));
        for (int level = 0; level < cube.level_count(); ++level)
            fill(texture, level, 0, cube.levels[level].faces[face]);
    }
    check("taking the faces of a cube map");
    return textures;
}

}  // namespace mirrorball::gl
