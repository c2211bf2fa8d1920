// The browser's reader of OpenEXR files against the usual one: the same texels, notes and words.
#include <gtest/gtest.h>

#include "container_support.h"
#include "exr_support.h"
#include "fuzz/decode.h"

namespace mirrorball {
namespace {

using detail::kExr;
using detail::kExrByTinyexr;

void expect_read_alike(const Bytes& bytes) {
    const FileContents usual = read_back(kExr, bytes), other = read_back(kExrByTinyexr, bytes);
    expect_same_bits(usual, other);
    EXPECT_EQ(usual.stored, other.stored);
    EXPECT_EQ(usual.notes, other.notes);
    EXPECT_EQ(usual.projection, other.projection);
    EXPECT_EQ(usual.axes, other.axes);
    EXPECT_EQ(usual.metadata, other.metadata);
}

const std::vector<std::string> kRgb = {"R", "G", "B"};

TEST(ExrByTinyexr, CompressionsThatLoseNothing) {
    const Image image = exact_image(19, 40, 3, 0, 0);
    for (const Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,
          Imf::PIZ_COMPRESSION})
        for (const bool is_tiled : {false, true})
            expect_read_alike(made(image, kRgb, [&](Imf::Header& header) {
                header.compression() = compression;
                if (is_tiled) header.setTileDescription(Imf::TileDescription(8, 16));
            }));
}

// Lines are where their chunks say, in whatever order these were written.
TEST(ExrByTinyexr, LinesInAnyOrder) {
    const Image image = exact_image(19, 40, 3, 0, 0);
    for (const Imf::LineOrder order : {Imf::DECREASING_Y, Imf::RANDOM_Y})
        for (const bool is_tiled : {false, true}) {
            if (order == Imf::RANDOM_Y && !is_tiled) continue;
            expect_read_alike(made(image, kRgb, [&](Imf::Header& header) {
                header.lineOrder() = order;
                if (is_tiled) header.setTileDescription(Imf::TileDescription(8, 16));
            }));
        }
}

TEST(ExrByTinyexr, LuminanceLayersAndWholeNumbers) {
    const Image grey = exact_image(5, 4, 1, 0, 0), image = exact_image(5, 4, 4, 0, 0);
    expect_read_alike(made(grey, {"Y"}));
    expect_read_alike(made(image, {"left.R", "left.G", "left.B", "left.A"}));
    expect_read_alike(made(image, {"a.b.Y", "Z", "a.b.A", "N"}));
    const TemporaryFolder folder;
    const std::string path = folder / "whole.exr";
    const std::uint32_t numbers[] = {0, 1, 70000, 5};
    {
        Imf::Header header(2, 2);
        header.channels().insert("Y", Imf::Channel(Imf::UINT));
        Imf::OutputFile file(path.c_str(), header, 0);
        Imf::FrameBuffer buffer;
        buffer.insert("Y", Imf::Slice::Make(Imf::UINT, numbers, V2i(0), 2, 2));
        file.setFrameBuffer(buffer);
        file.writePixels(2);
    }
    expect_read_alike(file_bytes(path));
}

TEST(ExrByTinyexr, Levels) {
    expect_read_alike(written(kExr, exact_contents(1, 32, 16, 3)));
    expect_read_alike(written(kExr, exact_contents(6, 8, 8, 3)));
    for (const auto& size : {V2i(16, 8), V2i(13, 7), V2i(12, 6)})
        for (const auto rounding : {Imf::ROUND_DOWN, Imf::ROUND_UP})
            expect_read_alike(
                made(exact_image(size.x, size.y, 3, 0, 0), kRgb, [&](Imf::Header& header) {
                    header.setTileDescription(
                        Imf::TileDescription(4, 4, Imf::MIPMAP_LEVELS, rounding));
                }));
}

TEST(ExrByTinyexr, TheDisplayWindowAndTheEnvironment) {
    const Image image = exact_image(6, 4, 3, 0, 0);
    expect_read_alike(made(image, kRgb, [](Imf::Header& header) {
        header.dataWindow() = Box2i({-2, 3}, {3, 6});
        header.displayWindow() = Box2i({0, 0}, {7, 5});
    }));
    for (const Imf::Envmap kind : {Imf::ENVMAP_LATLONG, Imf::ENVMAP_CUBE})
        expect_read_alike(
            made(image, kRgb, [&](Imf::Header& header) { Imf::addEnvmap(header, kind); }));
    expect_read_alike(made(exact_image(8, 4, 3, 0, 0), kRgb, [](Imf::Header& header) {
        Imf::addEnvmap(header, Imf::ENVMAP_LATLONG);
    }));
}

TEST(ExrByTinyexr, TheFirstPartWithAPicture) {
    const MadePart depth{exact_image(8, 40, 1, 0, 0), {"Z"}, false, Imf::DWAB_COMPRESSION};
    const MadePart tiled{exact_image(8, 40, 3, 1, 0), kRgb, true, Imf::PIZ_COMPRESSION};
    const MadePart lines{exact_image(8, 40, 3, 2, 0), {"left.R", "left.G", "left.B"}};
    expect_read_alike(made_parts({depth, tiled, lines}));
    expect_read_alike(made_parts({depth, lines, tiled}));
    expect_read_alike(made_parts({lines, tiled}));
}

TEST(ExrByTinyexr, RefusesInTheSameWords) {
    const auto expect_refused_alike = [](const Bytes& bytes) {
        EXPECT_EQ(refusal(kExr, bytes), refusal(kExrByTinyexr, bytes));
    };
    const Image image = exact_image(4, 4, 3, 0, 0);
    expect_refused_alike(made(image, {"X", "Q", "Z"}));
    expect_refused_alike(made_parts({{image, {"X", "Q", "Z"}}, {image, {"A", "B", "C"}}}));
    expect_refused_alike(made(image, kRgb, [](Imf::Header& header) {
        header.setTileDescription(Imf::TileDescription(4, 4, Imf::RIPMAP_LEVELS));
    }));
    for (const Imf::Compression compression :
         {Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::DWAA_COMPRESSION}) {
        const Bytes bytes =
            made(image, kRgb, [&](Imf::Header& header) { header.compression() = compression; });
        try {
            static_cast<void>(read_back(kExrByTinyexr, bytes));
            ADD_FAILURE() << "was read";
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), Errc::unsupported);
            EXPECT_NE(std::string(error.what()).find("is compressed by "), std::string::npos);
        }
    }
}

TEST(ExrByTinyexr, EveryTruncationIsRefused) {
    expect_truncations_refused(kExrByTinyexr, written(kExr, exact_contents(1, 4, 4, 1)));
    expect_truncations_refused(kExrByTinyexr, written(kExr, exact_contents(6, 2, 2, 2)));
    expect_truncations_refused(kExrByTinyexr,
                               made_parts({{exact_image(3, 2, 1, 0, 0), {"Z"}},
                                           {exact_image(3, 2, 3, 0, 0), {"R", "G", "B"}}}));
}

// The fuzzer's seeds, whole and with each byte in turn made another: refused or read, within
// bounds.
TEST(ExrByTinyexr, NoDamageLeadsBeyondTheBytes) {
    int count = 0;
    const std::filesystem::path folder =
        std::filesystem::path(MIRRORBALL_SOURCE_DIR) / "tests/fuzz/seeds/exr";
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const Bytes bytes = file_bytes(entry.path());
        EXPECT_FALSE(detail::decode_or_refuse(kExrByTinyexr, bytes)) << entry.path();
        for (std::size_t i = 0; i < bytes.size(); ++i) {
            Bytes damaged = bytes;
            for (const int value : {0x00, 0x7f, 0xff}) {
                damaged[i] = std::byte(value);
                detail::decode_or_refuse(kExrByTinyexr, damaged);
            }
        }
        ++count;
    }
    EXPECT_GE(count, 16);
}

}  // namespace
}  // namespace mirrorball
