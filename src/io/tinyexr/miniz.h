// What tinyexr asks of the library miniz, in place of that library.
#pragma once

#include "io/inflate.h"

using mz_ulong = unsigned long;
inline constexpr int MZ_OK = 0, MZ_DATA_ERROR = -3;

inline int mz_uncompress(unsigned char* out, mz_ulong* out_size, const unsigned char* packed,
                         mz_ulong packed_size) {
    const auto count =
        mirrorball::detail::unpack_zlib(std::as_bytes(std::span(packed, packed_size)),
                                        std::as_writable_bytes(std::span(out, *out_size)));
    // Less than was asked for would leave texels that nobody wrote.
    return count == *out_size ? MZ_OK : MZ_DATA_ERROR;
}

// For writing, which is not done.
inline mz_ulong mz_compressBound(mz_ulong) {
    return 0;
}
inline int mz_compress(unsigned char*, mz_ulong*, const unsigned char*, mz_ulong) {
    return MZ_DATA_ERROR;
}
