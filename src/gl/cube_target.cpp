#include "cube_target.h"

#include <string>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/projections/cube.h>

#include "check.h"
#include "framebuffer_guard.h"

namespace mirrorball::gl {
namespace {

GLenum face_target(int face) {
    return GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face);
}

}  // namespace

CubeTarget::CubeTarget(int size, FaceDrawing drawing) : size_(size), drawing_(drawing) {
    const FramebufferGuard guard;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    const std::string doing = fmt::format("making depth for a cube map of {} x {}", size, size);
    if (drawing == FaceDrawing::one_pass) {
        if (!is_desktop()) {
            throw Error(Errc::unsupported,
                        "a cube map's faces in one pass need a geometry shader, which OpenGL ES "
                        "3.0 has not; \"texture\" and \"copy\" draw the same");
        }
        glBindTexture(GL_TEXTURE_CUBE_MAP, layered_depth_.name());
        glTexStorage2D(GL_TEXTURE_CUBE_MAP, 1, GL_DEPTH_COMPONENT32F, size, size);
        glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, layered_depth_.name(), 0);
    } else {
        glBindRenderbuffer(GL_RENDERBUFFER, depth_.name());
        glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, size, size);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                  depth_.name());
    }
    if (drawing == FaceDrawing::copy) {
        glBindRenderbuffer(GL_RENDERBUFFER, color_.name());
        glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA16F, size, size);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                                  color_.name());
        check_framebuffer(doing);
    }
    check(doing);
}

void CubeTarget::draw(const Texture& cube, std::span<const View> views, std::span<const int> faces,
                      const std::function<void(std::span<const View>)>& draw) const {
    const FramebufferGuard guard;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, size_, size_);
    if (drawing_ == FaceDrawing::one_pass) {
        glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, cube.name.name(), 0);
        check_framebuffer("drawing a cube map");
        draw(views);
        check("drawing a cube map");
        return;
    }
    for (const int face : faces) {
        if (drawing_ == FaceDrawing::texture) {
            glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, face_target(face),
                                   cube.name.name(), 0);
            check_framebuffer("drawing a face of a cube map");
        }
        draw(views.subspan(static_cast<std::size_t>(face), 1));
        if (drawing_ == FaceDrawing::copy) {
            cube.bind(0);
            glCopyTexSubImage2D(face_target(face), 0, 0, 0, 0, 0, size_, size_);
        }
    }
    check("drawing the faces of a cube map");
}

}  // namespace mirrorball::gl
