// Warp: a cube map made into another map on the graphics card, texel by texel.
#pragma once

#include <mirrorball/axes.h>

#include "program.h"
#include "texture.h"

namespace mirrorball::gl {

class Warp {
  public:
    /// In the order of TARGET in shaders/warp.frag.
    enum class Shape { sphere, front_paraboloid, back_paraboloid, equirect, octahedral, face };

    /// Into the texture's level 0 (of `layer`), each texel from the cube's levels that are as
    /// coarse. `axes` are those of the new map, `cube_axes` those of the cube. Of the shape `face`,
    /// it is the cube's face number `face`.
    void operator()(const Texture& cube, const Axes& cube_axes, Shape shape, const Axes& axes,
                    const Texture& into, int layer = 0, int face = 0);
    /// A level of the texture from the same level of the cube alone.
    void level(int level, const Texture& cube, const Axes& cube_axes, Shape shape, const Axes& axes,
               const Texture& into, int layer = 0, int face = 0);

  private:
    void draw(const Program& program, const Texture& cube, const Axes& cube_axes, const Axes& axes,
              const Texture& into, int level, int layer, int face);

    ProgramCache programs_;
    Framebuffer framebuffer_;
    VertexArray nothing_;
};

}  // namespace mirrorball::gl
