// PNG, JPEG and TIFF in the forms that we read but do not write, made here by the libraries
// themselves.
#include <png.h>
#include <tiffio.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>

#include <jpeglib.h>

#include "io/codec.h"
#include "io_test_support.h"
#include "support.h"

namespace mirrorball {
namespace {

namespace fs = std::filesystem;

struct FileCloser {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using FilePointer = std::unique_ptr<std::FILE, FileCloser>;

FilePointer open_file(const fs::path& path) {
    return FilePointer(std::fopen(path.c_str(), "wb"));
}

float from_code(int code, int most = 255) {
    return detail::srgb_to_linear(static_cast<float>(static_cast<double>(code) / most));
}

// PNG ---------------------------------------------------------------------------------------------

struct PngForm {
    int colour_type, depth, width, height;
    bool interlaced = false;
    std::vector<png_color> palette = {};
    std::vector<png_byte> palette_alpha = {};
    double gamma = 0;
};

void write_png(const fs::path& path, const PngForm& form, std::vector<png_byte> bytes) {
    const FilePointer file = open_file(path);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file.get());
    png_set_IHDR(png, info, form.width, form.height, form.depth, form.colour_type,
                 form.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (!form.palette.empty())
        png_set_PLTE(png, info, form.palette.data(), static_cast<int>(form.palette.size()));
    if (!form.palette_alpha.empty())
        png_set_tRNS(png, info, form.palette_alpha.data(),
                     static_cast<int>(form.palette_alpha.size()), nullptr);
    if (form.gamma > 0) png_set_gAMA(png, info, form.gamma);
    png_write_info(png, info);
    std::vector<png_bytep> rows;
    const std::size_t row_bytes = png_get_rowbytes(png, info);
    for (int y = 0; y < form.height; ++y) rows.push_back(&bytes[y * row_bytes]);
    png_write_image(png, rows.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
}

TEST(Png, PalettesBecomeColours) {
    const TemporaryFolder folder;
    PngForm form{PNG_COLOR_TYPE_PALETTE, 2, 4, 1};
    form.palette = {{10, 20, 30}, {40, 50, 60}, {70, 80, 90}, {255, 0, 255}};
    write_png(folder / "a.png", form, {0b00'01'10'11});
    Image image = read_image(folder / "a.png");
    ASSERT_EQ(image.channels(), 3);
    EXPECT_EQ(image.rgb(0, 0), Vec3f(from_code(10), from_code(20), from_code(30)));
    EXPECT_EQ(image.rgb(3, 0), Vec3f(1, 0, 1));

    form.palette_alpha = {0, 51};
    write_png(folder / "b.png", form, {0b00'01'10'11});
    image = read_image(folder / "b.png");
    ASSERT_EQ(image.channels(), 4);
    EXPECT_EQ(image.at(0, 0)[3], 0);
    EXPECT_EQ(image.at(1, 0)[3], 0.2f);  // alpha has no curve
    EXPECT_EQ(image.at(2, 0)[3], 1);
}

TEST(Png, GreyOfOneBit) {
    const TemporaryFolder folder;
    write_png(folder / "a.png", {PNG_COLOR_TYPE_GRAY, 1, 3, 2}, {0b01000000, 0b10100000});
    const Image image = read_image(folder / "a.png");
    ASSERT_EQ(image.channels(), 1);
    EXPECT_EQ(std::vector<float>(image.values().begin(), image.values().end()),
              (std::vector<float>{0, 1, 0, 1, 0, 1}));
}

TEST(Png, InterlacedPicturesAreTheSame) {
    const TemporaryFolder folder;
    for (const int depth : {8, 16}) {
        std::vector<png_byte> bytes(static_cast<std::size_t>(13 * 11 * 3 * depth / 8));
        for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<png_byte>(i * 31);
        PngForm form{PNG_COLOR_TYPE_RGB, depth, 13, 11};
        write_png(folder / "plain.png", form, bytes);
        form.interlaced = true;
        write_png(folder / "interlaced.png", form, bytes);
        expect_equal(read_image(folder / "interlaced.png"), read_image(folder / "plain.png"));
    }
}

TEST(Png, SixteenBitsComeInTheRightOrder) {
    const TemporaryFolder folder;
    write_png(folder / "a.png", {PNG_COLOR_TYPE_GRAY, 16, 1, 1}, {0x12, 0x34});
    EXPECT_EQ(read_image(folder / "a.png").at(0, 0)[0], from_code(0x1234, 65535));
}

TEST(Png, AnotherGammaIsNoted) {
    const TemporaryFolder folder;
    PngForm form{PNG_COLOR_TYPE_GRAY, 8, 1, 1};
    form.gamma = 1.0;
    write_png(folder / "a.png", form, {128});
    const FileContents contents = read_file(folder / "a.png");
    EXPECT_EQ(contents.levels[0][0].at(0, 0)[0], from_code(128));
    EXPECT_EQ(contents.notes.size(), 2u);
}

// JPEG --------------------------------------------------------------------------------------------

// `exif_orientation` 0: none.
void write_jpeg(const fs::path& path, J_COLOR_SPACE colours, int width, int height,
                std::vector<JSAMPLE> samples, int exif_orientation = 0, bool progressive = false) {
    const FilePointer file = open_file(path);
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_stdio_dest(&jpeg, file.get());
    jpeg.image_width = width;
    jpeg.image_height = height;
    jpeg.input_components = colours == JCS_GRAYSCALE ? 1 : colours == JCS_RGB ? 3 : 4;
    jpeg.in_color_space = colours;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 100, TRUE);
    if (progressive) jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    if (exif_orientation > 0) {
        // TIFF header, one entry: tag 0x0112, type SHORT, one of them.
        std::string exif("Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0 \0\0\0\0\0\0",
                         32);
        exif[25] = static_cast<char>(exif_orientation);
        jpeg_write_marker(&jpeg, JPEG_APP0 + 1, reinterpret_cast<const JOCTET*>(exif.data()),
                          static_cast<unsigned>(exif.size()));
    }
    const std::size_t row_size = static_cast<std::size_t>(width) * jpeg.input_components;
    for (int y = 0; y < height; ++y) {
        JSAMPROW row = &samples[y * row_size];
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
}

// A uniform picture comes through JPEG within the rounding of its colour transform, a code or two.
void expect_code(float value, int code) {
    EXPECT_GE(value, from_code(std::max(code - 2, 0)));
    EXPECT_LE(value, from_code(std::min(code + 2, 255)));
}

TEST(Jpeg, ReadsGreyColourAndInks) {
    const TemporaryFolder folder;
    write_jpeg(folder / "grey.jpg", JCS_GRAYSCALE, 9, 5, std::vector<JSAMPLE>(45, 100));
    const Image grey = read_image(folder / "grey.jpg");
    ASSERT_EQ(grey.channels(), 1);
    expect_code(grey.at(8, 4)[0], 100);

    for (const bool progressive : {false, true}) {
        std::vector<JSAMPLE> rgb;
        for (int i = 0; i < 45; ++i) rgb.insert(rgb.end(), {200, 100, 50});
        write_jpeg(folder / "rgb.jpg", JCS_RGB, 9, 5, rgb, 0, progressive);
        const FileContents contents = read_file(folder / "rgb.jpg");
        EXPECT_EQ(contents.format, "JPEG");
        const Image& image = contents.levels[0][0];
        ASSERT_EQ(image.channels(), 3);
        for (int c = 0; c < 3; ++c) expect_code(image.at(4, 4)[c], std::array{200, 100, 50}[c]);
    }

    // libjpeg marks CMYK as Adobe's, whose inks are upside down: 255 lets all light through.
    std::vector<JSAMPLE> cmyk;
    for (int i = 0; i < 45; ++i) cmyk.insert(cmyk.end(), {255, 128, 0, 128});
    write_jpeg(folder / "cmyk.jpg", JCS_CMYK, 9, 5, cmyk);
    const FileContents inks = read_file(folder / "cmyk.jpg");
    ASSERT_EQ(inks.levels[0][0].channels(), 3);
    for (int c = 0; c < 3; ++c)
        expect_code(inks.levels[0][0].at(0, 0)[c], std::array{128, 64, 0}[c]);
    EXPECT_EQ(inks.notes.size(), 2u);
}

TEST(Jpeg, IsTurnedUprightByItsExif) {
    const TemporaryFolder folder;
    // Blocks of 8 x 8 so that corners stay apart: white at the top left of what is stored.
    std::vector<JSAMPLE> samples(24 * 16, 0);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) samples[y * 24 + x] = 255;
    // By number: the corner of the seen picture that the stored top left comes to. EXIF 2.3, 4.6.4.
    const std::vector<std::array<int, 3>> cases{{1, 0, 0}, {2, 1, 0}, {3, 1, 1}, {4, 0, 1},
                                                {5, 0, 0}, {6, 1, 0}, {7, 1, 1}, {8, 0, 1}};
    for (const auto& [number, right, bottom] : cases) {
        write_jpeg(folder / "a.jpg", JCS_GRAYSCALE, 24, 16, samples, number);
        const FileContents contents = read_file(folder / "a.jpg");
        const Image& image = contents.levels[0][0];
        EXPECT_EQ(image.width(), number < 5 ? 24 : 16);
        for (const int x : {0, 1})
            for (const int y : {0, 1}) {
                const float corner = image.at(x * (image.width() - 1), y * (image.height() - 1))[0];
                EXPECT_EQ(corner > 0.5f, x == right && y == bottom)
                    << number << " " << x << " " << y;
            }
        EXPECT_EQ(contents.notes.size(), number == 1 ? 1u : 2u);
    }
}

TEST(Jpeg, TruncatedFilesAreRefused) {
    const TemporaryFolder folder;
    std::vector<JSAMPLE> samples(64 * 64);
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<JSAMPLE>(i * i / 7);
    for (const bool progressive : {false, true}) {
        write_jpeg(folder / "a.jpg", JCS_GRAYSCALE, 64, 64, samples, 0, progressive);
        const auto size = fs::file_size(folder / "a.jpg");
        for (auto kept = size - 2; kept > 3; kept -= 1 + kept / 20) {
            fs::resize_file(folder / "a.jpg", kept);
            expect_error([&] { (void)read_file(folder / "a.jpg"); }, Errc::cannot_read, {"a.jpg"});
        }
    }
}

// TIFF --------------------------------------------------------------------------------------------

struct TiffForm {
    int bits, sample_format, channels;
    bool tiled, separate;
    int photometric = PHOTOMETRIC_RGB, compression = COMPRESSION_NONE, orientation = 0;
    const char* mode = "w";  // "wb": big endian
};

// Sample i (in the order of a contiguous picture) is sample(i), of type T.
template <class T, class F>
void write_tiff(const fs::path& path, const TiffForm& form, int width, int height,
                const F& sample) {
    TIFF* tiff = TIFFOpen(path.c_str(), form.mode);
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, form.channels);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, form.bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, form.sample_format);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, form.photometric);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, form.compression);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG,
                 form.separate ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
    if (form.orientation > 0) TIFFSetField(tiff, TIFFTAG_ORIENTATION, form.orientation);
    const int planes = form.separate ? form.channels : 1;
    const int together = form.channels / planes;
    const int tile = 16;
    if (form.tiled) {
        TIFFSetField(tiff, TIFFTAG_TILEWIDTH, tile);
        TIFFSetField(tiff, TIFFTAG_TILELENGTH, tile);
    } else {
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 3);
    }
    for (int plane = 0; plane < planes; ++plane) {
        const auto at = [&](int x, int y, int c) {
            return static_cast<T>(sample((y * width + x) * form.channels + plane + c));
        };
        if (form.tiled) {
            for (int top = 0; top < height; top += tile)
                for (int left = 0; left < width; left += tile) {
                    std::vector<T> data(tile * tile * together);
                    for (int y = 0; y < tile && top + y < height; ++y)
                        for (int x = 0; x < tile && left + x < width; ++x)
                            for (int c = 0; c < together; ++c)
                                data[(y * tile + x) * together + c] = at(left + x, top + y, c);
                    TIFFWriteTile(tiff, data.data(), left, top, 0,
                                  static_cast<std::uint16_t>(plane));
                }
        } else {
            for (int y = 0; y < height; ++y) {
                std::vector<T> row(width * together);
                for (int i = 0; i < width * together; ++i)
                    row[i] = at(i / together, y, i % together);
                TIFFWriteScanline(tiff, row.data(), y, static_cast<std::uint16_t>(plane));
            }
        }
    }
    TIFFClose(tiff);
}

TEST(Tiff, StripsAndTilesTogetherAndInPlanes) {
    const TemporaryFolder folder;
    const int width = 37, height = 21;
    for (const bool tiled : {false, true})
        for (const bool separate : {false, true})
            for (const int channels : {1, 3, 4})
                for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW})
                    for (const char* mode : {"w", "wb", "w8"}) {
                        SCOPED_TRACE(::testing::Message() << tiled << separate << channels << mode);
                        TiffForm form{32, SAMPLEFORMAT_IEEEFP, channels, tiled, separate};
                        form.photometric = channels < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB;
                        form.compression = compression;
                        form.mode = mode;
                        write_tiff<float>(folder / "a.tif", form, width, height,
                                          [](int i) { return i - 100; });
                        const Image image = read_image(folder / "a.tif");
                        ASSERT_EQ(image.width(), width);
                        ASSERT_EQ(image.height(), height);
                        ASSERT_EQ(image.channels(), channels);
                        for (std::size_t i = 0; i < image.values().size(); ++i)
                            ASSERT_EQ(image.values()[i], static_cast<int>(i) - 100);
                    }
}

TEST(Tiff, AlphaHasNoCurve) {
    const TemporaryFolder folder;
    for (const bool separate : {false, true}) {
        write_tiff<std::uint8_t>(folder / "a.tif", {8, SAMPLEFORMAT_UINT, 4, false, separate}, 1, 1,
                                 [](int) { return 51; });
        const Image image = read_image(folder / "a.tif");
        EXPECT_EQ(image.at(0, 0)[2], from_code(51));
        EXPECT_EQ(image.at(0, 0)[3], 0.2f);
    }
}

TEST(Tiff, DoublesAndInvertedGrey) {
    const TemporaryFolder folder;
    TiffForm form{64, SAMPLEFORMAT_IEEEFP, 1, false, false, PHOTOMETRIC_MINISBLACK};
    write_tiff<double>(folder / "a.tif", form, 2, 1, [](int i) { return i + 0.1; });
    EXPECT_EQ(read_image(folder / "a.tif").at(1, 0)[0], 1.1f);

    form = {16, SAMPLEFORMAT_UINT, 1, false, false, PHOTOMETRIC_MINISWHITE};
    write_tiff<std::uint16_t>(folder / "b.tif", form, 2, 1, [](int i) { return i * 65535; });
    EXPECT_EQ(read_image(folder / "b.tif").at(0, 0)[0], 1);
    EXPECT_EQ(read_image(folder / "b.tif").at(1, 0)[0], 0);
}

TEST(Tiff, IsTurnedUpright) {
    const TemporaryFolder folder;
    TiffForm form{32, SAMPLEFORMAT_IEEEFP, 1, false, false, PHOTOMETRIC_MINISBLACK};
    form.orientation = ORIENTATION_RIGHTTOP;  // stored rows are columns, from the right
    write_tiff<float>(folder / "a.tif", form, 3, 2, [](int i) { return i + 1; });
    const Image image = read_image(folder / "a.tif");
    ASSERT_EQ(image.width(), 2);
    EXPECT_EQ(std::vector<float>(image.values().begin(), image.values().end()),
              (std::vector<float>{4, 1, 5, 2, 6, 3}));
}

// A directory by hand, since libtiff does not write sizes that it does not believe.
std::string tiff_that_claims(std::uint32_t width, std::uint32_t height, int compression) {
    const std::vector<std::array<std::uint32_t, 3>> entries{
        // tag, type (3: 16 bits, 4: 32 bits), value
        {TIFFTAG_IMAGEWIDTH, 4, width},
        {TIFFTAG_IMAGELENGTH, 4, height},
        {TIFFTAG_BITSPERSAMPLE, 3, 32},
        {TIFFTAG_COMPRESSION, 3, std::uint32_t(compression)},
        {TIFFTAG_PHOTOMETRIC, 3, PHOTOMETRIC_MINISBLACK},
        {TIFFTAG_STRIPOFFSETS, 4, 8},
        {TIFFTAG_SAMPLESPERPIXEL, 3, 1},
        {TIFFTAG_ROWSPERSTRIP, 4, height},
        {TIFFTAG_STRIPBYTECOUNTS, 4, 16},
        {TIFFTAG_SAMPLEFORMAT, 3, SAMPLEFORMAT_IEEEFP}};
    std::string file("II*\0\x08\0\0\0", 8);
    const auto append = [&](std::uint32_t value, int bytes) {
        for (int i = 0; i < bytes; ++i) file.push_back(static_cast<char>(value >> 8 * i));
    };
    append(static_cast<std::uint32_t>(entries.size()), 2);
    for (const auto& [tag, type, value] : entries) {
        append(tag, 2);
        append(type, 2);
        append(1, 4);
        append(value, 4);
    }
    append(0, 4);
    return file;
}

TEST(Tiff, WildClaimsAreRefused) {
    for (const int compression : {COMPRESSION_NONE, COMPRESSION_ADOBE_DEFLATE}) {
        const auto claim = [&](std::uint32_t width, std::uint32_t height) {
            return [=] {
                const std::string bytes = tiff_that_claims(width, height, compression);
                detail::InputFile file("a.tif", std::as_bytes(std::span(bytes)));
                (void)detail::read_contents(file, {});
            };
        };
        expect_error(claim(100'000, 100'000), Errc::cannot_read, {"truncated", "100000 x 100000"});
        expect_error(claim(4, 0), Errc::cannot_read, {"a.tif"});
        expect_error(claim(4'000'000, 1), Errc::cannot_read, {"claims 4000000 x 1"});
    }
}

TEST(Tiff, WhatIsNotReadIsNamed) {
    const TemporaryFolder folder;
    const auto refused = [&](const TiffForm& form, std::initializer_list<std::string> words) {
        write_tiff<std::uint32_t>(folder / "a.tif", form, 4, 4, [](int) { return 0; });
        expect_error([&] { (void)read_file(folder / "a.tif"); }, Errc::unsupported, words);
    };
    refused({32, SAMPLEFORMAT_UINT, 3, false, false}, {"a.tif", "32 bits", "expected"});
    refused({16, SAMPLEFORMAT_INT, 3, false, false}, {"16 bits", "format 2"});
    refused({8, SAMPLEFORMAT_UINT, 5, false, false}, {"5 channels", "3 to 4"});
    refused({8, SAMPLEFORMAT_UINT, 4, false, false, PHOTOMETRIC_SEPARATED},
            {"kind 5", "grey or RGB"});
    refused({8, SAMPLEFORMAT_UINT, 3, false, false, PHOTOMETRIC_CIELAB}, {"kind 8", "grey or RGB"});
}

// Numbers that are no light -----------------------------------------------------------------------

TEST(Transfer, LinearIntegersAreTheNumbersThemselves) {
    const TemporaryFolder folder;
    Image image(5, 3, 3);
    for (std::size_t i = 0; i < image.values().size(); ++i)
        image.values()[i] = static_cast<float>(i) / 45;
    for (const char* name : {"a.png", "a.tif"})
        for (const auto& [format, most] :
             {std::pair{TexelFormat::unorm8, 255.0}, {TexelFormat::unorm16, 65535.0}}) {
            write_image(folder / name, image, {.format = format, .transfer = Transfer::linear});
            const Image back = read_image(folder / name, {.transfer = Transfer::linear});
            for (std::size_t i = 0; i < image.values().size(); ++i)
                EXPECT_NEAR(back.values()[i], image.values()[i], 0.501 / most) << name;
            // What is not asked for stays sRGB, and is another file.
            write_image(folder / name, image, {.format = format});
            EXPECT_NEAR(read_image(folder / name).values()[9], image.values()[9], 2 / most);
            EXPECT_GT(read_image(folder / name, {.transfer = Transfer::linear}).values()[9],
                      image.values()[9] + 0.2f);
        }
}

}  // namespace
}  // namespace mirrorball
