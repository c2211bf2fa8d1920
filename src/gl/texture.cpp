#include "texture.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <mirrorball/error.h>

#include "check.h"

namespace mirrorball::gl {
namespace {

constexpr float kLargestHalf = 65504;

// A number that a half float holds: NaN counts as 0.
float held(float value) {
    return value >= -kLargestHalf ? std::min(value, kLargestHalf) : value < 0 ? -kLargestHalf : 0;
}

std::vector<float> rgba(const Image& image) {
    std::vector<float> result;
    result.reserve(static_cast<std::size_t>(image.texel_count()) * 4);
    const int channels = image.channels();
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            const float* texel = image.at(x, y);
            for (int c = 0; c < 3; ++c) result.push_back(held(texel[channels >= 3 ? c : 0]));
            result.push_back(channels == 4 ? held(texel[3]) : 1);
        }
    }
    return result;
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
    const std::vector<float> values = rgba(image);
    const int width = image.width(), height = image.height();
    if (texture.target == GL_TEXTURE_2D_ARRAY) {
        glTexSubImage3D(texture.target, level, 0, 0, layer, width, height, 1, GL_RGBA, GL_FLOAT,
                        values.data());
    } else {
        const GLenum target = texture.target == GL_TEXTURE_CUBE_MAP
                                  ? GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(layer)
                                  : texture.target;
        glTexSubImage2D(target, level, 0, 0, width, height, GL_RGBA, GL_FLOAT, values.data());
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
