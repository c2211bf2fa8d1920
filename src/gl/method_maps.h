// MethodMaps: cube maps on the graphics card made into the maps of another method.
#pragma once

#include <optional>

#include "map_textures.h"
#include "warp.h"

namespace mirrorball::gl {

class MethodMaps {
  public:
    /// Room for maps as fine as the cubes. \pre the method is not one that looks up cubes
    MethodMaps(Method method, const MapTextures& cubes);

    /// Is there anything to make, or are cube maps what the method looks up?
    [[nodiscard]] static bool needed_for(Method method);

    /// `camera` matters for sphere maps: they are made for it, and looked up in its frame.
    void make(const MapTextures& cubes, const Axes& cube_axes, const Axes& camera);

    /// One lobe's more, made as all others were if they were; or one's less. \pre not of split
    /// polygons
    void add_glossy(const Texture& cube);
    void remove_glossy(std::size_t lobe);

    [[nodiscard]] const MapTextures& textures() const { return textures_; }
    /// Of the lookup.
    [[nodiscard]] const Axes& axes() const { return axes_; }

  private:
    // Of what was made last.
    struct Made {
        Axes cube_axes, frame;
    };

    // Calls it with each layer of the method's textures, and its shape.
    template <class WarpLayer>
    void for_each_layer(WarpLayer&& warp_layer);
    void make(const Texture& cube, const Texture& into);
    void make_rough(const Texture& cube);
    void make_faces(const Texture& cube, const Axes& cube_axes, const std::vector<Texture>& into);

    Method method_;
    Axes axes_;
    std::optional<Made> made_;
    MapTextures textures_;
    Warp warp_;
};

}  // namespace mirrorball::gl
