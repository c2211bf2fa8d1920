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
    /// How far it is to get. The first sample is of pixels' centres and shown alone, in as many
    /// bits as screens have: it is all that there is while things move or are held. Those after it
    /// are, of `sample_count`, the ones that Renderer::picture() averages; of one there are none.
    struct Aim {
        int sample_count = 8;
        bool held = false;
    };

    SmoothPicture(int width, int height) : width_(width), height_(height) {}

    void start_again() { taken_ = 0, first_is_shown_ = false; }
    [[nodiscard]] bool is_done(const Aim& aim) const;

    /// Is there nothing to show but the first sample?
    [[nodiscard]] bool is_first(const Aim& aim) const;
    /// Draws that into the framebuffer that is bound, where the options say, and keeps nothing.
    void show_first(gl::Renderer& renderer, const Scene& scene, const Aim& aim,
                    gl::DrawOptions options);

    /// One more sample, unless it is done, for bind_texture().
    void add(gl::Renderer& renderer, const Scene& scene, const Aim& aim,
             gl::ProgramCache& programs);
    /// Is what is bound encoded as sRGB? Else it is linear light.
    [[nodiscard]] bool is_encoded() const { return taken_ == 1; }
    void bind_texture(int unit) const;

  private:
    // Linear light of the sample that was added last, and of all together.
    struct Smooth {
        PictureTarget sample, mean;
    };
    void add_to_mean(int sample, gl::ProgramCache& programs);

    int width_, height_;
    std::optional<PictureTarget> first_;
    std::optional<Smooth> smooth_;
    gl::VertexArray nothing_;
    int taken_ = 0;  // into textures: the first, then those of the mean
    bool first_is_shown_ = false;
};

}  // namespace mirrorball
