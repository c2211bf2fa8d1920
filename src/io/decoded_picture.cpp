// A picture that the browser has decoded: what a page hands over of a PNG or JPEG file.
//
//     16 bytes    "mirrorball RGBA8"
//     2 x 4       width, height
//     4 per texel red, green, blue (sRGB), alpha; rows from the top
#include <algorithm>
#include <array>

#include "codec.h"

namespace mirrorball::detail {
namespace {

constexpr std::string_view kMagic = "mirrorball RGBA8";

bool recognises(std::span<const std::byte> head) {
    return head.size() >= kMagic.size() &&
           std::equal(kMagic.begin(), kMagic.end(), head.begin(),
                      [](char a, std::byte b) { return std::byte(a) == b; });
}

FileContents read(InputFile& file, const ReadOptions& options) {
    constexpr int kChannels = 4, kColours = 3;
    file.seek(kMagic.size());
    const auto width = file.read_value<std::uint32_t>(), height = file.read_value<std::uint32_t>();
    check_claim(file, width, height, kChannels, 1, std::uint64_t{kChannels} * width * height,
                options);
    const bool linear = options.transfer == Transfer::linear;
    std::array<float, 256> decoded;
    for (std::size_t code = 0; code < decoded.size(); ++code) {
        const float value = static_cast<float>(code) / 255;
        decoded[code] = linear ? value : srgb_to_linear(value);
    }

    Image image(static_cast<int>(width), static_cast<int>(height), kChannels);
    std::vector<std::byte> row(std::size_t{kChannels} * width);
    for (int y = 0; y < image.height(); ++y) {
        file.read(row);
        float* values = image.at(0, y);
        for (std::size_t i = 0; i < row.size(); ++i) {
            const auto code = std::to_integer<std::size_t>(row[i]);
            values[i] = i % kChannels < kColours ? decoded[code] : static_cast<float>(code) / 255;
        }
    }
    FileContents contents;
    contents.stored = TexelFormat::unorm8;
    contents.levels.emplace_back().push_back(std::move(image));
    return contents;
}

}  // namespace

// A broken file never comes so far: it is the browser that says so.
const Codec kDecodedPicture{
    "PNG or JPEG", {".png", ".jpg", ".jpeg", ".webp", ".avif"}, {}, recognises, read, nullptr};

}  // namespace mirrorball::detail
