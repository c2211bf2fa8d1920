// Radiance HDR beyond the round trips of codecs_test.cpp: the codings we do not write,
// orientations, header lines, and every way for a file to be broken.
#include "io/hdr.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>

#include "io/codec.h"
#include "io_test_support.h"
#include "support.h"

namespace mirrorball::detail {
namespace {

const std::string kHeader = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";

std::string text(std::initializer_list<int> bytes) {
    std::string result;
    for (const int byte : bytes) result.push_back(static_cast<char>(byte));
    return result;
}

// Mantissas at the exponent byte 136, which stands for 1.
std::string texel(int r, int g, int b) {
    return text({r, g, b, 136});
}

FileContents decode(const std::string& file) {
    InputFile input("test.hdr", std::as_bytes(std::span(file)));
    return read_contents(input, {});
}

Image decode_image(const std::string& file) {
    return decode(file).levels[0][0];
}

void expect_refused(const std::string& file, std::initializer_list<std::string> words) {
    const auto begin = std::chrono::steady_clock::now();
    expect_error([&] { (void)decode(file); }, Errc::cannot_read, words);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(200));
}

std::string encode(const Image& image) {
    const TemporaryFolder folder;
    write_image(folder / "a.hdr", image);
    std::ifstream in(folder / "a.hdr", std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Hdr, ReadsPlainTexels) {
    const Image image = decode_image(kHeader + "-Y 2 +X 2\n" + texel(130, 2, 3) + texel(140, 5, 6) +
                                     texel(150, 8, 9) + text({0, 0, 0, 0}));
    EXPECT_EQ(image.rgb(0, 0), Vec3f(130, 2, 3));
    EXPECT_EQ(image.rgb(1, 0), Vec3f(140, 5, 6));
    EXPECT_EQ(image.rgb(0, 1), Vec3f(150, 8, 9));
    EXPECT_EQ(image.rgb(1, 1), Vec3f(0, 0, 0));
}

// Mantissa and exponent for all exponents: m 2^(e - 136), which a float holds without rounding.
TEST(Hdr, EveryExponentIsExact) {
    for (int e = 1; e < 256; ++e) {
        const Image image = decode_image(kHeader + "-Y 1 +X 1\n" + text({255, 1, 0, e}));
        EXPECT_EQ(image.at(0, 0)[0], std::ldexp(255.0, e - 136));
        EXPECT_EQ(image.at(0, 0)[1], std::ldexp(1.0, e - 136));
        EXPECT_EQ(image.at(0, 0)[2], 0);
    }
}

// Every mantissa beside every largest one, and every exponent: the same bytes again.
TEST(Hdr, WritesTheBytesThatItRead) {
    std::string file = kHeader + "-Y 128 +X 256\n";
    for (int largest = 128; largest < 256; ++largest) {
        file += text({2, 2, 1, 0});
        std::string planes[4];
        for (int x = 0; x < 256; ++x) {
            planes[0].push_back(static_cast<char>(largest));
            planes[1].push_back(static_cast<char>(std::min(x, largest)));
            planes[2].push_back(static_cast<char>(largest - std::min(x, largest)));
            planes[3].push_back(static_cast<char>(1 + (x + largest) % 255));
        }
        for (const std::string& plane : planes)
            file += text({128}) + plane.substr(0, 128) + text({128}) + plane.substr(128);
    }
    const Image image = decode_image(file);
    expect_equal(decode_image(encode(image)), image);
    for (int y = 0; y < image.height(); ++y) {
        const Image one_row = [&] {
            Image row(256, 1, 3);
            std::copy(image.row(y).begin(), image.row(y).end(), row.values().begin());
            return row;
        }();
        // Narrow rows are plain bytes, which can be compared as they are.
        for (int x = 0; x < 256; x += 85) {
            Image narrow(1, 1, 3);
            narrow.set_rgb(0, 0, one_row.rgb(x, 0));
            const std::string bytes = encode(narrow);
            const int largest = 128 + y, low = std::min(x, largest);
            EXPECT_EQ(bytes.substr(bytes.size() - 4),
                      text({largest, low, largest - low, 1 + (x + largest) % 255}));
        }
    }
}

// The largest channel keeps 8 bits, so no channel is off by more than 1/512 of it (half a unit in
// 256, the largest mantissa being at least 128 of them). Carry to the next exponent included.
TEST(Hdr, RoundsToTheNearest) {
    Image image(4096, 1, 3);
    for (int x = 0; x < image.width(); ++x) {
        const auto v = static_cast<float>(1 + x / 4096.0);
        image.set_rgb(x, 0, {v, v / 3, v / 300});
    }
    image.set_rgb(0, 0, {255.75f, 0.3f, 0});
    const Image back = decode_image(encode(image));
    for (int x = 0; x < image.width(); ++x) {
        const float largest = image.at(x, 0)[0];
        double unit = std::exp2(std::floor(std::log2(largest)) - 7);
        if (largest / unit >= 255.5) unit *= 2;  // it is written with the next exponent
        for (int c = 0; c < 3; ++c)
            EXPECT_LE(std::abs(back.at(x, 0)[c] - image.at(x, 0)[c]), unit / 2);
    }
    EXPECT_EQ(back.rgb(0, 0), Vec3f(256, 0, 0));
}

TEST(Hdr, TinyValuesBecomeBlackWithoutHarm) {
    Image image(1, 1, 3);
    image.set_rgb(0, 0, {1e-40f, 0, 0});
    EXPECT_EQ(decode_image(encode(image)).rgb(0, 0), Vec3f(0, 0, 0));
    image.set_rgb(0, 0, {0x1p-128f, 0, 0});
    EXPECT_EQ(decode_image(encode(image)).rgb(0, 0), Vec3f(0x1p-128f, 0, 0));
}

TEST(Hdr, RunsShrinkFlatPicturesAndNeverGrowOthers) {
    Image flat(1000, 4, 3);
    for (float& v : flat.values()) v = 1;
    EXPECT_LT(encode(flat).size(), 4u * 4 * 20 + 200);
    Image noisy(1000, 4, 3);
    unsigned state = 1;
    for (float& v : noisy.values())
        v = static_cast<float>((state = state * 1664525 + 1013904223) >> 8);
    // A count for every 128 bytes that are copied, and the scanline's marker.
    EXPECT_LE(encode(noisy).size(), 4u * (1000 * 4 + 4 * 8 + 4) + 200);
    expect_equal(decode_image(encode(flat)), flat);
}

TEST(Hdr, WideRowsAreNotRunLengthCoded) {
    for (const int width : {32767, 32768, 70000}) {
        Image image(width, 2, 3);
        for (int x = 0; x < width; ++x) image.set_rgb(x, x % 2, Vec3f(static_cast<float>(x % 256)));
        expect_equal(decode_image(encode(image)), image);
    }
}

TEST(Hdr, ReadsTheOlderRepeats) {
    // 1 + 5 + (0x2b + 256) texels: repeats in a row are digits, lowest first.
    const std::string row = texel(200, 100, 50) + text({1, 1, 1, 5}) + texel(128, 0, 1) +
                            text({1, 1, 1, 0x2b}) + text({1, 1, 1, 1});
    const Image image = decode_image(kHeader + "-Y 1 +X 306\n" + row);
    for (int x = 0; x < 306; ++x)
        EXPECT_EQ(image.rgb(x, 0), x < 6 ? Vec3f(200, 100, 50) : Vec3f(128, 0, 1)) << x;
}

TEST(Hdr, AllEightOrientationsAreTurnedUpright) {
    // Upright: 1 2 3 over 4 5 6. Each line lists the texels in the order of its scanlines.
    const std::vector<std::pair<std::string, std::array<int, 6>>> cases{
        {"-Y 2 +X 3", {1, 2, 3, 4, 5, 6}}, {"-Y 2 -X 3", {3, 2, 1, 6, 5, 4}},
        {"+Y 2 +X 3", {4, 5, 6, 1, 2, 3}}, {"+Y 2 -X 3", {6, 5, 4, 3, 2, 1}},
        {"+X 3 -Y 2", {1, 4, 2, 5, 3, 6}}, {"+X 3 +Y 2", {4, 1, 5, 2, 6, 3}},
        {"-X 3 -Y 2", {3, 6, 2, 5, 1, 4}}, {"-X 3 +Y 2", {6, 3, 5, 2, 4, 1}}};
    for (const auto& [resolution, order] : cases) {
        std::string file = kHeader + resolution + "\n";
        for (const int value : order) file += texel(128 + value, 0, 0);
        const Image image = decode_image(file);
        ASSERT_EQ(image.width(), 3) << resolution;
        ASSERT_EQ(image.height(), 2) << resolution;
        for (int i = 0; i < 6; ++i)
            EXPECT_EQ(image.at(i % 3, i / 3)[0], 129 + i) << resolution << " texel " << i;
    }
}

TEST(Hdr, ExposureIsDividedOut) {
    const std::string lines =
        "#?RADIANCE\n# a comment\npfilt -e 2\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=4\nEXPOSURE= 0.5 \n"
        "COLORCORR=1 2 4\nVIEW= -vta -vh 360\n\n-Y 1 +X 1\n";
    const FileContents contents = decode(lines + texel(160, 80, 40));
    EXPECT_EQ(contents.levels[0][0].rgb(0, 0), Vec3f(80, 20, 5));
    EXPECT_EQ(contents.notes.size(), 1u);
    EXPECT_EQ(contents.metadata.at("VIEW"), "-vta -vh 360");
}

TEST(Hdr, XyzBecomesRgb) {
    const std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n";
    // D65's own XYZ (0.9505, 1, 1.089), times 128 and rounded to whole mantissas, is nearly
    // neutral.
    const FileContents contents = decode(file + texel(122, 128, 139));
    const Vec3f rgb = contents.levels[0][0].rgb(0, 0);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(rgb[c], 128, 2);  // half a unit, times the matrix's rows
    EXPECT_EQ(contents.notes.size(), 1u);
}

TEST(Hdr, MetadataOfOursTravels) {
    const TemporaryFolder folder;
    FileContents contents;
    contents.metadata = {{"mirrorball.axes", "+X +Y"}, {"other", "x"}, {"mirrorball.bad", "a\nb"}};
    contents.levels = {{Image(2, 2, 3)}};
    write_contents(folder / "a.hdr", kHdr, contents, {TexelFormat::rgbe8});
    const Metadata metadata = read_file(folder / "a.hdr").metadata;
    EXPECT_EQ(metadata.at("mirrorball.axes"), "+X +Y");
    EXPECT_EQ(metadata.count("other"), 0u);
    EXPECT_EQ(metadata.count("mirrorball.bad"), 0u);
}

TEST(Hdr, StreamsRowByRow) {
    const TemporaryFolder folder;
    const int width = 64, height = 9;
    {
        OutputFile file(folder / "a.hdr");
        HdrWriter writer(file, width, height);
        std::vector<float> row(3 * width);
        for (int y = 0; y < height; ++y) {
            std::fill(row.begin(), row.end(), static_cast<float>(128 + y));
            writer.write_row(row);
        }
        file.commit();
    }
    InputFile file(folder / "a.hdr");
    HdrReader reader(file);
    ASSERT_EQ(reader.length(), width);
    ASSERT_EQ(reader.scanline_count(), height);
    EXPECT_TRUE(reader.orientation().upright());
    std::vector<float> row(3 * width);
    for (int y = 0; y < height; ++y) {
        reader.read_scanlines(row);
        for (const float v : row) ASSERT_EQ(v, 128 + y);
    }
    EXPECT_EQ(file.remaining(), 0u);
}

TEST(Hdr, ToleratesForeignLineEnds) {
    const Image image =
        decode_image("#?RGBE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n-Y 1 +X 1\r\n" + texel(130, 2, 3));
    EXPECT_EQ(image.rgb(0, 0), Vec3f(130, 2, 3));
}

TEST(Hdr, BrokenHeadersAreRefused) {
    const std::string magic = "#?RADIANCE\n";
    expect_refused("#?RADIANCE", {"test.hdr", "truncated", "header"});
    expect_refused(magic + "FORMAT=32-bit_rle_rgbe\n", {"truncated", "header"});
    expect_refused(magic + "FORMAT=32-bit_rle_foo\n\n-Y 1 +X 1\n", {"32-bit_rle_foo", "expected"});
    expect_refused(magic + std::string(100'000, 'x'), {"line of over 65536 bytes"});
    expect_refused(magic +
                       [] {
                           std::string lines;
                           for (int i = 0; i < 20'000; ++i) lines += "A=1\n";
                           return lines;
                       }(),
                   {"10000 lines"});
    for (const char* exposure : {"abc", "0", "-1", "inf", "nan", "", "1e999", "1 2"})
        expect_refused(magic + "EXPOSURE=" + exposure + "\n\n-Y 1 +X 1\n" + texel(128, 1, 1),
                       {"EXPOSURE", "expected"});
    expect_refused(magic + "EXPOSURE=1e-30\nEXPOSURE=1e-30\n\n-Y 1 +X 1\n" + texel(128, 1, 1),
                   {"EXPOSURE", "out of range"});
    expect_refused(magic + "COLORCORR=1 2\n\n-Y 1 +X 1\n", {"COLORCORR", "3 positive numbers"});
}

TEST(Hdr, BrokenSizesAreRefused) {
    for (const char* size : {"", "hello", "-Y 4", "-Y 4 +X", "-Y 4 +Y 4", "-Y 4 +X 4 5", "Y 4 X 4",
                             "-Z 4 +X 4", "4 4", "+X"})
        expect_refused(kHeader + size + "\n", {"has the size", "expected"});
    for (const char* size :
         {"-Y four +X 4", "-Y 4.5 +X 4", "-Y 4 +X 99999999999999999999", "-Y 0x10 +X 4"})
        expect_refused(kHeader + size + "\n", {"has the size", "whole numbers"});
    for (const char* size : {"-Y 0 +X 4", "-Y 4 +X 0", "-Y -4 +X 4", "-Y 4 +X -4",
                             "-Y 4 +X 2000000", "-Y 9223372036854775807 +X 4"})
        expect_refused(kHeader + size + "\n" + std::string(1000, 'x'), {"claims", "1 to 1048576"});
    for (const char* size : {"-Y 100000 +X 100000", "-Y 1000000 +X 1000000", "-Y 1 +X 1000000"})
        expect_refused(kHeader + size + "\n", {"truncated"});
    // Enough for the older repeats, but the first scanline says that it is in runs.
    expect_refused(kHeader + "-Y 30000 +X 30000\n" + text({2, 2, 30000 >> 8, 30000 & 255}) +
                       std::string(12 * 30000, '\0'),
                   {"truncated", "30000 x 30000"});
}

TEST(Hdr, BrokenScanlinesAreRefused) {
    const std::string size8 = kHeader + "-Y 1 +X 8\n";
    const std::string marker = text({2, 2, 0, 8});
    const std::string padding(64, '\x01');
    const std::string run_of_8 = text({136, 1});
    expect_refused(size8 + text({2, 2, 0, 9}) + padding, {"scanline of 9 texels", "8 expected"});
    expect_refused(size8 + marker + text({137, 1}) + padding, {"run of 9 texels", "8 are left"});
    expect_refused(size8 + marker + text({9}) + padding, {"run of 9 texels", "8 are left"});
    expect_refused(size8 + marker + text({0}) + padding, {"run of 0 texels"});
    expect_refused(size8 + marker + text({132, 1, 133, 1}) + padding, {"run of 5", "4 are left"});
    expect_refused(size8 + marker + run_of_8 + run_of_8 + run_of_8 + text({135}), {"truncated"});
    expect_refused(size8 + marker + run_of_8 + run_of_8 + run_of_8 + text({8, 1, 2, 3}),
                   {"truncated"});
    expect_refused(size8 + texel(128, 0, 0) + text({1, 1, 1, 8}), {"8 times", "7 are left"});
    expect_refused(size8 + text({1, 1, 1, 8}) + padding, {"none to repeat"});
    // Repeats of nothing, without end.
    std::string nothing = size8 + texel(128, 0, 0);
    for (int i = 0; i < 100; ++i) nothing += text({1, 1, 1, 0});
    expect_refused(nothing, {"repeats"});
    expect_refused(kHeader + "-Y 3 +X 2\n" + texel(128, 0, 0) + texel(128, 0, 0) + texel(128, 0, 0),
                   {"truncated"});
}

}  // namespace
}  // namespace mirrorball::detail
