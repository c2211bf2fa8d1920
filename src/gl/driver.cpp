#include <mirrorball/gl/context.h>

#include "gl.h"

namespace mirrorball::gl {
namespace {

std::string text(GLenum name) {
    const auto* value = reinterpret_cast<const char*>(glGetString(name));
    return value ? value : "";
}

}  // namespace

Driver driver() {
    return {text(GL_VENDOR), text(GL_RENDERER), text(GL_VERSION), !is_desktop()};
}

}  // namespace mirrorball::gl
