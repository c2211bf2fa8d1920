// MapTextures: what surfaces reflect, as the textures that a method looks up.
#pragma once

#include <vector>

#include <ImathMatrix.h>

#include <mirrorball/axes.h>
#include <mirrorball/scene.h>

#include "texture.h"

namespace mirrorball::gl {

/// The matrix that takes a direction of the world, as a column, into a map's frame.
[[nodiscard]] Imath::M33f to_map_matrix(const Axes& axes);

/// What mirrors see, what each lobe makes of it, irradiance. Those that nobody looks up are empty.
struct MapTextures {
    Texture mirror;
    std::vector<Texture> glossy;  ///< in the order of the lobes
    Texture diffuse;
    Texture rough;  ///< mipmapped: see ReflectionMaps
    // Of split polygons, which know one face each.
    std::vector<Texture> mirror_faces;
    std::vector<std::vector<Texture>> glossy_faces;  ///< [lobe][face]

    [[nodiscard]] std::uint64_t bytes() const;
};

/// One object's choice of them, and how they are to be looked up. Textures belong to others.
struct LookupMaps {
    Method method = Method::cube;
    Axes axes;  ///< of the lookup
    const MapTextures* textures = nullptr;
    const Texture* diffuse = nullptr;
    std::size_t lobe = 0;     ///< the index of the material's own, if it has one
    bool by_chain = false;    ///< its lobe has no map: it is looked up in textures->rough
    double mirror_alpha = 0;  ///< for rough_place(), if there are rough maps
    double intensity = 1;     ///< that the maps' light is multiplied by
    Proxy proxy;              ///< for the places that the maps show
    Vec3d captured_at{0};
};

}  // namespace mirrorball::gl
