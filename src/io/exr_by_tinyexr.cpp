// OpenEXR files read by tinyexr, which is one header: for builds that have not OpenEXR's library.
//
// Of what exr.cpp reads this takes the plain case: the first level of one part that has R, G and B
// or Y, by their plain names, uncompressed or by RLE, ZIP or PIZ. The rest is refused by name.
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <mirrorball/error.h>

#include "codec.h"
#include "edge_grid.h"
#include "exr_strip.h"
#include "packed.h"

#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Weverything"
#define TINYEXR_USE_MINIZ 1
#define TINYEXR_IMPLEMENTATION
#include <tinyexr.h>
#pragma clang diagnostic pop

namespace mirrorball::detail {
namespace {

constexpr std::array<unsigned char, 4> kMagic = {0x76, 0x2f, 0x31, 0x01};

// Where OpenEXR's pictures of the two projections lie in our world, as in exr.cpp.
const Axes kLatLongAxes{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
const Axes kCubeAxes{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}};

bool recognises(std::span<const std::byte> head) {
    return head.size() >= kMagic.size() &&
           std::equal(kMagic.begin(), kMagic.end(), head.begin(),
                      [](unsigned char a, std::byte b) { return std::byte{a} == b; });
}

struct Header : EXRHeader {
    Header() { InitEXRHeader(this); }
    ~Header() { FreeEXRHeader(this); }
    Header(const Header&) = delete;
    Header& operator=(const Header&) = delete;

    [[nodiscard]] std::int64_t width() const {
        return std::int64_t{data_window.max_x} - data_window.min_x + 1;
    }
    [[nodiscard]] std::int64_t height() const {
        return std::int64_t{data_window.max_y} - data_window.min_y + 1;
    }
};

struct Pixels : EXRImage {
    Pixels() { InitEXRImage(this); }
    ~Pixels() { FreeEXRImage(this); }
    Pixels(const Pixels&) = delete;
    Pixels& operator=(const Pixels&) = delete;
};

std::span<const unsigned char> whole(InputFile& file) {
    file.seek(0);
    const auto bytes = file.look_ahead(file.size());
    return {reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()};
}

// The parser's functions give a code, and text that the caller frees.
template <class Call>
void checked(const InputFile& file, Call&& call) {
    const char* text = nullptr;
    if (call(&text) == TINYEXR_SUCCESS) return;
    std::string words = text ? text : "";
    if (text) FreeEXRErrorMessage(text);
    while (!words.empty() && (words.back() == '\n' || words.back() == '.')) words.pop_back();
    file.fail(fmt::format("is no OpenEXR file that can be read ({})", words));
}

void parse_header(InputFile& file, Header& header) {
    const auto bytes = whole(file);
    EXRVersion version{};
    if (ParseEXRVersionFromMemory(&version, bytes.data(), bytes.size()) != TINYEXR_SUCCESS)
        file.fail("is no OpenEXR file that can be read (its version is not known)");
    if (version.non_image) file.fail("holds deep pixels; flat ones were expected");
    if (version.multipart)
        throw Error(Errc::unsupported,
                    file.name() + ": has several parts, which this build cannot read");
    checked(file, [&](const char** text) {
        return ParseEXRHeaderFromMemory(&header, &version, bytes.data(), bytes.size(), text);
    });
}

// R, G, B and perhaps A, or Y and perhaps A: where they stand in the list of channels.
std::vector<int> picture_channels(const InputFile& file, const Header& header) {
    std::vector<std::string> names;
    for (int i = 0; i < header.num_channels; ++i) names.emplace_back(header.channels[i].name);
    std::vector<int> result;
    const auto take = [&](const char* name) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) return false;
        result.push_back(static_cast<int>(found - names.begin()));
        return true;
    };
    if (!(take("R") && take("G") && take("B"))) {
        result.clear();
        if (!take("Y"))
            file.fail(fmt::format("has the channels {} (R, G and B or Y were expected)",
                                  fmt::join(names, ", ")));
    }
    take("A");
    for (const int i : result) {
        const EXRChannelInfo& channel = header.channels[i];
        if (channel.x_sampling != 1 || channel.y_sampling != 1)
            file.fail(fmt::format("its channel {} is sub-sampled {} x {}; full ones were expected",
                                  channel.name, channel.x_sampling, channel.y_sampling));
    }
    return result;
}

void check_header(InputFile& file, const Header& header, const ReadOptions& options) {
    const bool has_levels = header.tiled && header.tile_level_mode != TINYEXR_TILE_ONE_LEVEL;
    // Everything is decoded to floats at once, and then made into the picture.
    file.seek(0);
    check_claim(file, header.width(), header.height(), 4,
                (header.num_channels + 3) / 4 + (has_levels ? 2 : 1), 0, options);
    if (header.tiled && header.tile_level_mode == TINYEXR_TILE_RIPMAP_LEVELS)
        file.fail("has ripmap levels; mip levels or one level were expected");
    if (header.tiled && (header.tile_size_x < 1 || header.tile_size_y < 1))
        file.fail(fmt::format("its tiles are {} x {}, for a picture of {} x {}", header.tile_size_x,
                              header.tile_size_y, header.width(), header.height()));
    for (int i = 0; i < header.num_channels; ++i) {
        if (header.pixel_types[i] == TINYEXR_PIXELTYPE_UINT)
            throw Error(Errc::unsupported,
                        fmt::format("{}: its channel {} holds whole numbers, which this build "
                                    "cannot read",
                                    file.name(), header.channels[i].name));
    }
}

float value_at(const unsigned char* texels, std::size_t i) {
    float value = 0;
    std::memcpy(&value, texels + i * sizeof(float), sizeof(float));
    return value;
}

Image assemble(const InputFile& file, const Header& header, const Pixels& pixels,
               const std::vector<int>& channels) {
    Image image(static_cast<int>(header.width()), static_cast<int>(header.height()),
                static_cast<int>(channels.size()));
    const auto copy = [&](unsigned char** planes, int left, int top, int width, int height,
                          int stride) {
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                for (std::size_t c = 0; c < channels.size(); ++c)
                    image.at(left + x, top + y)[c] =
                        value_at(planes[channels[c]], static_cast<std::size_t>(y) * stride + x);
            }
        }
    };
    if (!header.tiled) {
        copy(pixels.images, 0, 0, image.width(), image.height(), image.width());
        return image;
    }
    for (int i = 0; i < pixels.num_tiles; ++i) {
        const EXRTile& tile = pixels.tiles[i];
        const std::int64_t left = std::int64_t{tile.offset_x} * header.tile_size_x,
                           top = std::int64_t{tile.offset_y} * header.tile_size_y;
        if (!tile.images || left < 0 || top < 0 || left >= image.width() || top >= image.height())
            file.fail("is incomplete: some of its pixels were never written");
        copy(tile.images, static_cast<int>(left), static_cast<int>(top),
             static_cast<int>(std::min<std::int64_t>(header.tile_size_x, image.width() - left)),
             static_cast<int>(std::min<std::int64_t>(header.tile_size_y, image.height() - top)),
             header.tile_size_x);
    }
    return image;
}

void read_attributes(const Header& header, FileContents& contents,
                     std::optional<Projection>& environment) {
    for (int i = 0; i < header.num_custom_attributes; ++i) {
        const EXRAttribute& attribute = header.custom_attributes[i];
        const std::string_view name = attribute.name, type = attribute.type;
        if (type == "string" && attribute.size >= 0)
            contents.metadata[attribute.name] =
                std::string(reinterpret_cast<const char*>(attribute.value),
                            static_cast<std::size_t>(attribute.size));
        if (name == "envmap" && attribute.size == 1 && attribute.value[0] < 2)
            environment = attribute.value[0] == 1 ? Projection::cube : Projection::equirect;
    }
}

FileContents read(InputFile& file, const ReadOptions& options) {
    Header header;
    parse_header(file, header);
    const std::vector<int> channels = picture_channels(file, header);
    check_header(file, header, options);
    if (std::memcmp(&header.data_window, &header.display_window, sizeof(EXRBox2i)) != 0)
        throw Error(Errc::unsupported,
                    file.name() +
                        ": stores another part of the picture than is to be shown, "
                        "which this build cannot read");

    FileContents contents;
    std::optional<Projection> environment;
    read_attributes(header, contents, environment);
    const bool is_half = std::all_of(channels.begin(), channels.end(), [&](int i) {
        return header.pixel_types[i] == TINYEXR_PIXELTYPE_HALF;
    });
    contents.stored = is_half ? TexelFormat::rgba16f : TexelFormat::rgba32f;

    std::fill_n(header.requested_pixel_types, header.num_channels, TINYEXR_PIXELTYPE_FLOAT);
    const auto bytes = whole(file);
    Pixels pixels;
    checked(file, [&](const char** text) {
        return LoadEXRImageFromMemory(&pixels, &header, bytes.data(), bytes.size(), text);
    });
    if (pixels.next_level) contents.notes.emplace_back("has levels; the first was read");
    Image image = assemble(file, header, pixels, channels);

    const bool is_cube = environment == Projection::cube;
    const std::int64_t w = image.width(), h = image.height();
    if (environment && (is_cube ? h == 6 * w : w == 2 * h)) {
        contents.levels.push_back(is_cube ? cube_from_edge_grid(cut_strip(image))
                                          : std::vector{equirect_from_edge_grid(image)});
        contents.projection = environment;
        contents.axes = is_cube ? kCubeAxes : kLatLongAxes;
    } else {
        contents.levels.emplace_back().push_back(std::move(image));
    }
    drop_opaque_alpha(contents);
    return contents;
}

}  // namespace

const Codec kExr{"OpenEXR", {".exr"}, {}, recognises, read, nullptr};

}  // namespace mirrorball::detail
