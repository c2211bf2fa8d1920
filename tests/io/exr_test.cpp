// OpenEXR: our files back, files made by the library itself with what else the format has, and
// damage.
#include <cmath>
#include <functional>

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTiledInputFile.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include "container_support.h"
#include "exr_support.h"

namespace mirrorball {
namespace {

using detail::kExr;
using Imath::Box2i;
using Imath::V2i;

const Axes kOpenExrEquirect = axes_preset("openexr", Projection::equirect);

WriteOptions with_format(TexelFormat format) {
    WriteOptions options;
    options.format = format;
    return options;
}

// Pictures
// -----------------------------------------------------------------------------------------

TEST(Exr, PicturesComeBackToTheBit) {
    for (const TexelFormat format : {TexelFormat::rgba16f, TexelFormat::rgba32f})
        for (const bool compress : {false, true})
            for (const int channels : {1, 2, 3, 4}) {
                FileContents contents = plain(exact_image(7, 5, channels, 0, 0));
                if (channels == 2) contents.levels[0][0].at(3, 3)[1] = 0.25f;
                WriteOptions options = with_format(format);
                options.compress = compress;
                const FileContents back = read_back(kExr, written(kExr, contents, options));
                expect_same_bits(back, contents);
                EXPECT_EQ(back.stored, format);
                EXPECT_FALSE(back.projection);
                EXPECT_TRUE(back.notes.empty());
            }
}

TEST(Exr, LevelsComeBackToTheBit) {
    for (const int level_count : {2, 3, 5})
        for (const auto& [width, height] :
             {std::pair{16, 8}, std::pair{13, 9}, std::pair{200, 100}}) {
            const FileContents contents =
                exact_contents(1, width, height, std::min(level_count, 4));
            expect_same_bits(read_back(kExr, written(kExr, contents)), contents);
        }
}

TEST(Exr, MetadataComesBack) {
    FileContents contents = exact_contents(1, 4, 2, 1);
    contents.metadata = {{"mirrorball.axes", "+x+y-z"},
                         {"comments", "two\nlines, ä"},
                         {"a name that is longer than thirty-one characters", "kept"},
                         {"channels", "not ours to set"},
                         {"", "no name"}};
    const FileContents back = read_back(kExr, written(kExr, contents));
    EXPECT_EQ(back.metadata.at("mirrorball.axes"), "+x+y-z");
    EXPECT_EQ(back.metadata.at("comments"), "two\nlines, ä");
    EXPECT_EQ(back.metadata.at("a name that is longer than thirty-one characters"), "kept");
    EXPECT_FALSE(back.metadata.contains("channels"));
}

TEST(Exr, SameContentsSameBytes) {
    const FileContents contents = exact_contents(6, 16, 16, 3);
    EXPECT_EQ(written(kExr, contents), written(kExr, contents));
}

// Environments
// -------------------------------------------------------------------------------------

// Each face a colour of its own with a darker top left quarter: order and orientation show.
FileContents labelled_cube(int n) {
    FileContents contents;
    contents.projection = Projection::cube;
    auto& faces = contents.levels.emplace_back();
    for (int face = 0; face < 6; ++face) {
        Image& image = faces.emplace_back(n, n, 3);
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const bool corner = x < n / 2 && y < n / 2;
                const float colour = static_cast<float>(face + 1) * (corner ? 0.5f : 1.0f);
                image.set_rgb(x, y, {colour, colour, colour});
            }
    }
    return contents;
}

TEST(ExrEnvironment, FacesOfACubeKeepTheirPlaceAndTheirTop) {
    const FileContents contents = labelled_cube(16);
    const FileContents back = read_back(kExr, written(kExr, contents));
    EXPECT_EQ(back.projection, Projection::cube);
    EXPECT_EQ(back.axes, axes_preset("openexr", Projection::cube));
    ASSERT_EQ(back.levels[0].size(), 6u);
    for (int face = 0; face < 6; ++face)
        for (const auto& [x, y] : {std::pair{4, 4}, std::pair{12, 4}, std::pair{4, 12}})
            EXPECT_EQ(back.levels[0][face].rgb(x, y), contents.levels[0][face].rgb(x, y));
}

TEST(ExrEnvironment, ACubeIsAStripAsOpenExrHasIt) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "cube.exr";
    const Bytes bytes = written(kExr, labelled_cube(16));
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
    Imf::InputFile file(path.c_str(), 0);
    ASSERT_TRUE(Imf::hasEnvmap(file.header()));
    EXPECT_EQ(Imf::envmap(file.header()), Imf::ENVMAP_CUBE);
    EXPECT_EQ(file.header().dataWindow(), Box2i({0, 0}, {15, 95}));
    std::vector<float> red(16 * 96);
    Imf::FrameBuffer buffer;
    buffer.insert("R", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(red.data()), 4, 64));
    file.setFrameBuffer(buffer);
    file.readPixels(0, 95);
    // Fifth in OpenEXR's strip is its +Z, which is our -Z: our world's z is the cube's negated.
    const float expected[6] = {1, 2, 3, 4, 6, 5};
    for (int place = 0; place < 6; ++place) {
        EXPECT_EQ(red[(16 * place + 12) * 16 + 12], expected[place]);
        EXPECT_EQ(red[(16 * place + 3) * 16 + 3], expected[place] / 2);
    }
}

TEST(ExrEnvironment, LevelsOfACubeComeBack) {
    FileContents contents;
    contents.projection = Projection::cube;
    for (int level = 0; level < 4; ++level) {
        auto& faces = contents.levels.emplace_back();
        for (int face = 0; face < 6; ++face) {
            Image& image = faces.emplace_back(16 >> level, 16 >> level, 3);
            for (float& value : image.values()) value = static_cast<float>(1 + level);
        }
    }
    const FileContents back = read_back(kExr, written(kExr, contents));
    expect_same_bits(back, contents);  // constants survive the grids
    EXPECT_EQ(back.projection, Projection::cube);
}

TEST(ExrEnvironment, LevelsOfAnOddCubeAreRefusedForKtx2) {
    EXPECT_NE(write_refusal(kExr, exact_contents(6, 12, 12, 4)).find("KTX2"), std::string::npos);
    EXPECT_NO_THROW(written(kExr, exact_contents(6, 12, 12, 3)));
}

TEST(ExrEnvironment, AnEquirectInOpenExrsFrameIsALatLong) {
    FileContents contents = plain(Image(64, 32, 3));
    contents.projection = Projection::equirect;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) {
            const float wave = 2 + std::cos(static_cast<float>(x) / 32 * 3.14159265f);
            contents.levels[0][0].set_rgb(x, y, {wave, static_cast<float>(y), 1});
        }
    contents.axes = kOpenExrEquirect;
    const FileContents back =
        read_back(kExr, written(kExr, contents, with_format(TexelFormat::rgba32f)));
    EXPECT_EQ(back.projection, Projection::equirect);
    EXPECT_EQ(back.axes, kOpenExrEquirect);
    for (int y = 4; y < 28; ++y)
        for (int x = 0; x < 64; ++x)
            EXPECT_TRUE(back.levels[0][0].rgb(x, y).equalWithAbsError(
                contents.levels[0][0].rgb(x, y), 2e-2f));

    contents.axes = Axes{};  // in any other frame it is a picture, and keeps its bits
    const FileContents plain_back =
        read_back(kExr, written(kExr, contents, with_format(TexelFormat::rgba32f)));
    EXPECT_FALSE(plain_back.projection);
    expect_same_bits(plain_back, contents);
}

TEST(ExrEnvironment, AnAttributeThatDoesNotFitIsLeftAside) {
    for (const Imf::Envmap kind : {Imf::ENVMAP_CUBE, Imf::ENVMAP_LATLONG}) {
        const Image image = exact_image(6, 5, 3, 0, 0);
        const FileContents back = read_back(
            kExr, made(image, {"R", "G", "B"}, [&](Imf::Header& h) { Imf::addEnvmap(h, kind); }));
        expect_same_bits(back, plain(image));
        EXPECT_FALSE(back.projection);
        ASSERT_EQ(back.notes.size(), 1u);
    }
}

// Reading what others write
// ------------------------------------------------------------------------

TEST(ExrRead, EveryCompressionThatLosesNothing) {
    const Image image = exact_image(40, 37, 3, 0, 0);
    for (const Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,
          Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION}) {
        for (const bool tiled : {false, true}) {
            const Bytes bytes = made(image, {"R", "G", "B"}, [&](Imf::Header& h) {
                h.compression() = compression;
                if (tiled) h.setTileDescription(Imf::TileDescription(16, 8));
            });
            expect_same_bits(read_back(kExr, bytes), plain(image));
        }
    }
}

TEST(ExrRead, LossyCompressionsAreRead) {
    const Image image = exact_image(40, 300, 3, 0, 0);
    for (const Imf::Compression compression : {Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION,
                                               Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION}) {
        const FileContents back = read_back(kExr, made(image, {"R", "G", "B"}, [&](Imf::Header& h) {
                                                h.compression() = compression;
                                            }));
        EXPECT_EQ(back.levels[0][0].height(), 300);
    }
}

// A strong compression of nothing must not look like a lie about the size.
TEST(ExrRead, BlackCompressesToNearlyNothing) {
    const Image black(1024, 512, 3);
    for (int i = 0; i < Imf::NUM_COMPRESSION_METHODS; ++i) {
        const Bytes bytes = made(black, {"R", "G", "B"}, [&](Imf::Header& h) {
            h.compression() = static_cast<Imf::Compression>(i);
        });
        EXPECT_EQ(read_back(kExr, bytes).levels[0][0].width(), 1024) << i;
    }
}

TEST(ExrRead, LuminanceAndLayers) {
    const Image grey = exact_image(5, 4, 1, 0, 0);
    expect_same_bits(read_back(kExr, made(grey, {"Y"})), plain(grey));
    const Image image = exact_image(5, 4, 3, 0, 0);
    const FileContents layered = read_back(kExr, made(image, {"left.R", "left.G", "left.B"}));
    expect_same_bits(layered, plain(image));
    EXPECT_EQ(layered.notes.size(), 1u);
}

TEST(ExrRead, TheDisplayWindowIsThePicture) {
    const Image image = exact_image(6, 4, 3, 0, 0);
    const FileContents back = read_back(kExr, made(image, {"R", "G", "B"}, [](Imf::Header& h) {
                                            h.dataWindow() = Box2i({-2, 3}, {3, 6});
                                            h.displayWindow() = Box2i({0, 0}, {7, 5});
                                        }));
    const Image& picture = back.levels[0][0];
    ASSERT_EQ(picture.width(), 8);
    ASSERT_EQ(picture.height(), 6);
    EXPECT_EQ(back.notes.size(), 1u);
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 8; ++x) {
            const bool stored = x <= 3 && y >= 3;
            EXPECT_EQ(picture.rgb(x, y), stored ? image.rgb(x + 2, y - 3) : Vec3f(0, 0, 0));
        }
}

TEST(ExrRead, OtherPrimariesAreNoted) {
    const Bytes bytes = made(exact_image(2, 2, 3, 0, 0), {"R", "G", "B"}, [](Imf::Header& h) {
        Imf::addChromaticities(h,
                               Imf::Chromaticities({0.7347f, 0.2653f}, {0, 1}, {0.0001f, -0.077f},
                                                   {0.32168f, 0.33767f}));  // ACES
    });
    ASSERT_EQ(read_back(kExr, bytes).notes.size(), 1u);
    EXPECT_NE(read_back(kExr, bytes).notes[0].find("0.7347"), std::string::npos);
}

TEST(ExrRead, TheFirstPartWithAPicture) {
    const TemporaryFolder folder;
    const std::string path = folder / "parts.exr";
    const Image image = exact_image(4, 3, 3, 0, 0);
    {
        std::vector<Imf::Header> headers(2, Imf::Header(4, 3));
        headers[0].channels().insert("Z", Imf::Channel(Imf::FLOAT));
        for (const char* name : {"R", "G", "B"})
            headers[1].channels().insert(name, Imf::Channel(Imf::FLOAT));
        for (int i = 0; i < 2; ++i) {
            headers[i].setName(i == 0 ? "depth" : "beauty");
            headers[i].setType(Imf::SCANLINEIMAGE);
        }
        Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 2, false, 0);
        for (int i = 0; i < 2; ++i) {
            Imf::OutputPart part(file, i);
            Imf::FrameBuffer buffer;
            const char* names[] = {"R", "G", "B"};
            for (int c = 0; c < (i == 0 ? 1 : 3); ++c)
                buffer.insert(
                    i == 0 ? "Z" : names[c],
                    Imf::Slice::Make(Imf::FLOAT, image.values().data() + c, Box2i({0, 0}, {3, 2}),
                                     std::size_t{12}, std::size_t{48}));
            part.setFrameBuffer(buffer);
            part.writePixels(3);
        }
    }
    const FileContents back = read_back(kExr, file_bytes(path));
    expect_same_bits(back, plain(image));
    ASSERT_EQ(back.notes.size(), 1u);
    EXPECT_NE(back.notes[0].find("2 parts"), std::string::npos);
}

// Refusals
// ------------------------------------------------------------------------------------------

TEST(ExrRefusal, NamesWhatWasFound) {
    const Image image = exact_image(4, 4, 3, 0, 0);
    EXPECT_NE(refusal(kExr, made(image, {"Z", "N", "U"})).find("N, U, Z"), std::string::npos);
    EXPECT_NE(
        refusal(kExr, made(image, {"R", "G", "B"},
                           [](Imf::Header& h) {
                               h.setTileDescription(Imf::TileDescription(4, 4, Imf::RIPMAP_LEVELS));
                           }))
            .find("ripmap"),
        std::string::npos);
    EXPECT_NE(write_refusal(kExr, exact_contents(2, 4, 4, 1)).find("2 faces"), std::string::npos);
}

TEST(ExrRefusal, DeepPixels) {
    const TemporaryFolder folder;
    const std::string path = folder / "deep.exr";
    {
        Imf::Header header(2, 2);
        header.setType(Imf::DEEPSCANLINE);
        header.compression() = Imf::ZIPS_COMPRESSION;
        for (const char* name : {"R", "G", "B"})
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        Imf::DeepScanLineOutputFile file(path.c_str(), header, 0);
    }
    EXPECT_NE(refusal(kExr, file_bytes(path)).find("deep"), std::string::npos);
}

// The data window's attribute: "dataWindow", "box2i", 16 bytes of size, then its corners.
Bytes with_data_window(Bytes bytes, std::array<std::int32_t, 4> corners) {
    const std::string_view head("dataWindow\0box2i\0\x10\0\0\0", 21);
    const auto at = std::search(bytes.begin(), bytes.end(), head.begin(), head.end(),
                                [](std::byte x, char y) { return x == std::byte(y); });
    EXPECT_NE(at, bytes.end());
    std::memcpy(&*at + head.size(), corners.data(), sizeof corners);
    return bytes;
}

TEST(ExrRefusal, AClaimIsHeldAgainstTheFile) {
    const Image image = exact_image(4, 4, 3, 0, 0);
    for (int i = 0; i < Imf::NUM_COMPRESSION_METHODS; ++i) {
        const Bytes bytes = made(image, {"R", "G", "B"}, [&](Imf::Header& h) {
            h.compression() = static_cast<Imf::Compression>(i);
        });
        for (const auto& corners : {std::array{0, 0, 99999, 99999}, std::array{0, 0, 99999999, 3},
                                    std::array{0, 0, 3, 99999999}, std::array{3, 3, 0, 0},
                                    std::array{-2000000000, 0, 2000000000, 3}})
            EXPECT_FALSE(refusal(kExr, with_data_window(bytes, corners)).empty());
    }
}

TEST(ExrDamage, EveryTruncationIsRefused) {
    expect_truncations_refused(kExr, written(kExr, exact_contents(1, 4, 4, 1)));
    expect_truncations_refused(kExr, written(kExr, exact_contents(6, 2, 2, 2)));
}

TEST(ExrDamage, EveryByteMayBeWrong) {
    expect_damage_survived(kExr, written(kExr, exact_contents(1, 4, 4, 1)));
    expect_damage_survived(kExr, written(kExr, exact_contents(6, 2, 2, 2)));
}

TEST(ExrProgress, IsToldWhileItIsDecoded) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "tall.exr";
    const Image image = exact_image(16, 2048, 3, 0, 0);
    const Bytes bytes = made(image, {"R", "G", "B"});  // ZIP: 8 times 256 lines
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
    std::vector<double> shares;
    ReadOptions options;
    options.progress = [&](double share) {
        shares.push_back(share);
        return true;
    };
    expect_same_bits(plain(read_image(path, options)), plain(image));
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_GE(shares.size(), 8u);
    EXPECT_EQ(shares.back(), 1);

    std::size_t calls = 0;
    options.progress = [&](double) { return ++calls < shares.size() - 2; };
    try {
        static_cast<void>(read_image(path, options));
        ADD_FAILURE() << "was not cancelled";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::cancelled);
    }
}

// Another program's opinion
// ------------------------------------------------------------------------

TEST(ExrOracle, OiiotoolReadsOurFiles) {
    if (!has_program("oiiotool")) GTEST_SKIP() << "oiiotool is not installed";
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "ours.exr";
    const Bytes bytes = written(kExr, exact_contents(1, 16, 8, 3));
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
    const std::string text = output_of("oiiotool --info -v " + path.string());
    EXPECT_NE(text.find("16 x    8, 3 channel, half openexr"), std::string::npos) << text;
    EXPECT_NE(text.find("MIP-map levels: 16x8 8x4 4x2"), std::string::npos) << text;
}

}  // namespace
}  // namespace mirrorball
