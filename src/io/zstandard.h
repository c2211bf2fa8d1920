// Zstandard, which KTX2 files may be compressed by, behind a seam: not every build has it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "file.h"

namespace mirrorball::detail {

/// What is packed fills `out` to its end, or `file` fails.
void unpack_zstandard(const InputFile& file, std::span<const std::byte> packed,
                      std::span<std::byte> out);
[[nodiscard]] std::vector<std::byte> pack_zstandard(const OutputFile& file,
                                                    std::span<const std::byte> bytes);

}  // namespace mirrorball::detail
