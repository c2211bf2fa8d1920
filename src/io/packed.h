// How texels lie in memory in KTX2 and DDS files: the packings that graphics interfaces share.
//
// All are little-endian. Encoding rounds to nearest; decoding is exact. Values are expected within
// the range of the packing (write_image() and write_map() clamp and count); what is not is clamped
// here too, so that no bit pattern of another meaning comes about.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <mirrorball/io.h>

#include "codec.h"
#include "file.h"

namespace mirrorball::detail {

enum class Packing {
    rgba32f,
    rgba16f,
    rgb32f,
    rgb16f,
    rgb9e5,
    b10g11r11f,
    rgba8,       ///< 0..255 is 0..1
    rgba8_srgb,  ///< the same through sRGB's transfer curve; alpha is linear
};

[[nodiscard]] int texel_bytes(Packing packing);
/// Of the image that it unpacks to: 4 where there is an alpha, else 3.
[[nodiscard]] int channel_count(Packing packing);
/// What a request for a texel format is packed as. \pre one of the four float formats
[[nodiscard]] Packing packing_for(TexelFormat format);
[[nodiscard]] TexelFormat texel_format(Packing packing);
/// 8-bit texels as the user wants them understood. Unasked, as the file has it: unlike pictures,
/// these formats say whether a texel is sRGB.
[[nodiscard]] Packing with_transfer(Packing packing, Transfer transfer);

/// Grey images become equal red, green and blue; a missing alpha is 1; an alpha that the packing
/// has no room for is dropped. `out` has exactly the bytes that the image takes.
void pack(Packing packing, const Image& image, std::span<std::byte> out);
[[nodiscard]] Image unpack(Packing packing, std::span<const std::byte> bytes, int width,
                           int height);
/// Packs a picture and writes it, a few rows at a time: a packed whole is never held.
void write_packed(OutputFile& file, Packing packing, const Image& image);

// Single texels and numbers.

[[nodiscard]] std::uint16_t pack_half(float value);
[[nodiscard]] float unpack_half(std::uint16_t bits);
/// 5 bits of exponent, no sign: the 11-bit (6 bits of mantissa) and 10-bit (5) floats.
[[nodiscard]] std::uint32_t pack_unsigned_float(float value, int mantissa_bits);
[[nodiscard]] float unpack_unsigned_float(std::uint32_t bits, int mantissa_bits);
[[nodiscard]] std::uint32_t pack_b10g11r11f(const std::array<float, 3>& rgb);
[[nodiscard]] std::array<float, 3> unpack_b10g11r11f(std::uint32_t bits);
[[nodiscard]] std::uint32_t pack_rgb9e5(const std::array<float, 3>& rgb);
[[nodiscard]] std::array<float, 3> unpack_rgb9e5(std::uint32_t bits);

// Mip chains, as both formats define them.

/// The edge of a level: half of the one before, rounded down, and at least 1.
[[nodiscard]] int level_size(int size, int level);
/// How many levels there can be.
[[nodiscard]] int possible_level_count(int width, int height);
/// The most texels that a chain of this base holds per texel of the base, rounded up to whole
/// images.
[[nodiscard]] std::int64_t image_count_bound(int face_count, int level_count);
/// Refuses to write a chain whose levels have other sizes, or more than there can be.
void require_halved_levels(const OutputFile& file, const ContentsView& contents);

/// An alpha that is 1 in every texel says nothing: takes it away, in all images or none.
void drop_opaque_alpha(FileContents& contents);

}  // namespace mirrorball::detail
