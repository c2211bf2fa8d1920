// An OpenGL context without a window.
#pragma once

#include <memory>
#include <string>

namespace mirrorball::gl {

/// Which OpenGL: what the renderer needs is in both of the first two.
enum class Api {
    core,           ///< 4.5, core profile
    es,             ///< ES 3.0 or newer, what browsers have as WebGL2
    compatibility,  ///< 4.5 with the fixed functions of old: glTexGen and the like
};

/// Made current on the thread that makes it; gone with the object. A program that has a context of
/// its own, of a window say, makes that current and needs none of these.
class Context {
  public:
    /// Through EGL, without a surface: on a graphics card, or on the processor (Mesa's llvmpipe).
    /// \throws Error(Errc::unsupported) saying what was asked, what is there and what to install
    explicit Context(Api api = Api::core);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    void make_current();

  private:
    struct Handles;
    std::unique_ptr<Handles> handles_;
};

/// Of the current context, in its driver's words.
struct Driver {
    std::string vendor, renderer, version;
    bool es = false;
};
[[nodiscard]] Driver driver();

}  // namespace mirrorball::gl
