// SmoothPicture: a picture of a scene that gets smoother with each sample.
#pragma once

#include <optional>

#include <mirrorball/gl/renderer.h>
#include <mirrorball/scene.h>

#include "gl/objects.h"
#include "gl/program.h"
#include "gl/texture.h"

namespace mirrorball {

/// What is drawn into: a picture, and depth if asked for.
class PictureTarget {
  public:
    /// \param format  GL_RGBA8 or GL_RGBA16F
    PictureTarget(int width, int height, GLenum format, bool with_depth);

    void bind() const;
    void bind_texture(int unit) const;

  private:
    int width_, height_;
    gl::TextureName texture_;
    gl::Framebuffer framebuffer_;
    std::optional<gl::Renderbuffer> depth_;
};

class SmoothPicture {
  public:
    SmoothPicture(int width, int height) : width_(width), height_(height) {}

    /// One more sample. The first is of pixels' centres and shown alone, in as many bits as screens
    /// have: it is all that there is while things move. Those after it are, of `sample_count`, the
    /// ones that Renderer::picture() averages.
    void add(gl::Renderer& renderer, const Scene& scene, int sample_count,
             gl::ProgramCache& programs);
    /// The first into the framebuffer that is bound, where the options say; it is not kept.
    void show_first(gl::Renderer& renderer, const Scene& scene, gl::DrawOptions options);
    /// Is the next sample the first, or as good as that?
    [[nodiscard]] bool can_show_first(int sample_count) const {
        return taken_ == 0 || sample_count == 1;
    }
    void start_again() { taken_ = 0; }
    [[nodiscard]] bool is_smooth(int sample_count) const {
        return taken_ > (sample_count > 1 ? sample_count : 0);
    }

    /// Is what there is to see encoded as sRGB? Else it is linear light.
    [[nodiscard]] bool is_encoded() const { return taken_ <= 1; }
    void bind_texture(int unit) const;

  private:
    // Linear light of the sample that was added last, and of all together.
    struct Smooth {
        PictureTarget sample, mean;
    };
    void add_to_mean(int sample, gl::ProgramCache& programs);

    int width_, height_;
    std::optional<PictureTarget> rough_;
    std::optional<Smooth> smooth_;
    gl::VertexArray nothing_;
    int taken_ = 0;
};

}  // namespace mirrorball
