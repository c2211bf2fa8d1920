#include "smooth_picture.h"

#include "gl/check.h"

namespace mirrorball {

using namespace gl;

PictureTarget::PictureTarget(int width, int height, bool with_depth)
    : texture_(make_texture(GL_TEXTURE_2D, width, height, 1)) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                           texture_.name.name(), 0);
    if (with_depth) {
        depth_.emplace();
        glBindRenderbuffer(GL_RENDERBUFFER, depth_->name());
        glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                  depth_->name());
    }
    check("making a picture to show");
    check_framebuffer("making a picture to show");
}

void PictureTarget::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, texture_.width, texture_.height);
}

SmoothPicture::SmoothPicture(int width, int height)
    : width_(width),
      height_(height),
      sample_(width, height, true),
      mean_(width, height, false) {}

void SmoothPicture::add(Renderer& renderer, const Scene& scene, int sample_count,
                        ProgramCache& programs) {
    const int i = taken_ - 1;
    sample_.bind();
    renderer.draw(scene, width_, height_, i < 0 ? Imath::V2d(0) : sample_shift(i, sample_count));
    ++taken_;
    if (i < 0) return;

    // The mean of i + 1 samples is that of i, moved towards the new one.
    mean_.bind();
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendColor(0, 0, 0, 1.0f / static_cast<float>(i + 1));
    glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
    const Program& program = programs.get("full.vert", "show.frag", {"SHOW AVERAGE"});
    program.use();
    sample_.texture().bind(0);
    program.set("u_first", 0);
    program.set("u_origin", Imath::V2f(0, 0));
    glBindVertexArray(nothing_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_BLEND);
}

}  // namespace mirrorball
