#include "decode.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    mirrorball::detail::read_brdf_or_refuse(std::as_bytes(std::span(data, size)));
    return 0;
}
