// CubeTarget: draws the faces of a cube map, in one of three ways that give the same.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include <mirrorball/scene.h>

#include "texture.h"
#include "view.h"

namespace mirrorball::gl {

class CubeTarget {
  public:
    /// \throws Error(Errc::unsupported) if the driver has no such target
    CubeTarget(int size, FaceDrawing drawing);

    /// Writes level 0 of the faces named: `draw` is called for each with its view, or once with all
    /// six, and the framebuffer and viewport set. \pre the cube has this size; one_pass draws all
    void draw(const Texture& cube, std::span<const View> views, std::span<const int> faces,
              const std::function<void(std::span<const View>)>& draw) const;

    [[nodiscard]] int size() const { return size_; }
    [[nodiscard]] FaceDrawing drawing() const { return drawing_; }

  private:
    int size_;
    FaceDrawing drawing_;
    Framebuffer framebuffer_;
    Renderbuffer color_;         // of what is copied
    Renderbuffer depth_;         // of one face
    TextureName layered_depth_;  // of six
};

}  // namespace mirrorball::gl
