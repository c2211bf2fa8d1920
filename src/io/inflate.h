// zlib's format unpacked, for builds that have not that library: RFC 1950 and 1951.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace mirrorball::detail {

/// Writes what `packed` holds into `out`, and gives the count of bytes. None if it is broken or
/// holds more than there is room for.
[[nodiscard]] std::optional<std::size_t> unpack_zlib(std::span<const std::byte> packed,
                                                     std::span<std::byte> out);

}  // namespace mirrorball::detail
