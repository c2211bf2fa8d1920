// Scenes as JSON files. The format, key by key: docs/scene.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <mirrorball/scene.h>

namespace mirrorball {

/// Keys are the members of scene.h; angles are in degrees there, and their keys end in _degrees.
/// What is left out is as in a Scene that nobody touched; what is not known is an error, as are
/// values out of range.
/// \throws Error(Errc::cannot_read) "NAME:LINE:COLUMN: objects[2].material.mirror: 1.5 ..."
[[nodiscard]] Scene parse_scene(std::string_view text, std::string_view name_for_errors);
/// Files to 64 MB.
[[nodiscard]] Scene read_scene(const std::filesystem::path& path);

/// What differs from a Scene that nobody touched. parse_scene(to_json(s)) == s for all scenes that
/// parse_scene() gives; of others, angles come back to the last bit but one.
[[nodiscard]] std::string to_json(const Scene& scene);

}  // namespace mirrorball
