// DDS: round trips, the written bytes against Microsoft's description, and other programs' opinion.
#include <gtest/gtest.h>

#include "container_support.h"

namespace mirrorball {
namespace {

using detail::kDds;

struct Expected {
    TexelFormat format;
    std::uint32_t dxgi, texel_bytes;
};
constexpr Expected kExpected[] = {
    {TexelFormat::rgba16f, 10, 8},
    {TexelFormat::rgba32f, 2, 16},
    {TexelFormat::rgb9e5, 67, 4},
    {TexelFormat::r11g11b10f, 26, 4},
};

struct Case {
    Expected expected;
    int face_count, width, height, level_count;
};

std::vector<Case> cases() {
    std::vector<Case> all;
    for (const Expected& expected : kExpected) {
        all.push_back({expected, 6, 8, 8, 4});
        all.push_back({expected, 6, 5, 5, 3});
        all.push_back({expected, 6, 8, 8, 1});
        all.push_back({expected, 1, 16, 8, 5});
        all.push_back({expected, 1, 7, 3, 1});
    }
    return all;
}

class Dds : public testing::TestWithParam<Case> {
  protected:
    [[nodiscard]] static FileContents contents() {
        const Case& c = GetParam();
        return exact_contents(c.face_count, c.width, c.height, c.level_count);
    }
    [[nodiscard]] static Bytes bytes() {
        WriteOptions options;
        options.format = GetParam().expected.format;
        return written(kDds, contents(), options);
    }
};

TEST_P(Dds, ComesBackToTheBit) {
    const FileContents back = read_back(kDds, bytes());
    expect_same_bits(back, contents());
    EXPECT_EQ(back.stored, GetParam().expected.format);
    EXPECT_EQ(back.projection.has_value(), GetParam().face_count == 6);
}

TEST_P(Dds, SaysWhatTheFormatAsksFor) {
    const Case& c = GetParam();
    const Bytes b = bytes();
    const bool cube = c.face_count == 6, levels = c.level_count > 1;
    EXPECT_EQ(u32(b, 0), 0x20534444u);  // "DDS "
    EXPECT_EQ(u32(b, 4), 124u);
    EXPECT_EQ(u32(b, 8), 0x100fu | (levels ? 0x20000u : 0));
    EXPECT_EQ(u32(b, 12), static_cast<std::uint32_t>(c.height));
    EXPECT_EQ(u32(b, 16), static_cast<std::uint32_t>(c.width));
    EXPECT_EQ(u32(b, 20), c.width * c.expected.texel_bytes);
    EXPECT_EQ(u32(b, 24), 0u);
    EXPECT_EQ(u32(b, 28), static_cast<std::uint32_t>(c.level_count));
    EXPECT_EQ(u32(b, 76), 32u);
    EXPECT_EQ(u32(b, 80), 4u);
    EXPECT_EQ(u32(b, 84), 0x30315844u);  // "DX10"
    EXPECT_EQ(u32(b, 108), 0x1000u | (cube || levels ? 8u : 0) | (levels ? 0x400000u : 0));
    EXPECT_EQ(u32(b, 112), cube ? 0xfe00u : 0u);
    EXPECT_EQ(u32(b, 128), c.expected.dxgi);
    EXPECT_EQ(u32(b, 132), 3u);
    EXPECT_EQ(u32(b, 136), cube ? 4u : 0u);
    EXPECT_EQ(u32(b, 140), 1u);  // cubes, not faces
    EXPECT_EQ(u32(b, 144), 0u);
    std::uint64_t texels = 0;
    for (int level = 0; level < c.level_count; ++level)
        texels += std::max(c.width >> level, 1) * std::max(c.height >> level, 1);
    EXPECT_EQ(b.size(), 148 + c.face_count * texels * c.expected.texel_bytes);
}

INSTANTIATE_TEST_SUITE_P(Formats, Dds, testing::ValuesIn(cases()));

TEST(DdsData, EachFaceHasAllItsLevels) {
    WriteOptions options;
    options.format = TexelFormat::rgba32f;
    const FileContents contents = exact_contents(6, 4, 4, 3);
    const Bytes b = written(kDds, contents, options);
    std::uint64_t at = 148;
    for (int face = 0; face < 6; ++face)
        for (int level = 0; level < 3; ++level)
            for (int y = 0; y < 4 >> level; ++y)
                for (int x = 0; x < 4 >> level; ++x, at += 16) {
                    const float* texel = contents.levels[level][face].at(x, y);
                    for (int c = 0; c < 3; ++c) EXPECT_EQ(value_at<float>(b, at + 4 * c), texel[c]);
                    EXPECT_EQ(value_at<float>(b, at + 12), 1.0f);
                }
}

// As Direct3D 9 writes it: the code where "DX10" stood, and no second header.
Bytes legacy(const Bytes& dx10, std::uint32_t code) {
    Bytes b = with_u32(dx10, 84, code);
    b.erase(b.begin() + 128, b.begin() + 148);
    return b;
}

TEST(DdsRead, LegacyHalfAndFloat) {
    WriteOptions options;
    for (const auto& [format, code] :
         {std::pair{TexelFormat::rgba16f, 113u}, std::pair{TexelFormat::rgba32f, 116u}})
        for (const int face_count : {1, 6}) {
            options.format = format;
            const FileContents contents = exact_contents(face_count, 4, 4, 3);
            const FileContents back =
                read_back(kDds, legacy(written(kDds, contents, options), code));
            expect_same_bits(back, contents);
            EXPECT_EQ(back.stored, format);
            EXPECT_EQ(back.projection.has_value(), face_count == 6);
        }
}

TEST(DdsRead, ThreeChannelFloats) {
    const Image image = exact_image(3, 2, 3, 0, 0);
    Bytes b = with_u32(written(kDds, exact_contents(1, 3, 2, 1)), 128, 6);
    b.resize(148 + 6 * 12);
    detail::pack(detail::Packing::rgb32f, image, std::span(b).subspan(148));
    FileContents expected;
    expected.levels = {{image}};
    expect_same_bits(read_back(kDds, b), expected);
}

TEST(DdsRead, EightBitsAreAsTheFileHasThemUnlessAsked) {
    Bytes b = written(kDds, exact_contents(1, 1, 1, 1));
    b.resize(148);
    b.insert(b.end(), 4, std::byte{128});
    const auto value = [&](std::uint32_t dxgi, Transfer transfer) {
        return read_back(kDds, with_u32(b, 128, dxgi), transfer).levels[0][0].at(0, 0)[0];
    };
    const float linear = 128 / 255.0f, from_srgb = 0.21586050f;
    EXPECT_FLOAT_EQ(value(28, Transfer::automatic), linear);
    EXPECT_FLOAT_EQ(value(29, Transfer::automatic), from_srgb);
    EXPECT_FLOAT_EQ(value(28, Transfer::srgb), from_srgb);
    EXPECT_FLOAT_EQ(value(29, Transfer::linear), linear);
}

TEST(DdsRefusal, NamesWhatWasFound) {
    const Bytes cube = written(kDds, exact_contents(6, 4, 4, 3));
    const auto expect_words = [](const Bytes& b, const char* words) {
        const std::string message = refusal(kDds, b);
        EXPECT_NE(message.find(words), std::string::npos) << message;
    };
    expect_words(with_u32(cube, 4, 120), "120");
    expect_words(with_u32(cube, 16, 5), "5 x 4");
    expect_words(with_u32(cube, 28, 4), "4 levels");
    expect_words(with_u32(cube, 28, 1000000), "1000000 levels");
    expect_words(with_u32(cube, 80, 0x41), "by masks");
    expect_words(with_u32(cube, 84, 0x35545844), "'DXT5'");
    expect_words(with_u32(cube, 84, 111), "111");
    expect_words(with_u32(cube, 128, 95), "BC6H_UF16");
    expect_words(with_u32(cube, 128, 87), "87");
    expect_words(with_u32(cube, 132, 4), "volume");
    expect_words(with_u32(cube, 132, 2), "1-D");
    expect_words(with_u32(cube, 132, 9), "9");
    expect_words(with_u32(cube, 140, 2), "array of 2");
    expect_words(with_u32(legacy(cube, 113), 112, 0x0600), "six faces");
    expect_words(with_u32(legacy(cube, 113), 112, 0x200000), "volume");
    expect_words(with_u32(with_u32(cube, 12, 100000), 16, 100000), "100000 x 100000");
    expect_words(with_u32(with_u32(with_u32(cube, 12, 70000), 16, 70000), 140, 1), "70000");
}

TEST(DdsRefusal, LevelsThatDoNotHalve) {
    FileContents contents = exact_contents(6, 8, 8, 2);
    for (Image& face : contents.levels[1]) face = Image(3, 3, 3);
    EXPECT_NE(write_refusal(kDds, contents).find("level 1 is 3 x 3"), std::string::npos);
}

TEST(DdsDamage, EveryTruncationIsRefused) {
    expect_truncations_refused(kDds, written(kDds, exact_contents(6, 4, 4, 3)));
}

TEST(DdsDamage, EveryByteMayBeWrong) {
    const Bytes cube = written(kDds, exact_contents(6, 2, 2, 2));
    expect_damage_survived(kDds, cube);
    expect_damage_survived(kDds, legacy(cube, 113));
}

}  // namespace
}  // namespace mirrorball
