// Painter: a scene's objects by their materials' programs, and the background where nothing is,
// into the framebuffer that is bound. What the objects reflect it is told.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <mirrorball/scene.h>
#include <mirrorball/scene_assets.h>

#include "bump_textures.h"
#include "light_map.h"
#include "map_textures.h"
#include "material_textures.h"
#include "mesh_buffers.h"
#include "program.h"
#include "view.h"

namespace mirrorball::gl {

enum class Output {
    display,      ///< tone mapped, linear light
    screen,       ///< the same, encoded as sRGB
    radiance,     ///< as it is
    half_floats,  ///< radiance that a half float holds: no NaN, nothing negative or infinite
};

/// From where a picture is taken and for what.
struct Shot {
    /// One; or the six of a cube's faces, drawn at once into the layers of what is bound. Of one
    /// eye.
    std::span<const View> views;
    Output output = Output::display;
    /// The edge in texels if it is of faces of a cube, in the default axes.
    int face_size = 0;
    int height = 0;  ///< of the picture in pixels, if it is for a screen; else 0

    [[nodiscard]] bool layered() const { return views.size() > 1; }
};

/// The edge in texels of the cube whose fineness all of the scene's maps have.
[[nodiscard]] int map_size(const Scene& scene, const SceneAssets& assets);

/// Takes normals along with a matrix of positions.
[[nodiscard]] Imath::M33f normal_matrix(const Imath::M44d& m);
/// 1, or -1 of a matrix that mirrors.
[[nodiscard]] float handedness(const Imath::M44d& m);

class Painter {
  public:
    explicit Painter(std::shared_ptr<const SceneAssets> assets)
        : assets_(assets),
          textures_(assets),
          bumps_(std::move(assets)) {}

    /// What was made of meshes, pictures and bump maps that are the same stays.
    void set_assets(std::shared_ptr<const SceneAssets> assets);

    /// Clears and sets what OpenGL is to do; the viewport is the caller's business.
    void begin();
    void object(const Scene& scene, const SceneObject& object, const LookupMaps& maps,
                const Shot& shot);
    /// Where no object is: the environment, or a plain colour.
    void background(const Scene& scene, const Shot& shot, bool plain);

    const MeshBuffers& buffers_of(const SceneObject& object);
    [[nodiscard]] const Mesh& mesh_of(const SceneObject& object) const {
        return assets_->meshes.at(object.mesh);
    }

  private:
    void draw_object(const Scene& scene, const SceneObject& object, const LookupMaps& maps,
                     const Shot& shot, int pass);
    void draw_split(const SceneObject& object, const Vec3d& eye, const LookupMaps& maps,
                    const Program& program);
    void set_material(const Program& program, const Material& material);
    void set_bump(const Program& program, const BumpMap& bump, double time);
    void make_light_map(const Scene& scene, const SceneObject& object, const LookupMaps& maps);
    void set_maps(const Program& program, const Material& material, const LookupMaps& maps) const;
    void set_display(const Program& program, const Scene& scene);
    const Texture& background_for(const Scene& scene);
    double exposure_for(const Scene& scene);

    std::shared_ptr<const SceneAssets> assets_;
    ProgramCache programs_;
    MaterialTextures textures_;
    BumpTextures bumps_;
    std::optional<LightMap> light_map_;  // of the object that is drawn
    std::map<std::string, MeshBuffers> buffers_;
    std::optional<Texture> background_;
    int background_size_ = 0;
    std::optional<double> usual_exposure_;
    VertexArray nothing_;
};

}  // namespace mirrorball::gl
