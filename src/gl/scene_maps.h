// SceneMaps: an environment as the textures that a method looks up.
#pragma once

#include <span>
#include <vector>

#include <ImathMatrix.h>

#include <mirrorball/reflection_maps.h>
#include <mirrorball/scene.h>

#include "program.h"
#include "texture.h"

namespace mirrorball::gl {

/// The matrix that takes a direction of the world, as a column, into a map's frame.
[[nodiscard]] Imath::M33f to_map_matrix(const Axes& axes);

/// One kind of maps: what mirrors see, what each lobe makes of it, irradiance.
struct MapTextures {
    Texture mirror;
    std::vector<Texture> glossy;  ///< in the order of the lobes
    Texture diffuse;

    [[nodiscard]] std::uint64_t bytes() const;
};

/// Cuts a cube map out of another shape: a sphere map for a camera, say.
class Warp {
  public:
    enum class Shape { sphere, front_paraboloid, back_paraboloid };

    /// Into the texture's level 0 (of `layer`), from which the other levels are made. `axes` are
    /// those of the new map, `cube_axes` those of the cube.
    void operator()(const Texture& cube, const Axes& cube_axes, Shape shape, const Axes& axes,
                    const Texture& into, int layer = 0);

  private:
    ProgramCache programs_;
    Framebuffer framebuffer_;
    VertexArray nothing_;
};

class SceneMaps {
  public:
    /// `size` is the edge of a cube's face; other maps are as fine as such a cube.
    SceneMaps(const EnvironmentMap& environment, Method method, int size,
              std::span<const Lobe> lobes);

    /// Re-makes maps that depend on where the camera looks.
    void look_from(const Axes& camera);

    [[nodiscard]] const Texture& mirror() const { return shown().mirror; }
    [[nodiscard]] const Texture& glossy(const Lobe& lobe) const;
    [[nodiscard]] const Texture& diffuse() const { return shown().diffuse; }
    /// Of split polygons.
    [[nodiscard]] const Texture& mirror_face(int face) const { return mirror_faces_[face]; }
    [[nodiscard]] const Texture& glossy_face(const Lobe& lobe, int face) const;

    /// The frame in which the maps are looked up.
    [[nodiscard]] const Axes& axes() const { return axes_; }
    [[nodiscard]] std::uint64_t bytes() const;

  private:
    [[nodiscard]] const MapTextures& shown() const { return warped_.empty() ? maps_ : warped_[0]; }
    [[nodiscard]] std::size_t index_of(const Lobe& lobe) const;

    Method method_;
    std::vector<Lobe> lobes_;
    Axes axes_;         // of the lookup
    Axes source_axes_;  // of maps_
    MapTextures maps_;
    std::vector<MapTextures> warped_;  // one where maps are re-made for the camera
    std::vector<Texture> mirror_faces_;
    std::vector<std::vector<Texture>> glossy_faces_;  // [lobe][face]
    Warp warp_;
};

}  // namespace mirrorball::gl
