// SmoothPicture: a picture of a scene that gets smoother with each sample.
#pragma once

#include <mirrorball/gl/renderer.h>
#include <mirrorball/scene.h>

#include "gl/objects.h"
#include "gl/program.h"
#include "gl/texture.h"

namespace mirrorball {

/// What is drawn into: a picture of half floats, and depth if asked for.
class PictureTarget {
  public:
    PictureTarget(int width, int height, bool with_depth);

    void bind() const;
    [[nodiscard]] const gl::Texture& texture() const { return texture_; }

  private:
    gl::Texture texture_;
    gl::Framebuffer framebuffer_;
    std::optional<gl::Renderbuffer> depth_;
};

class SmoothPicture {
  public:
    SmoothPicture(int width, int height);

    /// One more sample. The first is of pixels' centres and shown alone; those after it are, of
    /// `sample_count`, the ones that Renderer::picture() averages.
    void add(gl::Renderer& renderer, const Scene& scene, int sample_count,
             gl::ProgramCache& programs);
    void start_again() { taken_ = 0; }
    [[nodiscard]] bool is_smooth(int sample_count) const {
        return taken_ > (sample_count > 1 ? sample_count : 0);
    }
    /// Linear light.
    [[nodiscard]] const gl::Texture& texture() const {
        return taken_ > 1 ? mean_.texture() : sample_.texture();
    }

  private:
    int width_, height_;
    PictureTarget sample_, mean_;
    gl::VertexArray nothing_;
    int taken_ = 0;
};

}  // namespace mirrorball
