#include "packed.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>
#include <half.h>

#include "codec.h"
#include "core/bits.h"
#include "core/parallel.h"
#include "core/vectorized.h"

namespace mirrorball::detail {
namespace {

// Numbers are copied between files and memory as they are.
static_assert(std::endian::native == std::endian::little);

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

// Numbers ---------------------------------------------------------------------------------------
//
// Without a branch, in operations that there are for whole vectors: the loops over rows below are
// compiled into such.

// A float without its sign, as one of 5 bits of exponent and M of mantissa, by its bits. Rounds to
// nearest, ties to even; what is too large becomes infinity or more.
//
// Normal numbers: the exponents differ by 112 in their zero; adding just below a half of the last
// bit kept, and that bit, rounds, and a carry runs into the exponent as it should. Numbers below
// the smallest normal one are whole multiples of 2^(-14-M): the processor's own addition rounds
// them to it, to a sum so large that this is the value of its last bit.
template <int M>
inline std::uint32_t small_float_bits(std::uint32_t bits) {
    constexpr int kShift = 23 - M;
    constexpr std::uint32_t kSmallestNormal = 113u << 23;
    constexpr float kLarge = M <= 9 ? static_cast<float>(1 << (9 - M)) : 1.0f / (1 << (M - 9));
    const std::uint32_t last_kept = bits >> kShift & 1;
    const std::uint32_t normal =
        (bits - (112u << 23) + ((1u << (kShift - 1)) - 1) + last_kept) >> kShift;
    const std::uint32_t small =
        bit_cast<std::uint32_t>(bit_cast<float>(bits) + kLarge) - bit_cast<std::uint32_t>(kLarge);
    return bits < kSmallestNormal ? small : normal;
}

constexpr std::uint32_t kInfinityBits = 0x7f800000;

inline std::uint16_t half_bits(float value) {
    const std::uint32_t bits = bit_cast<std::uint32_t>(value);
    const std::uint32_t magnitude = bits & 0x7fffffff;
    const std::uint32_t finite = std::min(small_float_bits<10>(magnitude), 0x7c00u);
    const std::uint32_t half = magnitude > kInfinityBits ? 0x7e00u : finite;
    return static_cast<std::uint16_t>(half | (bits >> 16 & 0x8000));
}

// Of a number without a sign: negative ones are 0. Infinity stays, what is finite becomes at most
// the largest finite number.
template <int M>
inline std::uint32_t unsigned_float_bits(float value) {
    constexpr std::uint32_t kInfinite = 31u << M;
    const std::uint32_t bits = bit_cast<std::uint32_t>(value);
    const std::uint32_t finite = std::min(small_float_bits<M>(bits & 0x7fffffff), kInfinite - 1);
    const std::uint32_t positive = (bits & 0x7fffffff) == kInfinityBits ? kInfinite : finite;
    const std::uint32_t number = bits >> 31 != 0 ? 0 : positive;
    return (bits & 0x7fffffff) > kInfinityBits ? kInfinite + 1 : number;
}

// value = mantissa 2^(exponent - 24), three mantissas of 9 bits and one exponent of 5. As in
// OpenGL's EXT_texture_shared_exponent, the exponent is the smallest that holds the largest of the
// three after rounding, and halves round up. Scaling by a power of two is exact, and so is what is
// left when the whole part is taken away.
inline std::uint32_t rgb9e5_bits(float red, float green, float blue) {
    constexpr float kLargest = 65408;   // 511 2^(31 - 24)
    const auto limited = [](float v) {  // NaN fails the first comparison and becomes 0
        const float positive = v > 0 ? v : 0.0f;
        return positive < kLargest ? positive : kLargest;
    };
    const auto power_of_two = [](std::int32_t e) {
        return bit_cast<float>(static_cast<std::uint32_t>(e + 127) << 23);
    };
    const auto rounded = [](float v) {
        const auto whole = static_cast<std::int32_t>(v);
        return whole + (v - static_cast<float>(whole) >= 0.5f ? 1 : 0);
    };
    const float r = limited(red), g = limited(green), b = limited(blue);
    const float largest = std::max(r, std::max(g, b));
    const auto binary_exponent =
        static_cast<std::int32_t>(bit_cast<std::uint32_t>(largest) >> 23) - 127;
    std::int32_t exponent = std::max(binary_exponent + 16, 0);
    exponent += rounded(largest * power_of_two(24 - exponent)) == 512 ? 1 : 0;
    const float scale = power_of_two(24 - exponent);
    return static_cast<std::uint32_t>(rounded(r * scale) | rounded(g * scale) << 9 |
                                      rounded(b * scale) << 18) |
           static_cast<std::uint32_t>(exponent) << 27;
}

inline std::uint32_t b10g11r11f_bits(float red, float green, float blue) {
    return unsigned_float_bits<6>(red) | unsigned_float_bits<6>(green) << 11 |
           unsigned_float_bits<5>(blue) << 22;
}

std::uint8_t pack_unorm8(float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
}

// Rows ------------------------------------------------------------------------------------------

// The row's texels with `kept` channels each, 3 or 4; into `scratch` where they are not so already.
const float* with_channels(std::span<const float> row, int channels, int kept,
                           std::vector<float>& scratch) {
    if (channels == kept) return row.data();
    const std::size_t width = row.size() / channels;
    scratch.resize(width * kept);
    const bool grey = channels < 3, has_alpha = channels == 2 || channels == 4;
    for (std::size_t x = 0; x < width; ++x) {
        const float* from = &row[x * channels];
        float* to = &scratch[x * kept];
        for (int c = 0; c < 3; ++c) to[c] = from[grey ? 0 : c];
        if (kept == 4) to[3] = has_alpha ? from[channels - 1] : 1.0f;
    }
    return scratch.data();
}

// A block of numbers at a time, in an array of their own: files' bytes may lie at any address.
constexpr std::size_t kBlock = 768;

struct HalfBlock {
    std::array<std::uint16_t, kBlock + 1> halves;  // a last texel of three can be read as four

    void fill(const float* values, std::size_t count) {
        vectorized([&]() MIRRORBALL_INLINE_BODY {
            const float* __restrict from = values;
            std::uint16_t* __restrict to = halves.data();
            const std::size_t n = count;
            for (std::size_t i = 0; i < n; ++i) to[i] = half_bits(from[i]);
        });
    }
};

void pack_halves(const float* values, std::size_t count, std::byte* out) {
    HalfBlock block;
    for (std::size_t i = 0; i < count; i += kBlock) {
        const std::size_t size = std::min(kBlock, count - i);
        block.fill(values + i, size);
        std::memcpy(out + 2 * i, block.halves.data(), 2 * size);
    }
}

// Three channels as halves and an alpha of 1: what nearly every file of ours holds.
void pack_opaque_halves(const float* values, std::size_t width, std::byte* out) {
    constexpr std::uint64_t kColour = 0xffff'ffff'ffff, kOne = std::uint64_t{0x3c00} << 48;
    HalfBlock block;
    block.halves.back() = 0;
    for (std::size_t x = 0; x < width; x += kBlock / 3) {
        const std::size_t size = std::min(kBlock / 3, width - x);
        block.fill(values + 3 * x, 3 * size);
        for (std::size_t i = 0; i < size; ++i) {
            std::uint64_t texel;
            std::memcpy(&texel, &block.halves[3 * i], sizeof texel);
            store(out + 8 * (x + i), (texel & kColour) | kOne);
        }
    }
}

void pack_unorm8_row(const float* rgba, std::size_t width, bool srgb, std::byte* out) {
    for (std::size_t i = 0; i < 4 * width; ++i) {
        const bool curved = srgb && i % 4 != 3;
        store(out + i, pack_unorm8(curved ? linear_to_srgb(rgba[i]) : rgba[i]));
    }
}

void pack_row(Packing packing, std::span<const float> row, int channels, std::byte* out,
              std::vector<float>& scratch) {
    const std::size_t width = row.size() / channels;
    if (packing == Packing::rgba16f && channels == 3)
        return pack_opaque_halves(row.data(), width, out);
    const int kept = channel_count(packing);
    const float* values = with_channels(row, channels, kept, scratch);
    switch (packing) {
        case Packing::rgba32f:
        case Packing::rgb32f:
            std::memcpy(out, values, width * kept * sizeof(float));
            break;
        case Packing::rgba16f:
        case Packing::rgb16f:
            pack_halves(values, width * kept, out);
            break;
        case Packing::rgb9e5:
            vectorized([&]() MIRRORBALL_INLINE_BODY {
                for (std::size_t x = 0; x < width; ++x)
                    store(out + 4 * x,
                          rgb9e5_bits(values[3 * x], values[3 * x + 1], values[3 * x + 2]));
            });
            break;
        case Packing::b10g11r11f:
            vectorized([&]() MIRRORBALL_INLINE_BODY {
                for (std::size_t x = 0; x < width; ++x)
                    store(out + 4 * x,
                          b10g11r11f_bits(values[3 * x], values[3 * x + 1], values[3 * x + 2]));
            });
            break;
        case Packing::rgba8:
        case Packing::rgba8_srgb:
            pack_unorm8_row(values, width, packing == Packing::rgba8_srgb, out);
            break;
    }
}

void pack_rows(Packing packing, const Image& image, int first, int count, std::byte* out) {
    constexpr int kRowsPerPiece = 16;
    const std::size_t row_bytes = static_cast<std::size_t>(image.width()) * texel_bytes(packing);
    parallel_for((count + kRowsPerPiece - 1) / kRowsPerPiece, [&](std::int64_t piece) {
        const int begin = static_cast<int>(piece) * kRowsPerPiece;
        std::vector<float> scratch;
        for (int y = begin; y < std::min(begin + kRowsPerPiece, count); ++y)
            pack_row(packing, image.row(first + y), image.channels(), out + y * row_bytes, scratch);
    });
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
    pack_rows(packing, image, 0, image.height(), out.data());
}

void write_packed(OutputFile& file, Packing packing, const Image& image) {
    constexpr std::size_t kPieceBytes = std::size_t{4} << 20;
    const std::size_t row_bytes = static_cast<std::size_t>(image.width()) * texel_bytes(packing);
    const int rows = static_cast<int>(std::clamp<std::size_t>(
        kPieceBytes / row_bytes, 1, static_cast<std::size_t>(image.height())));
    std::vector<std::byte> bytes(rows * row_bytes);
    for (int y = 0; y < image.height(); y += rows) {
        const int count = std::min(rows, image.height() - y);
        pack_rows(packing, image, y, count, bytes.data());
        file.write(std::span<const std::byte>(bytes).first(count * row_bytes));
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
    return half_bits(value);
}

float unpack_half(std::uint16_t bits) {
    return Imath::half(Imath::half::FromBits, bits);
}

std::uint32_t pack_unsigned_float(float value, int mantissa_bits) {
    return mantissa_bits == 6 ? unsigned_float_bits<6>(value) : unsigned_float_bits<5>(value);
}

float unpack_unsigned_float(std::uint32_t bits, int mantissa_bits) {
    const int exponent = static_cast<int>(bits >> mantissa_bits);
    const std::uint32_t one = 1u << mantissa_bits, mantissa = bits & (one - 1);
    if (exponent == 31) return mantissa == 0 ? kInfinity : std::numeric_limits<float>::quiet_NaN();
    if (exponent == 0) return std::ldexp(static_cast<float>(mantissa), -14 - mantissa_bits);
    return std::ldexp(static_cast<float>(one + mantissa), exponent - 15 - mantissa_bits);
}

std::uint32_t pack_b10g11r11f(const std::array<float, 3>& rgb) {
    return b10g11r11f_bits(rgb[0], rgb[1], rgb[2]);
}

std::array<float, 3> unpack_b10g11r11f(std::uint32_t bits) {
    return {unpack_unsigned_float(bits & 0x7ff, 6), unpack_unsigned_float(bits >> 11 & 0x7ff, 6),
            unpack_unsigned_float(bits >> 22, 5)};
}

std::uint32_t pack_rgb9e5(const std::array<float, 3>& rgb) {
    return rgb9e5_bits(rgb[0], rgb[1], rgb[2]);
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

void require_halved_levels(const OutputFile& file, const ContentsView& contents) {
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
