// An OpenGL error is an error.
#pragma once

#include <string_view>

namespace mirrorball::gl {

/// \throws Error(Errc::unsupported) with the name of the first error since the last call; `doing`
/// completes "OpenGL failed ..."
void check(std::string_view doing);
/// The same for the framebuffer that is bound, if it cannot be drawn into.
void check_framebuffer(std::string_view doing);

}  // namespace mirrorball::gl
