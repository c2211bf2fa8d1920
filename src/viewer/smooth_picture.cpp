#include "smooth_picture.h"

#include "gl/check.h"

namespace mirrorball {

using namespace gl;

PictureTarget::PictureTarget(int width, int height, GLenum format, bool with_depth)
    : width_(width),
      height_(height) {
    check_texture_size(GL_TEXTURE_2D, width, height);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, texture_.name());
    glTexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_.name(), 0);
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
    glViewport(0, 0, width_, height_);
}

void PictureTarget::bind_texture(int unit) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, texture_.name());
}

void SmoothPicture::bind_texture(int unit) const {
    (is_encoded() ? *rough_ : smooth_->mean).bind_texture(unit);
}

void SmoothPicture::add(Renderer& renderer, const Scene& scene, int sample_count,
                        ProgramCache& programs) {
    if (taken_ == 0) {
        if (!rough_) rough_.emplace(width_, height_, GL_RGBA8, true);
        rough_->bind();
        renderer.draw(scene, width_, height_, {.encoded = true});
    } else {
        if (!smooth_) {
            smooth_.emplace(
                Smooth{{width_, height_, GL_RGBA16F, true}, {width_, height_, GL_RGBA16F, false}});
        }
        smooth_->sample.bind();
        const int sample = taken_ - 1;
        renderer.draw(scene, width_, height_, {.shift = sample_shift(sample, sample_count)});
        add_to_mean(sample, programs);
    }
    ++taken_;
}

void SmoothPicture::show_first(Renderer& renderer, const Scene& scene, DrawOptions options) {
    options.encoded = true;
    renderer.draw(scene, width_, height_, options);
    taken_ = 1;
}

// The mean of i + 1 samples is that of i, moved towards the new one.
void SmoothPicture::add_to_mean(int sample, ProgramCache& programs) {
    smooth_->mean.bind();
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendColor(0, 0, 0, 1.0f / static_cast<float>(sample + 1));
    glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
    const Program& program = programs.get("full.vert", "show.frag", {"SHOW AVERAGE"});
    program.use();
    smooth_->sample.bind_texture(0);
    program.set("u_first", 0);
    program.set("u_origin", Imath::V2f(0, 0));
    glBindVertexArray(nothing_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_BLEND);
}

}  // namespace mirrorball
