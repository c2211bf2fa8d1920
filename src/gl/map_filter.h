// MapFilter: what is made of a cube map on the graphics card: mip levels, what a lobe makes of it,
// irradiance.
#pragma once

#include <vector>

#include <mirrorball/lobe.h>
#include <mirrorball/scene.h>

#include "map_textures.h"
#include "program.h"
#include "texture.h"

namespace mirrorball::gl {

class MapFilter {
  public:
    /// Room for the cube maps that a material looks up, of that size.
    [[nodiscard]] static MapTextures room(int size, const Material& material);
    /// All of them, from level 0 of the mirror's.
    void make(const MapTextures& maps, const Material& material);

    /// All levels of a cube map from its level 0. Each is smoothed by (1 3 3 1) / 8 both ways
    /// before it is halved: light stays where it is, between texels too.
    void make_levels(const Texture& cube);
    /// The light of a cube map with levels, filtered with a lobe, into a level of another.
    void blur(const Texture& cube, const Lobe& lobe, const Texture& into, int level = 0);
    /// The same for irradiance: a sum over all texels of a small level.
    void make_irradiance(const Texture& cube, const Texture& into);

  private:
    // Draws the six faces of a level with the program that is in use.
    void draw_faces(const Program& program, const Texture& into, int level) const;
    const std::vector<Imath::V4f>& taps_for(const Lobe& lobe, int source_size);

    struct Taps {
        Lobe lobe;
        int source_size;
        std::vector<Imath::V4f> taps;
    };
    std::vector<Taps> taps_;
    ProgramCache programs_;
    Framebuffer framebuffer_;
    VertexArray nothing_;
};

}  // namespace mirrorball::gl
