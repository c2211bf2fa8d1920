// LightMap: what the lights of a scene make of an object's material, as a sphere map: the light map
// of classic bump mapping, made anew whenever the lights or the camera move.
#pragma once

#include "objects.h"
#include "program.h"
#include "texture.h"

namespace mirrorball::gl {

class LightMap {
  public:
    LightMap();

    /// Two layers: the base's light and the layer's over it. `program` is light_map.frag's for a
    /// layer, in use, with what it needs set but for u_size. Leaves the framebuffer as it was.
    void draw(int layer, const Program& program);

    [[nodiscard]] const Texture& texture() const { return texture_; }

  private:
    Texture texture_;
    Framebuffer framebuffer_;
    VertexArray nothing_;
};

}  // namespace mirrorball::gl
