// Texel packings: every bit pattern that there is, and the definitions' own arithmetic in double.
#include "io/packed.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <half.h>

#include "io/codec.h"

namespace mirrorball::detail {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A float of 5 bits of exponent, by definition.
double by_definition(unsigned bits, int mantissa_bits) {
    const unsigned exponent = bits >> mantissa_bits, mantissa = bits & ((1u << mantissa_bits) - 1);
    const double fraction = std::ldexp(mantissa, -mantissa_bits);
    return exponent == 0 ? std::ldexp(fraction, -14)
                         : std::ldexp(1 + fraction, static_cast<int>(exponent) - 15);
}

TEST(Packed, EveryHalfComesBack) {
    for (unsigned bits = 0; bits < 65536; ++bits) {
        const float value = unpack_half(static_cast<std::uint16_t>(bits));
        if (std::isnan(value)) {
            EXPECT_TRUE((bits & 0x7c00) == 0x7c00 && (bits & 0x3ff) != 0);
            continue;
        }
        ASSERT_EQ(pack_half(value), bits);
        if ((bits & 0x7c00) != 0x7c00) {
            const double expected = by_definition(bits & 0x7fff, 10);
            ASSERT_EQ(value, static_cast<float>(bits & 0x8000 ? -expected : expected));
        }
    }
}

TEST(Packed, HalvesRoundToNearestAndTiesToEven) {
    for (unsigned bits = 0; bits < 0x7bff; ++bits) {
        const float below = unpack_half(static_cast<std::uint16_t>(bits));
        const float above = unpack_half(static_cast<std::uint16_t>(bits + 1));
        const float middle = (below + above) / 2;  // exact: one bit more
        ASSERT_EQ(pack_half(middle), bits + (bits & 1));
        ASSERT_EQ(pack_half(std::nextafter(middle, 0.0f)), bits);
        ASSERT_EQ(pack_half(std::nextafter(middle, kInfinity)), bits + 1);
    }
}

class SmallFloat : public testing::TestWithParam<int> {};

TEST_P(SmallFloat, EveryOneComesBack) {
    const int m = GetParam();
    for (unsigned bits = 0; bits < 31u << m; ++bits) {
        const float value = unpack_unsigned_float(bits, m);
        ASSERT_EQ(value, static_cast<float>(by_definition(bits, m)));
        ASSERT_EQ(pack_unsigned_float(value, m), bits);
    }
    EXPECT_EQ(unpack_unsigned_float(31u << m, m), kInfinity);
    EXPECT_EQ(pack_unsigned_float(kInfinity, m), 31u << m);
    for (unsigned bits = (31u << m) + 1; bits < 32u << m; ++bits)
        EXPECT_TRUE(std::isnan(unpack_unsigned_float(bits, m)));
    EXPECT_TRUE(std::isnan(unpack_unsigned_float(pack_unsigned_float(std::nanf(""), m), m)));
}

TEST_P(SmallFloat, RoundsToNearestAndTiesToEven) {
    const int m = GetParam();
    for (unsigned bits = 0; bits + 1 < 31u << m; ++bits) {
        const float middle =
            (unpack_unsigned_float(bits, m) + unpack_unsigned_float(bits + 1, m)) / 2;
        ASSERT_EQ(pack_unsigned_float(middle, m), bits + (bits & 1));
        ASSERT_EQ(pack_unsigned_float(std::nextafter(middle, 0.0f), m), bits);
        ASSERT_EQ(pack_unsigned_float(std::nextafter(middle, kInfinity), m), bits + 1);
    }
}

TEST_P(SmallFloat, HoldsWhatIsBeyondAtItsEnds) {
    const int m = GetParam();
    EXPECT_EQ(pack_unsigned_float(-1, m), 0u);
    EXPECT_EQ(pack_unsigned_float(-0.0f, m), 0u);
    EXPECT_EQ(pack_unsigned_float(-kInfinity, m), 0u);
    EXPECT_EQ(pack_unsigned_float(65535, m), (31u << m) - 1);
    EXPECT_EQ(pack_unsigned_float(1e30f, m), (31u << m) - 1);
    EXPECT_EQ(pack_unsigned_float(1e-30f, m), 0u);
}

INSTANTIATE_TEST_SUITE_P(Bits, SmallFloat, testing::Values(6, 5));

TEST(Packed, LargestValuesAreThoseOfTheFormats) {
    EXPECT_EQ(unpack_unsigned_float((31u << 6) - 1, 6), 65024.0f);
    EXPECT_EQ(unpack_unsigned_float((31u << 5) - 1, 5), 64512.0f);
    EXPECT_EQ(unpack_rgb9e5(0xffffffff)[0], 65408.0f);
    EXPECT_EQ(largest_value(TexelFormat::rgb9e5), 65408.0f);
    EXPECT_EQ(largest_value(TexelFormat::r11g11b10f, 2), 64512.0f);
    EXPECT_EQ(largest_value(TexelFormat::rgba16f), unpack_half(0x7bff));
}

// Canonical: some mantissa has its leading bit, or the exponent is the smallest. Of the other two
// mantissas every value is tried beside every leading one's.
TEST(Packed, EveryCanonicalSharedExponentComesBack) {
    for (unsigned exponent = 0; exponent < 32; ++exponent)
        for (unsigned largest = exponent == 0 ? 0 : 256; largest < 512; ++largest)
            for (unsigned other = 0; other <= largest; ++other) {
                const unsigned third = (other * 7 + largest) % (largest + 1);
                for (const unsigned bits :
                     {largest | other << 9 | third << 18, other | third << 9 | largest << 18}) {
                    const std::uint32_t packed = bits | exponent << 27;
                    const auto rgb = unpack_rgb9e5(packed);
                    ASSERT_EQ(rgb[0],
                              std::ldexp(double(bits & 511), static_cast<int>(exponent) - 24));
                    ASSERT_EQ(pack_rgb9e5(rgb), packed);
                }
            }
}

// Half a unit of the shared exponent, which is at most the largest channel's leading bit.
TEST(Packed, SharedExponentsRoundToNearest) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> logarithm(-20, 15.9f);
    for (int i = 0; i < 200000; ++i) {
        const std::array<float, 3> rgb{std::exp2(logarithm(random)), std::exp2(logarithm(random)),
                                       std::exp2(logarithm(random))};
        const std::uint32_t bits = pack_rgb9e5(rgb);
        const auto back = unpack_rgb9e5(bits);
        const double unit = std::ldexp(1.0, static_cast<int>(bits >> 27) - 24);
        for (int c = 0; c < 3; ++c) ASSERT_LE(std::abs(double(back[c]) - rgb[c]), unit / 2);
        // No smaller exponent would have done.
        if (bits >> 27 > 0) {
            const float largest = std::max({rgb[0], rgb[1], rgb[2]});
            ASSERT_GE(double(largest), 511.5 * unit / 2);
        }
    }
}

TEST(Packed, SharedExponentsHoldWhatIsBeyondAtTheirEnds) {
    EXPECT_EQ(unpack_rgb9e5(pack_rgb9e5({-1, std::nanf(""), 1e30f})),
              (std::array<float, 3>{0, 0, 65408}));
    EXPECT_EQ(pack_rgb9e5({0, 0, 0}), 0u);
    EXPECT_EQ(pack_rgb9e5({1e-30f, 0, 0}), 0u);
    EXPECT_EQ(unpack_rgb9e5(pack_rgb9e5({kInfinity, 1, 0}))[0], 65408.0f);
}

TEST(Packed, ChannelsLieWhereTheFormatsSay) {
    // B10G11R11: 1.0 is exponent 15, no mantissa.
    EXPECT_EQ(pack_b10g11r11f({1, 0, 0}), 15u << 6);
    EXPECT_EQ(pack_b10g11r11f({0, 1, 0}), 15u << 17);
    EXPECT_EQ(pack_b10g11r11f({0, 0, 1}), 15u << 27);
    // E5B9G9R9: 1.0 is 256 2^(16 - 24).
    EXPECT_EQ(pack_rgb9e5({1, 0, 0}), 256u | 16u << 27);
    EXPECT_EQ(pack_rgb9e5({0, 1, 0}), 256u << 9 | 16u << 27);
    EXPECT_EQ(pack_rgb9e5({0, 0, 1}), 256u << 18 | 16u << 27);
}

TEST(Packed, ImagesComeBackFromTheirBytes) {
    for (const Packing packing : {Packing::rgba32f, Packing::rgba16f, Packing::rgb32f,
                                  Packing::rgb16f, Packing::rgb9e5, Packing::b10g11r11f}) {
        Image image(3, 2, channel_count(packing));
        for (std::size_t i = 0; i < image.values().size(); ++i)
            image.values()[i] = static_cast<float>(i) / 8;
        std::vector<std::byte> bytes(6 * texel_bytes(packing));
        pack(packing, image, bytes);
        const Image back = unpack(packing, bytes, 3, 2);
        EXPECT_TRUE(std::equal(image.values().begin(), image.values().end(), back.values().begin()))
            << static_cast<int>(packing);
    }
}

// Bit patterns of every kind, in rows longer than the blocks that vector code takes at a time.
TEST(Packed, RowsAreTheirTexels) {
    constexpr int width = 1021, height = 37;
    std::mt19937 random(3);
    for (const int channels : {3, 4}) {
        Image image(width, height, channels);
        for (float& value : image.values()) value = std::bit_cast<float>(unsigned(random()));
        const auto packed = [&](Packing packing) {
            std::vector<std::byte> bytes(image.texel_count() * texel_bytes(packing));
            pack(packing, image, bytes);
            return bytes;
        };
        const auto halves = packed(Packing::rgba16f), shared = packed(Packing::rgb9e5),
                   small = packed(Packing::b10g11r11f);
        for (int i = 0; i < width * height; ++i) {
            const float* texel = image.at(i % width, i / width);
            std::array<std::uint16_t, 4> half;
            std::memcpy(half.data(), &halves[std::size_t{8} * i], 8);
            for (int c = 0; c < 4; ++c) {
                const float value = c < channels ? texel[c] : 1;
                if (std::isnan(value))
                    ASSERT_TRUE(std::isnan(unpack_half(half[c])));
                else
                    ASSERT_EQ(half[c], Imath::half(value).bits()) << value;
            }
            std::uint32_t bits;
            std::memcpy(&bits, &shared[std::size_t{4} * i], 4);
            ASSERT_EQ(bits, pack_rgb9e5({texel[0], texel[1], texel[2]}));
            std::memcpy(&bits, &small[std::size_t{4} * i], 4);
            ASSERT_EQ(bits, pack_b10g11r11f({texel[0], texel[1], texel[2]}));
        }
    }
}

TEST(Packed, GreyBecomesColourAndAlphaIsOne) {
    Image grey(1, 1, 1), with_alpha(1, 1, 2);
    grey.at(0, 0)[0] = 3;
    with_alpha.at(0, 0)[0] = 3, with_alpha.at(0, 0)[1] = 0.25f;
    std::vector<std::byte> bytes(16);
    pack(Packing::rgba32f, grey, bytes);
    const Image a = unpack(Packing::rgba32f, bytes, 1, 1);
    EXPECT_EQ(std::vector<float>(a.values().begin(), a.values().end()),
              (std::vector<float>{3, 3, 3, 1}));
    pack(Packing::rgba32f, with_alpha, bytes);
    EXPECT_EQ(unpack(Packing::rgba32f, bytes, 1, 1).at(0, 0)[3], 0.25f);
}

TEST(Packed, EveryByteComesBackThroughSrgb) {
    for (const Packing packing : {Packing::rgba8, Packing::rgba8_srgb})
        for (int value = 0; value < 256; ++value) {
            const std::vector<std::byte> bytes(4, std::byte(value));
            std::vector<std::byte> back(4);
            pack(packing, unpack(packing, bytes, 1, 1), back);
            EXPECT_EQ(back, bytes);
        }
}

TEST(Packed, LevelsHalveToOne) {
    EXPECT_EQ(level_size(5, 1), 2);
    EXPECT_EQ(level_size(5, 7), 1);
    EXPECT_EQ(possible_level_count(1, 1), 1);
    EXPECT_EQ(possible_level_count(256, 256), 9);
    EXPECT_EQ(possible_level_count(257, 3), 9);
    // The bound holds for the worst shape, one texel wide.
    std::int64_t texels = 0;
    for (int level = 0; level < possible_level_count(1, 1024); ++level)
        texels += level_size(1024, level);
    EXPECT_LE(texels, image_count_bound(1, 11) * 1024);
}

}  // namespace
}  // namespace mirrorball::detail
