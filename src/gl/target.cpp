#include "target.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <mirrorball/error.h>

#include "check.h"

namespace mirrorball::gl {
namespace {

void check_size(int width, int height) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
    if (std::max(width, height) > largest) {
        throw Error(Errc::unsupported,
                    fmt::format("a picture of {} x {} pixels was asked for, but this OpenGL driver "
                                "draws {} x {} at most",
                                width, height, largest, largest));
    }
}

}  // namespace

Target::Target(int width, int height, int picture_count)
    : width_(width),
      height_(height),
      pictures_(static_cast<std::size_t>(picture_count)) {
    check_size(width, height);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    std::array<GLenum, 4> attachments{};
    for (int i = 0; i < picture_count; ++i) {
        attachments[i] = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i);
        glBindRenderbuffer(GL_RENDERBUFFER, pictures_[i].name());
        glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32F, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachments[i], GL_RENDERBUFFER,
                                  pictures_[i].name());
    }
    glBindRenderbuffer(GL_RENDERBUFFER, depth_.name());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.name());
    glDrawBuffers(picture_count, attachments.data());
    const std::string doing = fmt::format("making a picture of {} x {} pixels", width, height);
    check(doing);
    check_framebuffer(doing);
}

void Target::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, width_, height_);
}

Image Target::read(int channels, int picture) const {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.name());
    glReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(picture));
    Image all(width_, height_, 4);
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, all.values().data());
    check("reading the picture back");
    Image result(width_, height_, channels);
    for (int y = 0; y < height_; ++y) {
        for (int x = 0; x < width_; ++x)
            std::copy_n(all.at(x, height_ - 1 - y), channels, result.at(x, y));
    }
    return result;
}

}  // namespace mirrorball::gl
