// Of builds without the Zstandard library: a browser has no decoder of its own to ask.
#include <mirrorball/error.h>

#include "zstandard.h"

namespace mirrorball::detail {

void unpack_zstandard(const InputFile& file, std::span<const std::byte>, std::span<std::byte>) {
    throw Error(Errc::unsupported,
                file.name() +
                    ": is compressed by Zstandard, which this build cannot read; "
                    "`mirrorball convert IN -o OUT.ktx2` writes one without");
}

std::vector<std::byte> pack_zstandard(const OutputFile& file, std::span<const std::byte>) {
    throw Error(Errc::unsupported,
                file.name() + ": this build cannot compress by Zstandard; write it without");
}

}  // namespace mirrorball::detail
