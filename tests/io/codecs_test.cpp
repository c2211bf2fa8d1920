// What holds for every picture format: texels come back as they went in, where they belong, and
// what a format cannot hold is clamped and counted. And what goes wrong is said in words.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

#include <mirrorball/io.h>

#include "io/codec.h"
#include "io_test_support.h"
#include "support.h"

namespace mirrorball {
namespace {

namespace fs = std::filesystem;
using detail::codecs;

struct Form {
    std::string ending;
    TexelFormat format;
    int channels;  // that the file has; more are dropped, fewer repeated
};

// Every way in which this project writes one flat picture.
std::vector<Form> forms() {
    std::vector<Form> result{{".hdr", TexelFormat::rgbe8, 3},
                             {".pfm", TexelFormat::rgba32f, 1},
                             {".pfm", TexelFormat::rgba32f, 3}};
    for (int channels = 1; channels <= 4; ++channels) {
        for (const auto format : {TexelFormat::unorm8, TexelFormat::unorm16}) {
            result.push_back({".png", format, channels});
            result.push_back({".tif", format, channels});
        }
        for (const auto format : {TexelFormat::rgba16f, TexelFormat::rgba32f})
            result.push_back({".tif", format, channels});
    }
    return result;
}

std::string describe(const Form& form) {
    return form.ending + " " + std::string(name(form.format)) + " with " +
           std::to_string(form.channels) + " channels";
}

// A value that the format holds exactly, another one for each i (up to its number of codes).
float exact_value(TexelFormat format, bool is_alpha, int i) {
    const double most = format == TexelFormat::unorm8 ? 255 : 65535;
    switch (format) {
        case TexelFormat::unorm8:
        case TexelFormat::unorm16: {
            const auto encoded = static_cast<float>(i * 37 % static_cast<int>(most) / most);
            return is_alpha ? encoded : detail::srgb_to_linear(encoded);
        }
        // The largest of three channels sets the exponent: 128..255 all share one.
        case TexelFormat::rgbe8:
            return static_cast<float>(128 + i * 37 % 128);
        case TexelFormat::rgba16f:
            return static_cast<float>(i * 37 % 2048 - 1024) / 64;
        default:
            return std::sqrt(static_cast<float>(i + 1)) * (i % 2 == 0 ? 1e3f : -1e-3f);
    }
}

Image exact_image(const Form& form, int width, int height) {
    Image image(width, height, form.channels);
    const bool has_alpha = form.channels % 2 == 0;
    int i = 0;
    for (float& value : image.values()) {
        const bool is_alpha = has_alpha && i % form.channels == form.channels - 1;
        value = exact_value(form.format, is_alpha, i);
        ++i;
    }
    return image;
}

TEST(Codecs, EveryFormatGivesBackWhatItHolds) {
    const TemporaryFolder folder;
    for (const Form& form : forms())
        for (const auto& [width, height] : std::vector<std::pair<int, int>>{
                 {1, 1}, {7, 3}, {8, 5}, {1, 9}, {129, 70}, {300, 2}}) {
            SCOPED_TRACE(describe(form) + " " + std::to_string(width) + "x" +
                         std::to_string(height));
            const Image image = exact_image(form, width, height);
            const fs::path path = folder / ("a" + form.ending);
            for (const bool compress : {true, false}) {
                const WriteReport report = write_image(path, image, {form.format, compress});
                EXPECT_EQ(report.clipped_texel_count, 0);
                EXPECT_EQ(report.byte_count, fs::file_size(path));
                const FileContents contents = read_file(path);
                EXPECT_EQ(contents.stored, form.format);
                ASSERT_EQ(contents.levels.size(), 1u);
                ASSERT_EQ(contents.levels[0].size(), 1u);
                expect_equal(contents.levels[0][0], image);
            }
        }
}

TEST(Codecs, IntegersSayHowTheyWereTaken) {
    const TemporaryFolder folder;
    Image image(2, 1, 1);
    image.values()[1] = 1;
    for (const char* file : {"a.png", "a.tif"}) {
        write_image(folder / file, image, {TexelFormat::unorm8});
        const FileContents contents = read_file(folder / file);
        ASSERT_EQ(contents.notes.size(), 1u) << file;
        EXPECT_NE(contents.notes[0].find("sRGB"), std::string::npos);
    }
}

// All 256 codes of 8 bits and all 65536 of 16 are their own round trip through linear light.
TEST(Codecs, SrgbCodesSurvive) {
    for (const double most : {255.0, 65535.0})
        for (int code = 0; code <= static_cast<int>(most); ++code) {
            const float linear = detail::srgb_to_linear(static_cast<float>(code / most));
            const double back = double{detail::linear_to_srgb(linear)} * most;
            ASSERT_EQ(std::lround(back), code);
        }
    // The curve's own landmarks, and its continuation.
    EXPECT_EQ(detail::srgb_to_linear(0), 0);
    EXPECT_EQ(detail::srgb_to_linear(1), 1);
    EXPECT_NEAR(detail::srgb_to_linear(0.5f), 0.21404114, 1e-7);
    EXPECT_EQ(detail::srgb_to_linear(-0.5f), -detail::srgb_to_linear(0.5f));
    EXPECT_GT(detail::linear_to_srgb(4), 1.8f);
}

TEST(Codecs, TransferIsTheUsersToChoose) {
    const TemporaryFolder folder;
    const Image half(1, 1, 3);
    Image image = half;
    image.set_rgb(0, 0, {0.25f, 0.5f, 0.75f});
    ReadOptions as_linear, as_srgb;
    as_linear.transfer = Transfer::linear;
    as_srgb.transfer = Transfer::srgb;

    write_image(folder / "a.png", image, {TexelFormat::unorm16});
    const Image encoded = read_image(folder / "a.png", as_linear);
    for (int c = 0; c < 3; ++c)  // half a code of 16 bits
        EXPECT_NEAR(encoded.at(0, 0)[c], detail::linear_to_srgb(image.at(0, 0)[c]),
                    0.5 / 65535 + 1e-7);

    write_image(folder / "a.pfm", image);
    const FileContents decoded = read_file(folder / "a.pfm", as_srgb);
    EXPECT_EQ(decoded.levels[0][0].at(0, 0)[1], detail::srgb_to_linear(0.5f));
    ASSERT_EQ(decoded.notes.size(), 1u);
    EXPECT_EQ(read_image(folder / "a.pfm").at(0, 0)[1], 0.5f);
}

TEST(Codecs, WhatDoesNotFitIsClampedAndCounted) {
    const TemporaryFolder folder;
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Image image(5, 1, 3);
    image.set_rgb(0, 0, {0.5f, 0.5f, 0.5f});
    image.set_rgb(1, 0, {-1, 0, 0});
    image.set_rgb(2, 0, {2, 2, 2});
    image.set_rgb(3, 0, {1e6f, 1, 1});
    image.set_rgb(4, 0, {0, kInfinity, 0});
    struct Case {
        const char* file;
        TexelFormat format;
        int clipped;
        float most, least;
    };
    for (const Case& c : std::vector<Case>{{"a.png", TexelFormat::unorm8, 4, 1, 0},
                                           {"a.tif", TexelFormat::unorm16, 4, 1, 0},
                                           {"b.tif", TexelFormat::rgba16f, 2, 65504, -1},
                                           {"c.tif", TexelFormat::rgba32f, 0, kInfinity, -1},
                                           {"a.hdr", TexelFormat::rgbe8, 2, 0x1.fep126f, 0},
                                           {"a.pfm", TexelFormat::automatic, 0, kInfinity, -1}}) {
        SCOPED_TRACE(c.file);
        EXPECT_EQ(write_image(folder / c.file, image, {c.format}).clipped_texel_count, c.clipped);
        const Image back = read_image(folder / c.file);
        EXPECT_EQ(*std::max_element(back.values().begin(), back.values().end()), c.most);
        EXPECT_EQ(*std::min_element(back.values().begin(), back.values().end()), c.least);
    }
}

TEST(Codecs, LargestValuesAreTheFormats) {
    using detail::largest_value;
    EXPECT_EQ(largest_value(TexelFormat::rgba16f), 65504);
    EXPECT_EQ(largest_value(TexelFormat::rgb9e5), 65408);
    EXPECT_EQ(largest_value(TexelFormat::r11g11b10f), 65024);
    EXPECT_EQ(largest_value(TexelFormat::r11g11b10f, 2), 64512);
    EXPECT_EQ(largest_value(TexelFormat::unorm8), 1);
    EXPECT_EQ(largest_value(TexelFormat::rgbe8), std::ldexp(255.0f, 255 - 136));
    EXPECT_TRUE(std::isinf(largest_value(TexelFormat::rgba32f)));
    EXPECT_EQ(detail::lowest_value(TexelFormat::rgba16f), -65504);
    EXPECT_EQ(detail::lowest_value(TexelFormat::rgb9e5), 0);
}

TEST(Codecs, NamesRoundTrip) {
    for (const auto format :
         {TexelFormat::automatic, TexelFormat::rgba32f, TexelFormat::rgba16f, TexelFormat::rgbe8,
          TexelFormat::rgb9e5, TexelFormat::r11g11b10f, TexelFormat::unorm16, TexelFormat::unorm8})
        EXPECT_EQ(parse_texel_format(name(format)), format);
    for (const auto layout :
         {Layout::automatic, Layout::single, Layout::horizontal_cross, Layout::vertical_cross,
          Layout::horizontal_strip, Layout::vertical_strip, Layout::side_by_side,
          Layout::side_by_side_turned})
        EXPECT_EQ(parse_layout(name(layout)), layout);
    expect_error([] { (void)parse_texel_format("rgba8f"); }, Errc::usage, {"rgba8f", "rgba16f"});
    expect_error([] { (void)parse_layout("cross"); }, Errc::usage, {"cross", "vertical-cross"});
}

TEST(Codecs, RequestsThatAFormatCannotMeet) {
    const TemporaryFolder folder;
    const Image image(2, 2, 3);
    const auto write = [&](const char* file, TexelFormat format = TexelFormat::automatic) {
        return [&folder, &image, file, format] { write_image(folder / file, image, {format}); };
    };
    expect_error(write("a.xyz"), Errc::usage, {"a.xyz", "'.xyz'", ".hdr", ".png"});
    expect_error(write("a"), Errc::usage, {"''", ".hdr"});
    expect_error(write("a.jpg"), Errc::usage, {"JPEG", "not written"});
    expect_error(write("a.png", TexelFormat::rgba16f), Errc::usage, {"PNG", "rgba16f", "unorm16"});
    expect_error([&] { write_image(folder / "a.png", Image()); }, Errc::usage, {"empty"});

    Image bad(3, 2, 3);
    bad.at(1, 1)[2] = std::numeric_limits<float>::quiet_NaN();
    expect_error([&] { write_image(folder / "a.hdr", bad); }, Errc::cannot_write,
                 {"(1, 1)", "NaN"});
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Codecs, UpperCaseEndingsAreEndings) {
    const TemporaryFolder folder;
    write_image(folder / "A.HDR", Image(2, 2, 3));
    const FileContents contents = read_file(folder / "A.HDR");
    EXPECT_EQ(contents.format, "Radiance HDR");
    EXPECT_TRUE(contents.notes.empty());
}

TEST(Codecs, BytesTellTheFormatNotTheName) {
    const TemporaryFolder folder;
    write_image(folder / "a.pfm", Image(2, 2, 3));
    fs::rename(folder / "a.pfm", folder / "a.hdr");
    const FileContents contents = read_file(folder / "a.hdr");
    EXPECT_EQ(contents.format, "PFM");
    ASSERT_EQ(contents.notes.size(), 1u);
    EXPECT_NE(contents.notes[0].find("PFM"), std::string::npos);
}

TEST(Codecs, FailedWritesLeaveTheOldFile) {
    const TemporaryFolder folder;
    for (const char* file : {"a.hdr", "a.pfm", "a.png", "a.tif"}) {
        if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
        fs::create_symlink("/dev/full", folder / file);
        expect_error([&] { write_image(folder / file, Image(64, 64, 3)); }, Errc::cannot_write,
                     {file, "No space left on device"});
    }
    Image bad(4, 4, 3);
    bad.at(3, 3)[0] = std::numeric_limits<float>::quiet_NaN();
    write_image(folder / "good.tif", Image(4, 4, 3));
    const auto size = fs::file_size(folder / "good.tif");
    EXPECT_THROW(write_image(folder / "good.tif", bad), Error);
    EXPECT_EQ(fs::file_size(folder / "good.tif"), size);
}

// Bad input
// -----------------------------------------------------------------------------------------

void put(const fs::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

std::string get(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Codecs, FilesThatAreNoPictures) {
    const TemporaryFolder folder;
    put(folder / "empty.hdr", "");
    put(folder / "text.hdr", "hello, this is no picture at all\n");
    put(folder / "short.png", "\x89PN");
    expect_error([&] { (void)read_file(folder / "empty.hdr"); }, Errc::cannot_read,
                 {"empty.hdr", "is empty"});
    expect_error([&] { (void)read_file(folder / "text.hdr"); }, Errc::cannot_read,
                 {"text.hdr", "no format", "PNG"});
    expect_error([&] { (void)read_file(folder / "short.png"); }, Errc::cannot_read, {"no format"});
    expect_error([&] { (void)read_file(folder / "none.png"); }, Errc::cannot_read,
                 {"No such file"});
}

// Every prefix of a file is refused, in words, unless it holds all texels: TIFF ends with a remark.
TEST(Codecs, TruncatedFilesAreRefused) {
    const TemporaryFolder folder;
    for (const Form& form : forms()) {
        if (form.channels != 3) continue;
        for (const bool compress : {true, false}) {
            SCOPED_TRACE(describe(form));
            const fs::path path = folder / ("a" + form.ending);
            const Image image = exact_image(form, 20, 6);
            write_image(path, image, {form.format, compress});
            const std::string bytes = get(path);
            int read_count = 0;
            for (std::size_t size = 1; size < bytes.size(); size += 1 + bytes.size() / 97) {
                detail::InputFile part("part", std::as_bytes(std::span(bytes).first(size)));
                try {
                    expect_equal(detail::read_contents(part, {}).levels[0][0], image);
                    ++read_count;
                } catch (const Error& error) {
                    EXPECT_EQ(error.code(), Errc::cannot_read);
                    EXPECT_TRUE(std::string(error.what()).starts_with("part: ")) << error.what();
                }
            }
            EXPECT_LE(read_count, form.ending == ".tif" ? 4 : 0);
        }
    }
}

// A byte changed anywhere: a picture or an error, but nothing else, in whichever library.
TEST(Codecs, BrokenBytesAreSurvived) {
    const TemporaryFolder folder;
    for (const Form& form : forms()) {
        if (form.channels != 3) continue;
        SCOPED_TRACE(describe(form));
        const fs::path path = folder / ("a" + form.ending);
        write_image(path, exact_image(form, 20, 6), {form.format});
        const std::string bytes = get(path);
        ReadOptions options;
        options.memory_limit = 1 << 24;
        for (std::size_t at = 0; at < bytes.size(); at += 1 + bytes.size() / 199)
            for (const char change : {'\x01', '\x80', '\xff'}) {
                std::string broken = bytes;
                broken[at] = static_cast<char>(broken[at] ^ change);
                detail::InputFile file("broken", std::as_bytes(std::span(broken)));
                try {
                    (void)detail::read_contents(file, options);
                } catch (const Error&) {
                }
            }
    }
}

TEST(Codecs, ClaimsAreCheckedBeforeMemoryIsTaken) {
    const TemporaryFolder folder;
    const auto begin = std::chrono::steady_clock::now();
    put(folder / "a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100000 +X 100000\n");
    put(folder / "a.pfm", "PF\n100000 100000\n-1.0\n....");
    put(folder / "b.pfm", "PF\n-4 4\n-1.0\n....");
    put(folder / "c.pfm", "PF\n9999999999999999999 4\n-1.0\n....");
    put(folder / "d.pfm", "PF\n4194304 4194304\n-1.0\n....");
    // Width and height of a good PNG made 100000, with the checksum of its header block to match.
    write_image(folder / "a.png", Image(2, 2, 3));
    std::string png = get(folder / "a.png");
    png.replace(16, 8, std::string("\x00\x01\x86\xa0\x00\x01\x86\xa0", 8));
    std::uint32_t crc = 0xffffffff;
    for (std::size_t i = 12; i < 29; ++i) {
        crc ^= static_cast<unsigned char>(png[i]);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    for (int i = 0; i < 4; ++i) png[29 + i] = static_cast<char>(~crc >> (24 - 8 * i));
    put(folder / "a.png", png);

    for (const char* file : {"a.hdr", "a.pfm", "a.png"})
        expect_error([&] { (void)read_file(folder / file); }, Errc::cannot_read,
                     {file, "truncated", "100000 x 100000"});
    for (const char* file : {"b.pfm", "c.pfm", "d.pfm"})
        expect_error([&] { (void)read_file(folder / file); }, Errc::cannot_read, {file});
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
}

TEST(Codecs, TheMemoryLimitIsKept) {
    const TemporaryFolder folder;
    const Image image(100, 50, 3);
    ReadOptions enough, too_little;
    enough.memory_limit = 100 * 50 * 3 * 4;
    too_little.memory_limit = enough.memory_limit - 1;
    for (const char* file : {"a.hdr", "a.pfm", "a.png", "a.tif"}) {
        write_image(folder / file, image);
        EXPECT_NO_THROW((void)read_file(folder / file, enough)) << file;
        expect_error([&] { (void)read_file(folder / file, too_little); }, Errc::cannot_read,
                     {file, "memory", "100 x 50", "limit"});
    }
}

// Another program's view
// ---------------------------------------------------------------------------

bool oiiotool_runs() {
    return std::system("oiiotool --version >/dev/null 2>&1") == 0;
}

// OpenImageIO sees the same texels in our files, and we see the same in its files.
TEST(Codecs, AgreesWithOpenImageIO) {
    if (!oiiotool_runs()) GTEST_SKIP() << "oiiotool (Debian: openimageio-tools) is not installed";
    const TemporaryFolder folder;
    Image image(64, 32, 3);
    int i = 0;
    for (float& value : image.values())
        value = std::exp2(static_cast<float>(i++ * 37 % 2000) / 100 - 10);
    const std::string out = (folder / "").string();
    write_image(folder / "truth.pfm", image);
    for (const char* file : {"a.hdr", "a.tif", "b.tif"}) {
        const bool half = file[0] == 'b';
        write_image(folder / file, image, {half ? TexelFormat::rgba16f : TexelFormat::automatic});
        const Image ours = read_image(folder / file);
        write_image(folder / "ours.pfm", ours);
        // No tolerance: what the file holds is exact in both programs.
        const std::string same = "oiiotool -q " + out + file + " " + out +
                                 "ours.pfm --fail 0 --warn 0 --diff >/dev/null 2>&1";
        EXPECT_EQ(std::system(same.c_str()), 0) << file;

        const std::string convert = "oiiotool -q " + out + "truth.pfm -d " +
                                    (half ? "half" : "float") + " -o " + out + "theirs" +
                                    (file + 1) + " >/dev/null 2>&1";
        ASSERT_EQ(std::system(convert.c_str()), 0) << file;
        const Image theirs = read_image(folder / ("theirs" + std::string(file + 1)));
        // Half a unit in the last place of 8 bits when theirs rounds, a whole one when it
        // truncates.
        for (std::size_t v = 0; v < theirs.values().size(); v += 3) {
            const float* expected = &image.values()[v];
            const float largest = std::max({expected[0], expected[1], expected[2]});
            const float tolerance = file[2] == 'h' ? largest / 128 : half ? largest / 2048 : 0;
            for (std::size_t c = 0; c < 3; ++c)
                ASSERT_NEAR(theirs.values()[v + c], expected[c], tolerance) << file << " " << v;
        }
    }
}

TEST(Codecs, RealPanoramasSurvive) {
    for (const char* file : {"hdri/venice.hdr", "hdri/studio.hdr"}) {
        const auto path = shared_file(file);
        if (!path)
            GTEST_SKIP() << "the shared panoramas are not here; EveryFormatGivesBackWhatItHolds "
                            "is the same test on generated pictures";
        const TemporaryFolder folder;
        const Image image = read_image(*path);
        write_image(folder / "a.hdr", image);
        write_image(folder / "a.tif", image);
        expect_equal(read_image(folder / "a.hdr"), image);
        expect_equal(read_image(folder / "a.tif"), image);
    }
}

}  // namespace
}  // namespace mirrorball
