// Where the page for browsers is, which is built apart from the program (`make web`).
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace mirrorball::cli {

/// The page's folder with this file in it to be read, as seen from the program: where it is
/// installed, and where it was built; or nothing.
[[nodiscard]] std::optional<std::filesystem::path> page_folder_with(std::string_view file);

}  // namespace mirrorball::cli
