// OpenEXR files as far as their headers and tables go, and one part of them as a sound file of its
// own: for a library that trusts what it reads.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "file.h"

namespace mirrorball::detail {

/// A header: of the whole file or, of several, one part's. Its spans are into the file's bytes.
struct ExrPart {
    struct Attribute {
        std::string name, type;
        std::span<const std::byte> value;
    };
    std::vector<Attribute> attributes;
    std::vector<std::string> channels;
    bool is_deep = false, is_tiled = false;

    /// Null if there is none of that name.
    [[nodiscard]] const Attribute* find(std::string_view name) const;
    /// "ZIP", "DWAA", ...; "an unknown method"
    [[nodiscard]] std::string_view compression() const;
};

struct ExrParts {
    std::vector<ExrPart> parts;
    std::size_t headers_end = 0;  ///< where the tables of offsets begin
    bool is_multipart = false;
};

/// \throws Error(Errc::cannot_read) where the bytes are no headers of an OpenEXR file
[[nodiscard]] ExrParts parse_exr_headers(const InputFile& file, std::span<const std::byte> bytes);

/// The file that would hold that part alone, with nothing in its header that its pixels do not need
/// and its lines in increasing order. Each chunk is there, is the one that stands at its place, and
/// has a size that it can have; what its bytes hold is not looked at. \pre the part is flat
/// \throws Error(Errc::cannot_read) for what is not so, sub-sampled channels and ripmaps
[[nodiscard]] std::vector<std::byte> checked_part(const InputFile& file,
                                                  std::span<const std::byte> bytes,
                                                  const ExrParts& parts, std::size_t part);

}  // namespace mirrorball::detail
