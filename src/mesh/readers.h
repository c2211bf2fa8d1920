// One function per format of mesh files. Each checks what its parser does not, and returns a mesh
// whose indices are in range and whose numbers are finite; normals and tangents that the
// file lacks are 0.
#pragma once

#include <cstdint>

#include <mirrorball/mesh.h>

#include "io/file.h"

namespace mirrorball::detail {

[[nodiscard]] Mesh read_obj(InputFile& file, std::uint64_t memory_limit);
/// Either form, told apart by content.
[[nodiscard]] Mesh read_gltf(InputFile& file, std::uint64_t memory_limit);

/// read_mesh() of a file that is open, by the ending of its name.
[[nodiscard]] Mesh read_mesh(InputFile& file, std::uint64_t memory_limit);

/// Refuses what would need more than `limit`. `needed` is as a double so that sums cannot wrap.
void check_memory(const InputFile& file, double needed, std::uint64_t limit);

}  // namespace mirrorball::detail
