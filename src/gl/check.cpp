#include "check.h"

#include <string>

#include <fmt/format.h>

#include <mirrorball/error.h>

#include "gl.h"

namespace mirrorball::gl {
namespace {

std::string error_name(GLenum error) {
    switch (error) {
        case GL_INVALID_ENUM:
            return "GL_INVALID_ENUM";
        case GL_INVALID_VALUE:
            return "GL_INVALID_VALUE";
        case GL_INVALID_OPERATION:
            return "GL_INVALID_OPERATION";
        case GL_INVALID_FRAMEBUFFER_OPERATION:
            return "GL_INVALID_FRAMEBUFFER_OPERATION";
        case GL_OUT_OF_MEMORY:
            return "GL_OUT_OF_MEMORY: the driver has no more memory to give";
        default:
            return fmt::format("error 0x{:04x}", error);
    }
}

}  // namespace

void check(std::string_view doing) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) return;
    // Others may be waiting behind the first; the next check must not find them.
    for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) {
    }
    throw Error(Errc::unsupported, fmt::format("OpenGL failed {}: {}", doing, error_name(error)));
}

void check_framebuffer(std::string_view doing) {
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status == GL_FRAMEBUFFER_COMPLETE) return;
    throw Error(
        Errc::unsupported,
        fmt::format("OpenGL failed {}: the driver draws into no such framebuffer (0x{:04x})", doing,
                    status));
}

}  // namespace mirrorball::gl
