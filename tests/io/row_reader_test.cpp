// Rows one after the other against the whole map: the same texels, notes and errors, in bounded
// memory.
#include <mirrorball/row_reader.h>

#include <sys/resource.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mirrorball/error.h>

#include "io/file.h"
#include "io/hdr.h"
#include "support.h"

namespace mirrorball {
namespace {

constexpr int kHeight = 75, kWidth = 2 * kHeight;  // a multiple of no piece of rows
const float kNan = std::numeric_limits<float>::quiet_NaN();

Image noise(int width, int height, int channels, unsigned seed = 1) {
    std::mt19937 random(seed);
    std::lognormal_distribution<float> radiance(0, 2);
    Image image(width, height, channels);
    for (float& value : image.values()) value = radiance(random);
    return image;
}

// All rows, asked for `count` at a time.
std::vector<float> read_all(RowReader& reader, int count) {
    std::vector<float> all, rows(count * reader.row_size());
    while (const int got = reader.read(rows))
        all.insert(all.end(), rows.begin(), rows.begin() + got * reader.row_size());
    return all;
}

bool same_bits(std::span<const float> a, std::span<const float> b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

void expect_same_as_whole(const std::string& file, const MapReadOptions& options = {},
                          bool streams = true) {
    const LoadedMap whole = read_map(file, options);
    for (const int count : {1, 7, 64, 1000}) {
        RowReader reader(file, options);
        EXPECT_EQ(reader.streams(), streams) << file;
        EXPECT_EQ(reader.width(), whole.map.width());
        EXPECT_EQ(reader.height(), whole.map.height());
        EXPECT_EQ(reader.axes(), whole.map.axes);
        EXPECT_EQ(reader.format(), whole.format);
        EXPECT_EQ(reader.stored(), whole.stored);
        EXPECT_EQ(reader.metadata(), whole.metadata);
        const std::vector<float> rows = read_all(reader, count);
        EXPECT_TRUE(same_bits(rows, whole.map.levels[0].faces[0].values()))
            << file << ", " << count << " rows at a time";
        if (streams) {
            EXPECT_EQ(reader.notes(), whole.notes) << file;
        }
    }
}

std::string message_of(const std::function<void()>& f, Errc code) {
    try {
        f();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        return error.what();
    }
    ADD_FAILURE() << "nothing was thrown";
    return {};
}

// Reading by rows fails as reading whole does.
void expect_same_error(const std::string& file, const MapReadOptions& options = {}) {
    const std::string expected =
        message_of([&] { (void)read_map(file, options); }, Errc::cannot_read);
    EXPECT_EQ(message_of(
                  [&] {
                      RowReader reader(file, options);
                      (void)read_all(reader, 5);
                  },
                  Errc::cannot_read),
              expected);
}

TEST(RowReader, GivesWhatTheWholeMapHas) {
    const TemporaryFolder folder;
    for (const char* name : {"a.hdr", "a.pfm", "a.exr"}) {
        const std::string file = (folder / name).string();
        write_image(file, noise(kWidth, kHeight, 3));
        expect_same_as_whole(file);
        MapReadOptions options;
        options.transfer = Transfer::srgb;
        options.axes = "blender";
        expect_same_as_whole(file, options);
    }
}

TEST(RowReader, MakesGreyAndAlphaThreeChannels) {
    const TemporaryFolder folder;
    for (const int channels : {1, 2, 4}) {
        const std::string file = (folder / "a.exr").string();
        write_image(file, noise(kWidth, kHeight, channels));
        expect_same_as_whole(file);
    }
    write_image(folder / "grey.pfm", noise(kWidth, kHeight, 1));
    expect_same_as_whole((folder / "grey.pfm").string());
}

TEST(RowReader, KnowsAMapThatItsFileDescribes) {
    const TemporaryFolder folder;
    EnvironmentMap map = make_environment_map(Projection::equirect, kWidth);
    map.levels[0].faces[0] = noise(kWidth, kHeight, 3);
    map.levels[0].lobe = Lobe{Lobe::Kind::diffuse};
    map.axes = parse_axes("+z+y+x", Projection::equirect);
    for (const char* name : {"a.hdr", "a.exr"}) {
        write_map((folder / name).string(), map);
        expect_same_as_whole((folder / name).string());
        EXPECT_EQ(RowReader((folder / name).string()).lobe(), map.levels[0].lobe);
    }
}

// Files as other programs write them: each compression, scanlines upward, tiles.
void write_exr(const std::string& file, Imf::Compression compression, Imf::LineOrder order,
               bool tiled) {
    const Image image = noise(kWidth, kHeight, 3);
    Imf::Header header(kWidth, kHeight);
    header.compression() = compression;
    header.lineOrder() = order;
    Imf::FrameBuffer buffer;
    for (int c = 0; c < 3; ++c) {
        const char* name = &"R\0G\0B"[2 * c];
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, image.values().data() + c, {0, 0}, kWidth,
                                             kHeight, 12, 12 * kWidth));
    }
    if (tiled) {
        header.setTileDescription(Imf::TileDescription(32, 16, Imf::ONE_LEVEL));
        Imf::TiledOutputFile out(file.c_str(), header);
        out.setFrameBuffer(buffer);
        out.writeTiles(0, out.numXTiles() - 1, 0, out.numYTiles() - 1);
        return;
    }
    Imf::OutputFile out(file.c_str(), header);
    out.setFrameBuffer(buffer);
    // a file of decreasing y is written from the bottom, whatever the order of calls
    out.writePixels(kHeight);
}

TEST(RowReader, ReadsEveryCompressionOfOpenExr) {
    const TemporaryFolder folder;
    const std::string file = (folder / "a.exr").string();
    for (int c = 0; c < Imf::NUM_COMPRESSION_METHODS; ++c) {
        write_exr(file, static_cast<Imf::Compression>(c), Imf::INCREASING_Y, false);
        expect_same_as_whole(file);
    }
    write_exr(file, Imf::ZIP_COMPRESSION, Imf::DECREASING_Y, false);
    expect_same_as_whole(file);
    write_exr(file, Imf::PIZ_COMPRESSION, Imf::INCREASING_Y, true);
    expect_same_as_whole(file);
}

// Of a .hdr file, with the size line as given and the texels of the older coding.
std::string flat_hdr(const std::string& size_line) {
    std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + size_line + "\n";
    for (int i = 0; i < 18 * 9; ++i)
        for (const int byte : {128 + i % 100, i, 200 - i, 120 + i % 20})
            bytes.push_back(static_cast<char>(byte));
    return bytes;
}

void write_bytes(const std::string& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<long>(bytes.size()));
}

TEST(RowReader, ReadsEveryOrderOfScanlines) {
    const TemporaryFolder folder;
    const std::string file = (folder / "a.hdr").string();
    for (const char* size : {"-Y 9 +X 18", "-Y 9 -X 18"}) {
        write_bytes(file, flat_hdr(size));
        expect_same_as_whole(file);
    }
    for (const char* size : {"+Y 9 +X 18", "+X 18 -Y 9"}) {
        write_bytes(file, flat_hdr(size));
        expect_same_as_whole(file, {}, false);
        EXPECT_NE(RowReader(file).notes().back().find("is read whole, as its scanlines"),
                  std::string::npos);
    }
}

TEST(RowReader, ReadsOtherFormatsWhole) {
    const TemporaryFolder folder;
    const std::string file = (folder / "a.png").string();
    write_image(file, noise(kWidth, kHeight, 3));
    expect_same_as_whole(file, {}, false);
    RowReader reader(file);
    EXPECT_EQ(reader.notes().back(),
              "is read whole, as PNG files have no rows that can be read by themselves");
    EXPECT_GE(reader.bytes_held(), sizeof(float) * 3 * kWidth * kHeight);
}

TEST(RowReader, RefusesOtherProjections) {
    const TemporaryFolder folder;
    const std::string file = (folder / "a.hdr").string();
    write_image(file, noise(64, 64, 3));
    MapReadOptions options;
    options.projection = Projection::angular;
    EXPECT_EQ(message_of([&] { RowReader reader(file, options); }, Errc::usage),
              file + ": is an angular map; only equirect maps are read row by row");
    write_image(file, noise(64, 30, 3));
    expect_same_error(file);
}

// Holes of every kind: one texel, across the seam, over several rows, at the poles, and two that
// are a row apart.
TEST(RowReader, RepairsAsTheWholeMapIsRepaired) {
    const TemporaryFolder folder;
    Image image = noise(kWidth, kHeight, 3);
    const auto cut = [&](int x0, int x1, int y0, int y1) {
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x)
                image.at((x + kWidth) % kWidth, y)[x % 2] = y % 3 == 0 ? kNan : INFINITY;
    };
    cut(10, 10, 20, 20);
    cut(-3, 4, 30, 41);
    cut(50, 60, 43, 43);
    cut(0, 149, 60, 66);  // whole rows
    cut(70, 80, 0, 2);
    cut(20, 99, 73, 74);
    image.at(3, 10)[1] = -2;
    image.at(77, 74)[2] = -3;
    const std::string file = (folder / "a.pfm").string();
    // write_image() refuses NaN
    std::string bytes = fmt::format("PF\n{} {}\n-1.0\n", kWidth, kHeight);
    for (int y = kHeight - 1; y >= 0; --y)
        bytes.append(reinterpret_cast<const char*>(image.at(0, y)), sizeof(float) * 3 * kWidth);
    write_bytes(file, bytes);

    expect_same_error(file);
    MapReadOptions options;
    options.repair = true;
    expect_same_as_whole(file, options);
}

TEST(RowReader, RefusesWhatCannotBeRepaired) {
    const TemporaryFolder folder;
    const std::string file = (folder / "a.pfm").string();
    const std::vector<float> holes(3 * 16 * 8, kNan);
    write_bytes(file, "PF\n16 8\n-1.0\n" + std::string(reinterpret_cast<const char*>(holes.data()),
                                                       sizeof(float) * holes.size()));
    MapReadOptions options;
    options.repair = true;
    expect_same_error(file);
    expect_same_error(file, options);
}

std::string bytes_of(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// Wherever a file ends, by rows it is as broken as whole. Of OpenEXR's messages, which name the
// place where decoding stopped, only that there is one.
TEST(RowReader, RefusesFilesCutShort) {
    const TemporaryFolder folder;
    for (const char* name : {"a.hdr", "a.pfm", "a.exr"}) {
        const std::string file = (folder / name).string();
        write_image(file, noise(64, 32, 3));
        const std::string bytes = bytes_of(file);
        for (std::size_t size = 1; size < bytes.size(); size += 1 + bytes.size() / 40) {
            write_bytes(file, bytes.substr(0, size));
            if (!file.ends_with("exr")) {
                expect_same_error(file);
                continue;
            }
            const std::string message = message_of(
                [&] {
                    RowReader reader(file);
                    (void)read_all(reader, 3);
                },
                Errc::cannot_read);
            EXPECT_TRUE(message.starts_with(file)) << message;
        }
    }
}

TEST(RowReader, RefusesBrokenRuns) {
    const TemporaryFolder folder;
    const std::string file = (folder / "a.hdr").string();
    Image image(64, 32, 3);  // with runs of every length
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            image.set_rgb(x, y, Vec3f(1.0f + float(x / (y + 1)), 0.5f, float(x % 3)));
    write_image(file, image);
    const std::string bytes = bytes_of(file);
    const std::size_t begin = bytes.find("+X 64\n") + 6;
    std::mt19937 random(7);
    int broken_count = 0;
    for (int i = 0; i < 200; ++i) {
        std::string damaged = bytes;
        damaged[begin + random() % (bytes.size() - begin)] = static_cast<char>(random());
        write_bytes(file, damaged);
        try {
            (void)read_map(file);
        } catch (const Error&) {
            ++broken_count;
            expect_same_error(file);
            continue;
        }
        expect_same_as_whole(file);
    }
    EXPECT_GT(broken_count, 20);
}

TEST(RowReader, HoldsToTheMemoryLimit) {
    const TemporaryFolder folder;
    const std::string file = (folder / "a.hdr").string();
    write_image(file, noise(512, 256, 3));
    const std::uint64_t held = RowReader(file).bytes_held();
    EXPECT_GT(held, 0u);
    MapReadOptions options;
    options.memory_limit = held;
    RowReader reader(file, options);
    options.memory_limit = held - 1;
    EXPECT_NE(message_of([&] { RowReader over(file, options); }, Errc::cannot_read)
                  .find("reading its rows takes"),
              std::string::npos);
}

TEST(RowReader, StatisticsAreThoseOfTheWhole) {
    const TemporaryFolder folder;
    const std::string file = (folder / "a.pfm").string();
    Image image = noise(kWidth, kHeight, 3);
    image.at(5, 6)[1] = -1;
    write_image(file, image);
    RowReader reader(file);
    const LevelStatistics rows = statistics(reader), whole = statistics(read_map(file).map);
    // but for the last bit of a texel's solid angle, which is taken for a row at once
    EXPECT_TRUE(rows.flux.equalWithRelError(whole.flux, 1e-14));
    EXPECT_NEAR(rows.rms, whole.rms, 1e-14 * whole.rms);
    EXPECT_EQ(rows.minimum, whole.minimum);
    EXPECT_EQ(rows.maximum, whole.maximum);
    EXPECT_EQ(rows.texel_count, whole.texel_count);
    EXPECT_EQ(rows.negative_count, 1);
}

// By definition, and the flux is kept but for the rounding of each texel to float.
TEST(RowReader, ReducesByMeansOverSolidAngle) {
    const TemporaryFolder folder;
    const std::string file = (folder / "a.pfm").string();
    write_image(file, noise(kWidth, kHeight, 3));
    const LoadedMap whole = read_map(file);
    const Image& image = whole.map.levels[0].faces[0];
    const std::vector<double> solid_angles =
        solid_angle_table(Projection::equirect, kWidth, kHeight);
    for (const int factor : {1, 3, 5, 15, 75}) {
        RowReader reader(file);
        const EnvironmentMap map = reduced(reader, factor);
        ASSERT_EQ(map.width(), kWidth / factor);
        for (int y = 0; y < map.height(); ++y)
            for (int x = 0; x < map.width(); ++x) {
                Vec3d sum(0.0);
                double weight = 0;
                for (int j = y * factor; j < (y + 1) * factor; ++j)
                    for (int i = x * factor; i < (x + 1) * factor; ++i) {
                        sum += Vec3d(image.rgb(i, j)) * solid_angles[j * kWidth + i];
                        weight += solid_angles[j * kWidth + i];
                    }
                const Vec3f mean = map.levels[0].faces[0].rgb(x, y);
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(mean[c], sum[c] / weight, 6.1e-8 * sum[c] / weight);
            }
        EXPECT_NEAR(flux(map).x, flux(whole.map).x, 6.1e-8 * flux(whole.map).x);
    }
    RowReader reader(file);
    EXPECT_NE(message_of([&] { (void)reduced(reader, 2); }, Errc::usage).find("factor 2"),
              std::string::npos);
}

std::uint64_t peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return std::uint64_t(usage.ru_maxrss) * 1024;
}

#if defined(__SANITIZE_ADDRESS__)
constexpr int kLargeWidth = 4096;  // each byte costs its shadow and its time
#else
constexpr int kLargeWidth = 16384;
#endif

// The whole would take 1.6 GB. The process's peak is its own whatever ran before, so what it grows
// by is a lower bound of what rows take; the tests run in processes of their own under ctest.
TEST(RowReader, ReadsAPanoramaThatIsLargerThanWhatItHolds) {
    const TemporaryFolder folder;
    const std::string file = (folder / "large.hdr").string();
    {
        // the same two rows again and again, made once
        std::vector<float> row(std::size_t{3} * kLargeWidth);
        for (int x = 0; x < 3 * kLargeWidth; ++x) row[x] = 0.25f + 0.25f * float(x / 4096 % 4);
        detail::OutputFile two{folder / "two.hdr"};
        detail::HdrWriter writer(two, kLargeWidth, 2);
        const std::uint64_t begin = two.position();
        for (const float first : {1.0f, 2.0f}) {
            row[0] = first;
            writer.write_row(row);
        }
        two.commit();
        const std::string rows = bytes_of((folder / "two.hdr").string()).substr(begin);
        std::ofstream out(file, std::ios::binary);
        out << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " << kLargeWidth / 2 << " +X "
            << kLargeWidth << "\n";
        for (int y = 0; y < kLargeWidth / 2; y += 2) out << rows;
    }
    RowReader reader(file);
    EXPECT_LT(reader.bytes_held(), std::uint64_t{16} << 20);
    const std::uint64_t before = peak_memory();
    const EnvironmentMap map = reduced(reader, 16);
    const std::uint64_t grown = peak_memory() - before;
    EXPECT_EQ(map.width(), kLargeWidth / 16);
    // its own, the batch of rows, the result, and room for what the allocator keeps
    EXPECT_LT(grown, reader.bytes_held() + reader.rows_at_once() * reader.row_size() * 8 +
                         environment_map_bytes(Projection::equirect, map.width()) + (8 << 20));
    EXPECT_NEAR(map.levels[0].faces[0].rgb(1, 3).x, 0.25f, 1e-7);
}

}  // namespace
}  // namespace mirrorball
