// What is made in between, unscissored, leaves the framebuffer that the caller draws into, the
// viewport and the scissor test as they were.
#pragma once

#include "gl.h"

namespace mirrorball::gl {

class FramebufferGuard {
  public:
    FramebufferGuard() {
        glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &drawn_into_);
        glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read_from_);
        glGetIntegerv(GL_VIEWPORT, viewport_);
        is_scissored_ = glIsEnabled(GL_SCISSOR_TEST);
        glDisable(GL_SCISSOR_TEST);
    }
    ~FramebufferGuard() {
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(drawn_into_));
        glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(read_from_));
        glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
        if (is_scissored_) glEnable(GL_SCISSOR_TEST);
    }
    FramebufferGuard(const FramebufferGuard&) = delete;
    FramebufferGuard& operator=(const FramebufferGuard&) = delete;

  private:
    GLint drawn_into_ = 0, read_from_ = 0, viewport_[4] = {};
    GLboolean is_scissored_ = GL_FALSE;
};

}  // namespace mirrorball::gl
