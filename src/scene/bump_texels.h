// What load_assets() makes bump texels with.
#pragma once

#include <cstdint>
#include <filesystem>

#include <mirrorball/scene_assets.h>

namespace mirrorball::detail {

/// A name without an ending is meant to be a source, and if it is none, that is the error.
[[nodiscard]] bool is_bump_source(const BumpMap& bump);
/// \throws Error(Errc::usage) naming the sources there are
[[nodiscard]] BumpTexels make_bump_texels(const BumpMap& bump, double time);
/// \throws what read_bump() does
[[nodiscard]] BumpTexels read_bump_texels(const BumpMap& bump, const std::filesystem::path& folder,
                                          std::uint64_t memory);

}  // namespace mirrorball::detail
