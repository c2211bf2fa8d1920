// What all fuzz targets do, and what the tests do with the inputs that were kept.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include <mirrorball/error.h>

#include "brdf/model.h"
#include "io/codec.h"

namespace mirrorball::detail {

/// The browser's reader of OpenEXR files, in programs that have it beside the usual one.
extern const Codec kExrByTinyexr;

/// Decodes the bytes as a file of this format, if they begin like one. A refusal is as good as a
/// picture; whether the bytes were refused.
inline bool decode_or_refuse(const Codec& codec, std::span<const std::byte> bytes) {
    constexpr std::uint64_t kMemoryLimit = std::uint64_t{64} << 20;
    if (!codec.recognises(bytes.first(std::min<std::size_t>(bytes.size(), 32)))) return true;
    InputFile file("fuzzed", bytes);
    ReadOptions options;
    options.memory_limit = kMemoryLimit;
    try {
        (void)codec.read(file, options);
        return false;
    } catch (const Error&) {
        return true;
    }
}

/// The same for a text table of a BRDF, which is evaluated once, too.
inline bool read_brdf_or_refuse(std::span<const std::byte> bytes) {
    InputFile file("fuzzed", bytes);
    try {
        (void)read_table_model(file)->evaluate({0.6, 0, 0.8}, {0, 0, 1});
        return false;
    } catch (const Error&) {
        return true;
    }
}

}  // namespace mirrorball::detail
