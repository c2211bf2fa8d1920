// OpenGL and EGL: every file here that calls them includes this one, so a build for another loader
// has one place to change.
#pragma once

#if defined(__EMSCRIPTEN__)

// WebGL2, in a browser: OpenGL ES 3.0 without a loader. Contexts are made by the page.
#include <GLES3/gl3.h>

// Of desktop OpenGL; who asks is_desktop() first does not come so far.
#define GL_GEOMETRY_SHADER 0x8DD9
#define GL_TEXTURE_CUBE_MAP_SEAMLESS 0x884F
inline void glFramebufferTexture(GLenum, GLenum, GLuint, GLint) {}

#else

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#endif

namespace mirrorball::gl {

/// Is the current context one of desktop OpenGL, and not of OpenGL ES?
[[nodiscard]] inline bool is_desktop() {
#if defined(__EMSCRIPTEN__)
    return false;
#else
    return epoxy_is_desktop_gl();
#endif
}

}  // namespace mirrorball::gl
