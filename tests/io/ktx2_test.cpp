// KTX2: round trips, and the written bytes against a reading of the specification that shares no
// code with the writer's.
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "container_support.h"

namespace mirrorball {
namespace {

using detail::kKtx2;

// What the specifications say of each format that we write.
struct Expected {
    TexelFormat format;
    std::uint32_t vk_format, type_size, texel_bytes, sample_count;
};
constexpr Expected kExpected[] = {
    {TexelFormat::rgba16f, 97, 2, 8, 4},
    {TexelFormat::rgba32f, 109, 4, 16, 4},
    {TexelFormat::rgb9e5, 123, 4, 4, 6},
    {TexelFormat::r11g11b10f, 122, 4, 4, 3},
};

struct Case {
    Expected expected;
    int face_count, width, height, level_count;
    bool compress;
};

std::vector<Case> cases() {
    std::vector<Case> all;
    for (const Expected& expected : kExpected)
        for (const bool compress : {false, true}) {
            all.push_back({expected, 6, 8, 8, 4, compress});
            all.push_back({expected, 6, 5, 5, 3, compress});
            all.push_back({expected, 6, 1, 1, 1, compress});
            all.push_back({expected, 6, 8, 8, 1, compress});
            all.push_back({expected, 1, 16, 8, 5, compress});
            all.push_back({expected, 1, 7, 3, 1, compress});
            all.push_back({expected, 1, 1, 9, 4, compress});
        }
    return all;
}

class Ktx2 : public testing::TestWithParam<Case> {
  protected:
    [[nodiscard]] static FileContents contents() {
        const Case& c = GetParam();
        FileContents result = exact_contents(c.face_count, c.width, c.height, c.level_count);
        result.metadata = {
            {"mirrorball.axes", "+x+y-z"}, {"a note", "of odd length: ä"}, {"B", ""}};
        return result;
    }
    [[nodiscard]] static Bytes bytes() {
        WriteOptions options;
        options.format = GetParam().expected.format;
        options.compress = GetParam().compress;
        return written(kKtx2, contents(), options);
    }
};

TEST_P(Ktx2, ComesBackToTheBit) {
    const FileContents back = read_back(kKtx2, bytes());
    expect_same_bits(back, contents());
    EXPECT_EQ(back.stored, GetParam().expected.format);
    EXPECT_EQ(back.projection.has_value(), GetParam().face_count == 6);
    for (const auto& [key, value] : contents().metadata) EXPECT_EQ(back.metadata.at(key), value);
    EXPECT_TRUE(back.metadata.at("KTXwriter").starts_with("mirrorball "));
    EXPECT_TRUE(back.notes.empty());
}

TEST_P(Ktx2, SaysWhatTheSpecificationAsksFor) {
    const Case& c = GetParam();
    const Bytes b = bytes();
    const unsigned char identifier[12] = {0xAB, 0x4B, 0x54, 0x58, 0x20, 0x32,
                                          0x30, 0xBB, 0x0D, 0x0A, 0x1A, 0x0A};
    EXPECT_EQ(std::memcmp(b.data(), identifier, 12), 0);
    EXPECT_EQ(u32(b, 12), c.expected.vk_format);
    EXPECT_EQ(u32(b, 16), c.expected.type_size);
    EXPECT_EQ(u32(b, 20), static_cast<std::uint32_t>(c.width));
    EXPECT_EQ(u32(b, 24), static_cast<std::uint32_t>(c.height));
    EXPECT_EQ(u32(b, 28), 0u);  // depth
    EXPECT_EQ(u32(b, 32), 0u);  // layers
    EXPECT_EQ(u32(b, 36), static_cast<std::uint32_t>(c.face_count));
    EXPECT_EQ(u32(b, 40), static_cast<std::uint32_t>(c.level_count));
    EXPECT_EQ(u32(b, 44), c.compress ? 2u : 0u);

    const std::uint64_t descriptor = u32(b, 48), descriptor_length = u32(b, 52);
    const std::uint64_t key_values = u32(b, 56), key_values_length = u32(b, 60);
    EXPECT_EQ(descriptor, 80u + 24u * c.level_count);
    EXPECT_EQ(descriptor_length, 4u + 24u + 16u * c.expected.sample_count);
    EXPECT_EQ(key_values, descriptor + descriptor_length);
    EXPECT_EQ(u64(b, 64), 0u);  // no global data
    EXPECT_EQ(u64(b, 72), 0u);

    // Levels: smallest first, aligned, zeros between, nothing after.
    std::uint64_t end = key_values + key_values_length;
    for (int level = c.level_count - 1; level >= 0; --level) {
        const std::uint64_t entry = 80 + 24 * level;
        const std::uint64_t offset = u64(b, entry), length = u64(b, entry + 8);
        const std::uint64_t w = std::max(c.width >> level, 1), h = std::max(c.height >> level, 1);
        EXPECT_EQ(u64(b, entry + 16), w * h * c.face_count * c.expected.texel_bytes);
        const std::uint64_t alignment = c.compress ? 1 : std::lcm(c.expected.texel_bytes, 4u);
        EXPECT_EQ(offset, (end + alignment - 1) / alignment * alignment);
        if (!c.compress) {
            EXPECT_EQ(length, u64(b, entry + 16));
        }
        for (std::uint64_t i = end; i < offset; ++i) EXPECT_EQ(b.at(i), std::byte{0});
        end = offset + length;
    }
    EXPECT_EQ(end, b.size());
}

TEST_P(Ktx2, KeysAreSortedAndPadded) {
    const Bytes b = bytes();
    std::uint64_t at = u32(b, 56);
    const std::uint64_t end = at + u32(b, 60);
    std::vector<std::string> keys;
    while (at < end) {
        EXPECT_EQ(at % 4, 0u);
        const std::uint32_t length = u32(b, at);
        ASSERT_LE(at + 4 + length, end);
        const std::string pair(reinterpret_cast<const char*>(b.data()) + at + 4, length);
        const std::string key = pair.substr(0, pair.find('\0'));
        EXPECT_EQ(pair.back(), '\0');
        if (key == "KTXorientation") {
            EXPECT_EQ(pair, std::string("KTXorientation\0rd\0", 18));
        }
        keys.push_back(key);
        at += 4 + length;
        for (; at % 4 != 0; ++at) EXPECT_EQ(b.at(at), std::byte{0});
    }
    EXPECT_EQ(at, end);
    EXPECT_EQ(keys, (std::vector<std::string>{"B", "KTXorientation", "KTXwriter", "a note",
                                              "mirrorball.axes"}));
}

INSTANTIATE_TEST_SUITE_P(Formats, Ktx2, testing::ValuesIn(cases()));

// The descriptor ---------------------------------------------------------------------------------

struct Sample {
    std::uint32_t bit_offset, bit_length, channel, flags, lower, upper;
    bool operator==(const Sample&) const = default;
};

std::vector<Sample> descriptor_of(const Bytes& b, std::uint32_t texel_bytes,
                                  std::uint32_t transfer) {
    const std::uint64_t at = u32(b, 48);
    const std::uint32_t total = u32(b, at), block = u32(b, at + 8) >> 16;
    EXPECT_EQ(total, u32(b, 52));
    EXPECT_EQ(u32(b, at + 4), 0u);           // Khronos, basic format
    EXPECT_EQ(u32(b, at + 8) & 0xffff, 2u);  // version 1.3
    EXPECT_EQ(block, total - 4);
    EXPECT_EQ(u32(b, at + 12), 1u | 1u << 8 | transfer << 16);  // RGBSDA, BT.709, straight alpha
    EXPECT_EQ(u32(b, at + 16), 0u);                             // blocks of 1 x 1
    EXPECT_EQ(u32(b, at + 20), texel_bytes);
    EXPECT_EQ(u32(b, at + 24), 0u);
    std::vector<Sample> samples;
    for (std::uint64_t s = at + 28; s < at + total; s += 16) {
        const std::uint32_t word = u32(b, s);
        EXPECT_EQ(u32(b, s + 4), 0u);
        samples.push_back({word & 0xffff, (word >> 16 & 0xff) + 1, word >> 24 & 0xf, word >> 28,
                           u32(b, s + 8), u32(b, s + 12)});
    }
    return samples;
}

TEST(Ktx2Descriptor, DescribesEachFormat) {
    constexpr std::uint32_t kMinusOne = 0xBF800000, kOne = 0x3F800000;
    constexpr std::uint32_t kFloat = 8, kSigned = 4, kExponent = 2;
    for (const Expected& e : kExpected)
        for (const bool compress : {false, true}) {
            WriteOptions options;
            options.format = e.format;
            options.compress = compress;
            const Bytes b = written(kKtx2, exact_contents(1, 4, 4, 1), options);
            const std::vector<Sample> samples = descriptor_of(b, e.texel_bytes, 1);
            ASSERT_EQ(samples.size(), e.sample_count);
            if (e.format == TexelFormat::rgba16f || e.format == TexelFormat::rgba32f) {
                const std::uint32_t bits = e.texel_bytes * 2, channels[] = {0, 1, 2, 15};
                for (std::uint32_t c = 0; c < 4; ++c)
                    EXPECT_EQ(samples[c], (Sample{c * bits, bits, channels[c], kFloat | kSigned,
                                                  kMinusOne, kOne}));
            } else if (e.format == TexelFormat::r11g11b10f) {
                EXPECT_EQ(samples[0], (Sample{0, 11, 0, kFloat, 0, kOne}));
                EXPECT_EQ(samples[1], (Sample{11, 11, 1, kFloat, 0, kOne}));
                EXPECT_EQ(samples[2], (Sample{22, 10, 2, kFloat, 0, kOne}));
            } else {
                for (std::uint32_t c = 0; c < 3; ++c) {
                    EXPECT_EQ(samples[2 * c], (Sample{9 * c, 9, c, 0, 0, 8448}));
                    EXPECT_EQ(samples[2 * c + 1], (Sample{27, 5, c, kExponent, 15, 31}));
                }
            }
        }
}

// Where texels lie -------------------------------------------------------------------------------

TEST(Ktx2Data, FacesFollowEachOtherRowByRowFromTheTop) {
    WriteOptions options;
    options.format = TexelFormat::rgba32f;
    const FileContents contents = exact_contents(6, 4, 4, 3);
    const Bytes b = written(kKtx2, contents, options);
    for (int level = 0; level < 3; ++level) {
        const int n = 4 >> level;
        std::uint64_t at = u64(b, 80 + 24 * level);
        for (int face = 0; face < 6; ++face)
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x, at += 16) {
                    const float* texel = contents.levels[level][face].at(x, y);
                    for (int c = 0; c < 3; ++c) EXPECT_EQ(value_at<float>(b, at + 4 * c), texel[c]);
                    EXPECT_EQ(value_at<float>(b, at + 12), 1.0f);
                }
    }
}

TEST(Ktx2Data, AnAlphaThatSaysSomethingIsKept) {
    const FileContents contents = exact_contents(1, 4, 2, 1, 4);
    expect_same_bits(read_back(kKtx2, written(kKtx2, contents)), contents);
}

// Compression is for those who ask for it: viewers without Zstandard are many.
TEST(Ktx2Data, IsNotCompressedUnlessAsked) {
    const FileContents contents = exact_contents(6, 32, 32, 1);
    EXPECT_EQ(u32(written(kKtx2, contents), 44), 0u);
    WriteOptions options;
    options.compress = true;
    EXPECT_LT(written(kKtx2, contents, options).size(), written(kKtx2, contents).size());
}

TEST(Ktx2Data, SameContentsSameBytes) {
    WriteOptions options;
    options.compress = true;
    const FileContents contents = exact_contents(6, 16, 16, 5);
    EXPECT_EQ(written(kKtx2, contents, options), written(kKtx2, contents, options));
}

// A source file's own words about itself are not passed on.
TEST(Ktx2Data, KeysOfTheFormatAreOurs) {
    FileContents contents = exact_contents(1, 2, 2, 1);
    contents.metadata = {
        {"KTXorientation", "lu"}, {"KTXwriter", "another"}, {"KTXswizzle", "bgra"}};
    const FileContents back = read_back(kKtx2, written(kKtx2, contents));
    EXPECT_EQ(back.metadata.at("KTXorientation"), "rd");
    EXPECT_TRUE(back.metadata.at("KTXwriter").starts_with("mirrorball"));
    EXPECT_FALSE(back.metadata.contains("KTXswizzle"));
}

// Reading what others write ----------------------------------------------------------------------

// A file of one level by another format's number: as it is laid out when its texels have the same
// size and the descriptor is not looked into.
Bytes file_of_format(std::uint32_t vk_format, const Bytes& texels, int width, int height) {
    Bytes b = written(kKtx2, exact_contents(1, 1, 1, 1));
    b = with_u32(std::move(b), 12, vk_format);
    b = with_u32(std::move(b), 20, static_cast<std::uint32_t>(width));
    b = with_u32(std::move(b), 24, static_cast<std::uint32_t>(height));
    const std::uint64_t entry[3] = {b.size(), texels.size(), texels.size()};
    std::memcpy(b.data() + 80, entry, sizeof entry);
    b.insert(b.end(), texels.begin(), texels.end());
    return b;
}

TEST(Ktx2Read, ThreeChannelHalvesAndFloats) {
    const Image image = exact_image(3, 2, 3, 0, 0);
    for (const auto& [vk_format, packing] :
         {std::pair{90u, detail::Packing::rgb16f}, std::pair{106u, detail::Packing::rgb32f}}) {
        Bytes texels(6 * detail::texel_bytes(packing));
        detail::pack(packing, image, texels);
        FileContents expected;
        expected.levels = {{image}};
        expect_same_bits(read_back(kKtx2, file_of_format(vk_format, texels, 3, 2)), expected);
    }
}

TEST(Ktx2Read, EightBitsAreAsTheFileHasThemUnlessAsked) {
    const Bytes grey(4, std::byte{128});
    const auto value = [&](std::uint32_t vk_format, Transfer transfer) {
        return read_back(kKtx2, file_of_format(vk_format, grey, 1, 1), transfer)
            .levels[0][0]
            .at(0, 0)[0];
    };
    const float linear = 128 / 255.0f, from_srgb = 0.21586050f;  // IEC 61966-2-1 of 128
    EXPECT_FLOAT_EQ(value(37, Transfer::automatic), linear);
    EXPECT_FLOAT_EQ(value(43, Transfer::automatic), from_srgb);
    EXPECT_FLOAT_EQ(value(37, Transfer::srgb), from_srgb);
    EXPECT_FLOAT_EQ(value(43, Transfer::linear), linear);
}

TEST(Ktx2Read, LevelCountZeroIsTheBaseAlone) {
    const FileContents contents = exact_contents(6, 4, 4, 1);
    expect_same_bits(read_back(kKtx2, with_u32(written(kKtx2, contents), 40, 0)), contents);
}

TEST(Ktx2Read, PicturesStoredBottomUpAreTurned) {
    const FileContents contents = exact_contents(1, 4, 3, 1);
    Bytes b = written(kKtx2, contents);
    const std::string_view key("KTXorientation\0rd", 17);
    const auto at = std::search(b.begin(), b.end(), key.begin(), key.end(),
                                [](std::byte x, char y) { return x == std::byte(y); });
    ASSERT_NE(at, b.end());
    *(at + 16) = std::byte{'u'};
    const FileContents back = read_back(kKtx2, b);
    ASSERT_EQ(back.notes.size(), 1u);
    for (int y = 0; y < 3; ++y)
        EXPECT_EQ(back.levels[0][0].rgb(1, y), contents.levels[0][0].rgb(1, 2 - y));
}

// What is refused, and in which words ------------------------------------------------------------

TEST(Ktx2Refusal, NamesWhatWasFound) {
    const Bytes cube = written(kKtx2, exact_contents(6, 4, 4, 3));
    const auto message = [&](std::size_t offset, std::uint32_t value) {
        return refusal(kKtx2, with_u32(cube, offset, value));
    };
    const auto expect_words = [&](std::size_t offset, std::uint32_t value, const char* words) {
        EXPECT_NE(message(offset, value).find(words), std::string::npos) << message(offset, value);
    };
    expect_words(12, 143, "BC6H_UFLOAT");
    expect_words(12, 0, "Basis");
    expect_words(12, 5000, "5000");
    expect_words(20, 0, "0 x 4");
    expect_words(20, 5, "5 x 4");
    expect_words(24, 0, "4 x 0");
    expect_words(28, 2, "volume of depth 2");
    expect_words(32, 3, "array of 3 layers");
    expect_words(36, 2, "2 faces");
    expect_words(40, 4, "4 levels");
    expect_words(40, 0xffffffff, "4294967295 levels");
    expect_words(44, 1, "BasisLZ");
    expect_words(44, 3, "ZLIB");
    expect_words(44, 9, "9");
    expect_words(80, 0xfffffff0, "level 0 is at byte");
    expect_words(88, 1, "level 0 has 1 bytes");
}

TEST(Ktx2Refusal, AClaimIsHeldAgainstTheFile) {
    Bytes b =
        with_u32(with_u32(written(kKtx2, exact_contents(6, 4, 4, 1)), 20, 100000), 24, 100000);
    EXPECT_NE(refusal(kKtx2, b).find("100000 x 100000"), std::string::npos);
    b = with_u32(std::move(b), 44, 2);  // the same, said to be compressed
    EXPECT_NE(refusal(kKtx2, b).find("100000 x 100000"), std::string::npos);
    b = with_u32(with_u32(std::move(b), 20, 0xffffffff), 24, 0xffffffff);
    EXPECT_NE(refusal(kKtx2, b).find("4294967295"), std::string::npos);
}

TEST(Ktx2Refusal, BrokenZstandard) {
    WriteOptions options;
    options.compress = true;
    Bytes b = written(kKtx2, exact_contents(6, 4, 4, 1), options);
    b[u64(b, 80)] ^= std::byte{0xff};
    EXPECT_NE(refusal(kKtx2, b).find("Zstandard"), std::string::npos);
}

TEST(Ktx2Refusal, LevelsThatDoNotHalve) {
    FileContents contents = exact_contents(1, 8, 4, 2);
    contents.levels[1][0] = Image(4, 3, 3);
    EXPECT_NE(write_refusal(kKtx2, contents).find("level 1 is 4 x 3"), std::string::npos);
    contents = exact_contents(1, 2, 2, 2);
    contents.levels.push_back({Image(1, 1, 3)});
    EXPECT_NE(write_refusal(kKtx2, contents).find("3 levels"), std::string::npos);
}

TEST(Ktx2Damage, EveryTruncationIsRefused) {
    WriteOptions options;
    for (const bool compress : {false, true}) {
        options.compress = compress;
        expect_truncations_refused(kKtx2, written(kKtx2, exact_contents(6, 4, 4, 3), options));
    }
}

TEST(Ktx2Damage, EveryByteMayBeWrong) {
    WriteOptions options;
    for (const bool compress : {false, true}) {
        options.compress = compress;
        expect_damage_survived(kKtx2, written(kKtx2, exact_contents(6, 2, 2, 2), options));
    }
}

}  // namespace
}  // namespace mirrorball
