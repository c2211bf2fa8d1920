// OpenEXR files as far as their headers go, and one part of them as a file of its own: for a
// library that reads files of one part.
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
    std::span<const std::byte> header;  ///< with the zero that ends it
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
    bool is_multipart = false, has_long_names = false;
};

/// \throws Error(Errc::cannot_read) where the bytes are no headers of an OpenEXR file
[[nodiscard]] ExrParts parse_exr_headers(const InputFile& file, std::span<const std::byte> bytes);

/// The file that would hold that part alone. \pre the file has several, and this one is flat
[[nodiscard]] std::vector<std::byte> single_part(const InputFile& file,
                                                 std::span<const std::byte> bytes,
                                                 const ExrParts& parts, std::size_t part);

}  // namespace mirrorball::detail
