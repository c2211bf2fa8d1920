#include "packed.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>
#include <half.h>

#include "codec.h"

namespace mirrorball::detail {
namespace {

// Numbers are copied between files and memory as they are.
static_assert(std::endian::native == std::endian::little);

using Texel = std::array<float, 4>;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <class T>
T load(const std::byte* from) {
    T value;
    std::memcpy(&value, from, sizeof(T));
    return value;
}

template <class T>
void store(std::byte* to, const T& value) {
    std::memcpy(to, &value, sizeof(T));
}

Texel texel_of(const float* values, int channels) {
    switch (channels) {
        case 1:
            return {values[0], values[0], values[0], 1};
        case 2:
            return {values[0], values[0], values[0], values[1]};
        case 3:
            return {values[0], values[1], values[2], 1};
        default:
            return {values[0], values[1], values[2], values[3]};
    }
}

std::uint8_t pack_unorm8(float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
}

void pack_texel(Packing packing, const Texel& texel, std::byte* out) {
    const std::array<float, 3> rgb{texel[0], texel[1], texel[2]};
    switch (packing) {
        case Packing::rgba32f:
            store(out, texel);
            break;
        case Packing::rgb32f:
            store(out, rgb);
            break;
        case Packing::rgba16f:
        case Packing::rgb16f:
            for (int c = 0; c < channel_count(packing); ++c)
                store(out + 2 * c, pack_half(texel[c]));
            break;
        case Packing::rgb9e5:
            store(out, pack_rgb9e5(rgb));
            break;
        case Packing::b10g11r11f:
            store(out, pack_b10g11r11f(rgb));
            break;
        case Packing::rgba8:
            for (int c = 0; c < 4; ++c) store(out + c, pack_unorm8(texel[c]));
            break;
        case Packing::rgba8_srgb:
            for (int c = 0; c < 3; ++c) store(out + c, pack_unorm8(linear_to_srgb(texel[c])));
            store(out + 3, pack_unorm8(texel[3]));
            break;
    }
}

void unpack_texel(Packing packing, const std::byte* bytes, float* out) {
    switch (packing) {
        case Packing::rgba32f:
            std::memcpy(out, bytes, 16);
            break;
        case Packing::rgb32f:
            std::memcpy(out, bytes, 12);
            break;
        case Packing::rgba16f:
        case Packing::rgb16f:
            for (int c = 0; c < channel_count(packing); ++c)
                out[c] = unpack_half(load<std::uint16_t>(bytes + 2 * c));
            break;
        case Packing::rgb9e5: {
            const auto rgb = unpack_rgb9e5(load<std::uint32_t>(bytes));
            std::copy(rgb.begin(), rgb.end(), out);
            break;
        }
        case Packing::b10g11r11f: {
            const auto rgb = unpack_b10g11r11f(load<std::uint32_t>(bytes));
            std::copy(rgb.begin(), rgb.end(), out);
            break;
        }
        case Packing::rgba8:
        case Packing::rgba8_srgb:
            for (int c = 0; c < 4; ++c) {
                const float value = static_cast<float>(load<std::uint8_t>(bytes + c)) / 255.0f;
                const bool curved = packing == Packing::rgba8_srgb && c < 3;
                out[c] = curved ? srgb_to_linear(value) : value;
            }
            break;
    }
}

}  // namespace

int texel_bytes(Packing packing) {
    switch (packing) {
        case Packing::rgba32f:
            return 16;
        case Packing::rgb32f:
            return 12;
        case Packing::rgba16f:
            return 8;
        case Packing::rgb16f:
            return 6;
        default:
            return 4;
    }
}

int channel_count(Packing packing) {
    switch (packing) {
        case Packing::rgba32f:
        case Packing::rgba16f:
        case Packing::rgba8:
        case Packing::rgba8_srgb:
            return 4;
        default:
            return 3;
    }
}

Packing packing_for(TexelFormat format) {
    switch (format) {
        case TexelFormat::rgba32f:
            return Packing::rgba32f;
        case TexelFormat::rgb9e5:
            return Packing::rgb9e5;
        case TexelFormat::r11g11b10f:
            return Packing::b10g11r11f;
        default:
            return Packing::rgba16f;
    }
}

TexelFormat texel_format(Packing packing) {
    switch (packing) {
        case Packing::rgba32f:
        case Packing::rgb32f:
            return TexelFormat::rgba32f;
        case Packing::rgba16f:
        case Packing::rgb16f:
            return TexelFormat::rgba16f;
        case Packing::rgb9e5:
            return TexelFormat::rgb9e5;
        case Packing::b10g11r11f:
            return TexelFormat::r11g11b10f;
        default:
            return TexelFormat::unorm8;
    }
}

Packing with_transfer(Packing packing, Transfer transfer) {
    if (packing == Packing::rgba8 && transfer == Transfer::srgb) return Packing::rgba8_srgb;
    if (packing == Packing::rgba8_srgb && transfer == Transfer::linear) return Packing::rgba8;
    return packing;
}

void pack(Packing packing, const Image& image, std::span<std::byte> out) {
    const int step = texel_bytes(packing), channels = image.channels();
    std::byte* to = out.data();
    for (int y = 0; y < image.height(); ++y) {
        const float* values = image.row(y).data();
        for (int x = 0; x < image.width(); ++x, to += step, values += channels)
            pack_texel(packing, texel_of(values, channels), to);
    }
}

Image unpack(Packing packing, std::span<const std::byte> bytes, int width, int height) {
    Image image(width, height, channel_count(packing));
    const int step = texel_bytes(packing), channels = image.channels();
    const std::byte* from = bytes.data();
    for (int y = 0; y < height; ++y) {
        float* values = image.row(y).data();
        for (int x = 0; x < width; ++x, from += step, values += channels)
            unpack_texel(packing, from, values);
    }
    return image;
}

std::uint16_t pack_half(float value) {
    return Imath::half(value).bits();
}

float unpack_half(std::uint16_t bits) {
    return Imath::half(Imath::half::FromBits, bits);
}

// The value is q 2^(e - m) with m bits of mantissa, e its exponent but at least the smallest normal
// one, and q a whole number below 2^(m+1). Its bits are (e + 14) 2^m + q: normal numbers carry
// their leading one into the exponent field, and so does a q that rounding made 2^(m+1).
std::uint32_t pack_unsigned_float(float value, int mantissa_bits) {
    constexpr int kSmallestExponent = -14;
    const std::uint32_t infinity = 31u << mantissa_bits;
    if (std::isnan(value)) return infinity + 1;
    if (value <= 0) return 0;
    if (value == kInfinity) return infinity;
    const int exponent = std::max(std::ilogb(value), kSmallestExponent);
    if (exponent > 15) return infinity - 1;
    // Exact in double; nearbyint rounds halves to even.
    const double q =
        std::nearbyint(std::ldexp(static_cast<double>(value), mantissa_bits - exponent));
    const std::uint32_t bits =
        (static_cast<std::uint32_t>(exponent - kSmallestExponent) << mantissa_bits) +
        static_cast<std::uint32_t>(q);
    return std::min(bits, infinity - 1);
}

float unpack_unsigned_float(std::uint32_t bits, int mantissa_bits) {
    const int exponent = static_cast<int>(bits >> mantissa_bits);
    const std::uint32_t one = 1u << mantissa_bits, mantissa = bits & (one - 1);
    if (exponent == 31) return mantissa == 0 ? kInfinity : std::numeric_limits<float>::quiet_NaN();
    if (exponent == 0) return std::ldexp(static_cast<float>(mantissa), -14 - mantissa_bits);
    return std::ldexp(static_cast<float>(one + mantissa), exponent - 15 - mantissa_bits);
}

std::uint32_t pack_b10g11r11f(const std::array<float, 3>& rgb) {
    return pack_unsigned_float(rgb[0], 6) | pack_unsigned_float(rgb[1], 6) << 11 |
           pack_unsigned_float(rgb[2], 5) << 22;
}

std::array<float, 3> unpack_b10g11r11f(std::uint32_t bits) {
    return {unpack_unsigned_float(bits & 0x7ff, 6), unpack_unsigned_float(bits >> 11 & 0x7ff, 6),
            unpack_unsigned_float(bits >> 22, 5)};
}

// value = mantissa 2^(exponent - 24), three mantissas of 9 bits and one exponent of 5. As in
// OpenGL's EXT_texture_shared_exponent, the exponent is the smallest that holds the largest of the
// three after rounding, and halves round up.
std::uint32_t pack_rgb9e5(const std::array<float, 3>& rgb) {
    constexpr double kLargest = 65408;  // 511 2^(31 - 24)
    std::array<double, 3> value;
    for (int c = 0; c < 3; ++c)  // NaN fails the comparison and becomes 0
        value[c] = rgb[c] > 0 ? std::min(static_cast<double>(rgb[c]), kLargest) : 0.0;
    const double largest = *std::max_element(value.begin(), value.end());
    const auto mantissa = [](double v, int exponent) {
        return static_cast<std::uint32_t>(std::floor(std::ldexp(v, 24 - exponent) + 0.5));
    };

    int exponent = largest > 0 ? std::max(std::ilogb(largest) + 16, 0) : 0;
    if (mantissa(largest, exponent) == 512) ++exponent;
    return mantissa(value[0], exponent) | mantissa(value[1], exponent) << 9 |
           mantissa(value[2], exponent) << 18 | static_cast<std::uint32_t>(exponent) << 27;
}

std::array<float, 3> unpack_rgb9e5(std::uint32_t bits) {
    const float scale = std::ldexp(1.0f, static_cast<int>(bits >> 27) - 24);
    return {scale * static_cast<float>(bits & 511), scale * static_cast<float>(bits >> 9 & 511),
            scale * static_cast<float>(bits >> 18 & 511)};
}

int level_size(int size, int level) {
    return std::max(1, size >> level);
}

int possible_level_count(int width, int height) {
    return std::bit_width(static_cast<unsigned>(std::max(width, height)));
}

// Levels below the base add at most a third for 2-D chains, and as much again for strips one texel
// wide, which halve along one side only.
std::int64_t image_count_bound(int face_count, int level_count) {
    return level_count == 1 ? face_count : 2 * std::int64_t{face_count};
}

void require_halved_levels(const OutputFile& file, const FileContents& contents) {
    const Image& base = contents.levels.front().front();
    const int most = possible_level_count(base.width(), base.height());
    if (static_cast<int>(contents.levels.size()) > most)
        file.fail(fmt::format("{} levels; a map of {} x {} can have {}", contents.levels.size(),
                              base.width(), base.height(), most));
    for (int level = 0; level < static_cast<int>(contents.levels.size()); ++level) {
        const int width = level_size(base.width(), level),
                  height = level_size(base.height(), level);
        for (const Image& image : contents.levels[level])
            if (image.width() != width || image.height() != height)
                file.fail(
                    fmt::format("level {} is {} x {}; the format wants {} x {}, each level half "
                                "of the one before, rounded down",
                                level, image.width(), image.height(), width, height));
    }
}

void drop_opaque_alpha(FileContents& contents) {
    for (const auto& faces : contents.levels)
        for (const Image& image : faces) {
            if (image.channels() != 4) return;
            const std::span<const float> values = image.values();
            for (std::size_t i = 3; i < values.size(); i += 4)
                if (values[i] != 1) return;
        }
    for (auto& faces : contents.levels)
        for (Image& image : faces) {
            Image colour(image.width(), image.height(), 3);
            for (int y = 0; y < image.height(); ++y)
                for (int x = 0; x < image.width(); ++x) colour.set_rgb(x, y, image.rgb(x, y));
            image = std::move(colour);
        }
}

}  // namespace mirrorball::detail
