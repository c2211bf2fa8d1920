#include "zstandard.h"

#include <fmt/format.h>
#include <zstd.h>

namespace mirrorball::detail {

void unpack_zstandard(const InputFile& file, std::span<const std::byte> packed,
                      std::span<std::byte> out) {
    const std::size_t size = ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size());
    if (ZSTD_isError(size))
        file.fail(fmt::format("its Zstandard data is broken ({})", ZSTD_getErrorName(size)));
    if (size != out.size())
        file.fail(fmt::format("a level unpacks to {} bytes ({} were expected)", size, out.size()));
}

std::vector<std::byte> pack_zstandard(const OutputFile& file, std::span<const std::byte> bytes) {
    constexpr int kEffort = 9;  // of 19: twice as slow as the default 3 and a few per cent smaller
    std::vector<std::byte> packed(ZSTD_compressBound(bytes.size()));
    const std::size_t size =
        ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), kEffort);
    if (ZSTD_isError(size))
        file.fail(fmt::format("Zstandard failed ({})", ZSTD_getErrorName(size)));
    packed.resize(size);
    return packed;
}

}  // namespace mirrorball::detail
