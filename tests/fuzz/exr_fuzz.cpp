#include "decode.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    mirrorball::detail::decode_or_refuse(mirrorball::detail::kExrByTinyexr,
                                         std::as_bytes(std::span(data, size)));
    return 0;
}
