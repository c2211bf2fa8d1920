// Textures: pictures and environment maps on the graphics card, as half floats.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <mirrorball/environment_map.h>
#include <mirrorball/image.h>

#include "objects.h"

namespace mirrorball::gl {

/// A texture with what there is to know about it. Rows are stored from the top: t = 0 is there.
struct Texture {
    TextureName name;
    GLenum target = GL_TEXTURE_2D;
    int width = 0, height = 0, level_count = 1;
    int layer_count = 1;  ///< six of a cube

    /// Is it a name only?
    [[nodiscard]] bool empty() const { return width == 0; }
    void bind(int unit) const;
    /// Of all levels; 8 a texel.
    [[nodiscard]] std::uint64_t bytes() const;
};

/// \throws Error(Errc::unsupported) with both sizes if such a texture is larger than the driver
/// takes
void check_texture_size(GLenum target, int width, int height);

/// Lets lookups in cube maps filter across their edges: OpenGL ES always does, desktop OpenGL when
/// it is told.
void make_cubes_seamless();

/// Room without content, for drawing into: GL_TEXTURE_2D, GL_TEXTURE_2D_ARRAY or
/// GL_TEXTURE_CUBE_MAP. Filtered linearly, between levels too; held at its edges.
/// \throws Error(Errc::unsupported) as check_texture_size() does
[[nodiscard]] Texture make_texture(GLenum target, int width, int height, int level_count,
                                   int layer_count = 1);

/// What a map of this projection is uploaded as.
[[nodiscard]] GLenum target_for(Projection projection);

/// Fills a texture's levels. Values that a half float cannot hold are clamped.
[[nodiscard]] Texture upload(const Image& image, bool mips = false);

/// All levels of a picture, each half the one before, rounded down.
[[nodiscard]] Texture upload(std::span<const Image> levels);

/// A cube as a cube texture, a panorama, which repeats sideways, or an octahedral map as one
/// picture. Maps with rims are made by Warp.
[[nodiscard]] Texture upload(const EnvironmentMap& map);
/// A cube as six plain pictures that know nothing of each other.
[[nodiscard]] std::vector<Texture> upload_faces(const EnvironmentMap& cube);
/// The same as the layers of one array.
[[nodiscard]] Texture upload_face_array(const EnvironmentMap& cube);

}  // namespace mirrorball::gl
