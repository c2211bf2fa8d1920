// What is drawn into when there is no window.
#pragma once

#include <vector>

#include <mirrorball/image.h>

#include "objects.h"

namespace mirrorball::gl {

/// A picture of 32-bit floats with depth; several pictures at once where asked for.
class Target {
  public:
    /// \throws Error(Errc::unsupported) if the driver has none of that size
    Target(int width, int height, int picture_count = 1);

    void bind() const;
    /// The first `channels` of a picture, top row first.
    [[nodiscard]] Image read(int channels, int picture = 0) const;

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }

  private:
    int width_, height_;
    Framebuffer framebuffer_;
    std::vector<Renderbuffer> pictures_;
    Renderbuffer depth_;
};

}  // namespace mirrorball::gl
