// MapFilter: what is made of a cube map on the graphics card: mip levels, and what a lobe makes of
// it.
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

    /// The edge of a map blurred by a lobe, of a source of that size.
    [[nodiscard]] static int blurred_size(const Lobe& lobe, int source_size);

  private:
    // Draws the six faces of a level with the program that is in use.
    void draw_faces(const Program& program, const Texture& into, int level) const;
    // Narrow lobes by lookups about each direction, wide ones by a sum over all that there is.
    void blur_by_taps(const Texture& cube, const Lobe& lobe, const Texture& into, int level);
    void gather(const Texture& cube, const Lobe& lobe, const Texture& into, int level);
    const std::vector<Imath::V4f>& taps_for(const Lobe& lobe, int source_size);
    const Texture& table_for(const Lobe& lobe);

    struct Table {
        Lobe lobe;
        Texture texture;
    };
    struct Taps {
        Lobe lobe;
        int source_size;
        std::vector<Imath::V4f> taps;
    };
    std::vector<Taps> taps_;
    std::vector<Table> tables_;
    ProgramCache programs_;
    Framebuffer framebuffer_;
    VertexArray nothing_;
};

}  // namespace mirrorball::gl
