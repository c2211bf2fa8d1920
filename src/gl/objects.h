// OpenGL's objects as values that are deleted with their owner. The context that made them has to
// be current then.
#pragma once

#include <cstddef>
#include <span>
#include <utility>

#include "gl.h"

namespace mirrorball::gl {

/// `Traits` has make(GLuint*) and destroy(const GLuint*).
template <class Traits>
class Object {
  public:
    Object() { Traits::make(&name_); }
    ~Object() {
        if (name_ != 0) Traits::destroy(&name_);
    }
    Object(Object&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    Object& operator=(Object&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }

    [[nodiscard]] GLuint name() const { return name_; }

  private:
    GLuint name_ = 0;
};

struct BufferTraits {
    static void make(GLuint* name) { glGenBuffers(1, name); }
    static void destroy(const GLuint* name) { glDeleteBuffers(1, name); }
};
struct VertexArrayTraits {
    static void make(GLuint* name) { glGenVertexArrays(1, name); }
    static void destroy(const GLuint* name) { glDeleteVertexArrays(1, name); }
};
struct FramebufferTraits {
    static void make(GLuint* name) { glGenFramebuffers(1, name); }
    static void destroy(const GLuint* name) { glDeleteFramebuffers(1, name); }
};
struct RenderbufferTraits {
    static void make(GLuint* name) { glGenRenderbuffers(1, name); }
    static void destroy(const GLuint* name) { glDeleteRenderbuffers(1, name); }
};
struct TextureTraits {
    static void make(GLuint* name) { glGenTextures(1, name); }
    static void destroy(const GLuint* name) { glDeleteTextures(1, name); }
};

using Buffer = Object<BufferTraits>;
using VertexArray = Object<VertexArrayTraits>;
using Framebuffer = Object<FramebufferTraits>;
using Renderbuffer = Object<RenderbufferTraits>;
using TextureName = Object<TextureTraits>;

/// Fills the buffer bound to `target`.
template <class T>
void fill_buffer(GLenum target, std::span<const T> values, GLenum usage) {
    glBufferData(target, static_cast<GLsizeiptr>(values.size_bytes()), values.data(), usage);
}

}  // namespace mirrorball::gl
