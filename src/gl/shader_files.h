// The files of shaders/, by name; made by cmake/EmbedShaders.cmake.
#pragma once

#include <map>
#include <string_view>

namespace mirrorball::gl {

[[nodiscard]] const std::map<std::string_view, std::string_view>& shader_files();

}  // namespace mirrorball::gl
