// Renderer: pictures of scenes by OpenGL 4.5 or OpenGL ES 3.0, whichever context is current.
//
// Its shaders are the files of shaders/. What each method does, and how far from the truth it is:
// docs/rendering.md. The truth itself, for a pixel: direct.h.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <mirrorball/direct.h>
#include <mirrorball/environment_map.h>
#include <mirrorball/image.h>
#include <mirrorball/progress.h>
#include <mirrorball/scene.h>
#include <mirrorball/scene_assets.h>

namespace mirrorball::gl {

struct PictureOptions {
    int width = 1280, height = 720;
    /// Pictures that differ by parts of a pixel and are averaged, 1 to 1024: the edges get smooth,
    /// and what lies between pixels is not missed.
    int sample_count = 8;
    /// Tone mapped, linear light from 0 to 1, or else radiance.
    bool display = true;
    Progress progress = {};
};

struct DrawOptions {
    Imath::V2d shift{0, 0};  ///< in pixels, of what they show: as sample_shift() has it
    bool encoded = false;    ///< as sRGB, for a screen; else linear light
    /// For pictures that the next one replaces at once: lobes' maps that are not there are made
    /// half as fine if they are large (quicker()). GGX whose map takes more than a moment to make
    /// (LobeFilter::is_quick()) is looked up in maps of all roughnesses, off by what
    /// look_up_rough() says, of methods that look up per pixel; others do as always.
    bool quick = false;
    /// Where in the framebuffer the picture's lower left pixel is. Nothing around it is touched.
    int left = 0, bottom = 0;
    /// Only these columns of it, from the first to the one before the last.
    int first_column = 0, last_column = std::numeric_limits<int>::max();
};

/// Which faces of a dynamic object's map were drawn for a picture.
struct FaceUpdate {
    std::size_t object = 0;  ///< its place in the scene
    std::vector<int> faces;  ///< in the order in which they were drawn
    int bounce_count = 1;    ///< how often each
};

/// Draws scenes whose meshes, pictures and environment are those given. What it makes of them (maps
/// for a method, prefiltered for a material) it keeps as long as scenes ask for the same.
///
/// To be used, and destroyed, with the context current in which it was made. Every OpenGL error
/// throws Error(Errc::unsupported).
class Renderer {
  public:
    explicit Renderer(std::shared_ptr<const SceneAssets> assets);
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// From now on, draws with these. What was made of meshes, pictures, bump maps and environment
    /// that hold the same values (bump maps: that are shared with the former assets) is kept, and
    /// programs are: a new environment costs its own maps only. Pictures are those of a new
    /// renderer, but for dynamic objects that are drawn a few faces at a time.
    void set_assets(std::shared_ptr<const SceneAssets> assets);

    /// From now on, `progress` is told how far making a scene's maps is, once for each method's.
    void report_to(Progress progress);

    /// Three channels. \throws Error(Errc::usage) for sizes out of range
    [[nodiscard]] Image picture(const Scene& scene, const PictureOptions& options = {});

    /// One picture, tone mapped, into the framebuffer that is bound, whose size and depth buffer
    /// the caller cares for.
    void draw(const Scene& scene, int width, int height, const DrawOptions& options = {});

    /// What the pixels see, at their centres moved by `shift` pixels. For direct.h.
    [[nodiscard]] SurfaceBuffer surfaces(const Scene& scene, int width, int height,
                                         const Imath::V2d& shift = {0, 0});

    /// What there is to see from a place, with all objects and the environment: a local map. Its
    /// own place as captured_at and a proxy for what is around make it the environment of a scene.
    /// Cube faces of 32-bit floats in the projection's default axes; nothing nearer than a
    /// millimetre is seen. \throws Error(Errc::usage) unless 1 <= size <= 16384
    [[nodiscard]] EnvironmentMap capture(const Scene& scene, const Vec3d& position, int size);

    /// What the last picture drew anew of the maps of dynamic objects.
    [[nodiscard]] const std::vector<FaceUpdate>& face_updates() const;

    /// Seconds that each of `count` pictures of one sample takes, from the first call to OpenGL
    /// until it has drawn all; what is made for the scene once is made before.
    [[nodiscard]] std::vector<double> time_frames(const Scene& scene, int width, int height,
                                                  int count);

    /// Bytes of all textures by which the scene's method shows reflections.
    [[nodiscard]] std::uint64_t map_bytes(const Scene& scene);

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

/// Where sample `i` of `count` lies, in pixels from the pixel's centre, -1/2 to 1/2.
[[nodiscard]] Imath::V2d sample_shift(int i, int count);

}  // namespace mirrorball::gl
