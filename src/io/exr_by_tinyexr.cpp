// OpenEXR files read by tinyexr, which is one header: for builds that have not OpenEXR's library.
//
// Of what exr.cpp reads this takes all that tinyexr decodes: pictures that are uncompressed or
// packed by RLE, ZIP or PIZ, in scanlines or tiles, with mip levels or without, of any layer. It
// trusts headers and tables; so it is given a file that was checked beforehand (exr_parts.h).
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include <mirrorball/error.h>

#include "codec.h"
#include "exr_names.h"
#include "exr_parts.h"
#include "exr_picture.h"
#include "exr_words.h"
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

// What the parser has not loaded to the end it frees itself.
struct Pixels : EXRImage {
    Pixels() { InitEXRImage(this); }
    ~Pixels() {
        if (is_loaded) FreeEXRImage(this);
    }
    Pixels(const Pixels&) = delete;
    Pixels& operator=(const Pixels&) = delete;

    bool is_loaded = false;
};

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

// The picture's part, and where its channels stand in the list of all.
struct Choice {
    std::size_t part = 0;
    std::vector<std::size_t> channels;
};

Choice choose_picture(const InputFile& file, const ExrParts& parts,
                      std::vector<std::string>& notes) {
    for (std::size_t i = 0; i < parts.parts.size(); ++i) {
        const ExrPart& part = parts.parts[i];
        const auto names = part.is_deep ? std::nullopt : picture_channels(part.channels);
        if (!names) continue;
        note_choice(static_cast<std::int64_t>(parts.parts.size()), static_cast<std::int64_t>(i),
                    *names, notes);
        Choice choice{i, {}};
        for (const std::string& name : *names) {
            const auto found = std::find(part.channels.begin(), part.channels.end(), name);
            choice.channels.push_back(static_cast<std::size_t>(found - part.channels.begin()));
        }
        return choice;
    }
    const ExrPart& first = parts.parts.front();
    file.fail(first.is_deep ? kDeepPixels : no_picture_among(first.channels));
}

void check_compression(const InputFile& file, const ExrPart& part) {
    constexpr std::array<std::string_view, 5> kKnown = {"no method", "RLE", "ZIPS", "ZIP", "PIZ"};
    const std::string_view found = part.compression();
    if (std::find(kKnown.begin(), kKnown.end(), found) == kKnown.end())
        throw Error(Errc::unsupported,
                    fmt::format("{}: is compressed by {}, which this build cannot read",
                                file.name(), found));
}

void parse_header(const InputFile& file, std::span<const unsigned char> bytes, Header& header) {
    EXRVersion version{};
    if (ParseEXRVersionFromMemory(&version, bytes.data(), bytes.size()) != TINYEXR_SUCCESS)
        file.fail("is no OpenEXR file that can be read (its version is not known)");
    checked(file, [&](const char** text) {
        return ParseEXRHeaderFromMemory(&header, &version, bytes.data(), bytes.size(), text);
    });
}

void check_size(InputFile& file, const Header& header, const ReadOptions& options) {
    const bool has_levels = header.tiled && header.tile_level_mode == TINYEXR_TILE_MIPMAP_LEVELS;
    // Everything is decoded to floats at once, and then made into the picture.
    file.seek(0);
    check_claim(file, header.width(), header.height(), 4,
                (header.num_channels + 3) / 4 + (has_levels ? 2 : 1), 0, options);
}

// Floats, or whole numbers, which the parser leaves as they are.
float value_at(const unsigned char* texels, std::size_t i, int type) {
    const auto read = [&](auto value) {
        std::memcpy(&value, texels + i * sizeof value, sizeof value);
        return static_cast<float>(value);
    };
    return type == TINYEXR_PIXELTYPE_UINT ? read(std::uint32_t{}) : read(float{});
}

Image assemble(const InputFile& file, const Header& header, const EXRImage& pixels,
               const std::vector<std::size_t>& channels) {
    Image image(pixels.width, pixels.height, static_cast<int>(channels.size()));
    const auto copy = [&](unsigned char** planes, int left, int top, int width, int height,
                          int stride) {
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                for (std::size_t c = 0; c < channels.size(); ++c)
                    image.at(left + x, top + y)[c] =
                        value_at(planes[channels[c]], static_cast<std::size_t>(y) * stride + x,
                                 header.requested_pixel_types[channels[c]]);
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
            file.fail(kNeverWritten);
        copy(tile.images, static_cast<int>(left), static_cast<int>(top),
             static_cast<int>(std::min<std::int64_t>(header.tile_size_x, image.width() - left)),
             static_cast<int>(std::min<std::int64_t>(header.tile_size_y, image.height() - top)),
             header.tile_size_x);
    }
    return image;
}

Imath::Box2i box(const EXRBox2i& window) {
    return {{window.min_x, window.min_y}, {window.max_x, window.max_y}};
}

ExrPictureWords read_attributes(const Header& header, const ExrPart& part, FileContents& contents) {
    ExrPictureWords words{box(header.data_window), box(header.display_window), {}, {}};
    for (const ExrPart::Attribute& one : part.attributes) {
        const auto* bytes = reinterpret_cast<const char*>(one.value.data());
        if (one.type == "string" && one.name != "type" && one.name != "name")
            contents.metadata[one.name] = std::string(bytes, one.value.size());
        if (one.name == "envmap" && one.value.size() == 1 && *bytes >= 0 && *bytes < 2)
            words.environment = *bytes == 1 ? Projection::cube : Projection::equirect;
        if (one.name == kLevelCountAttribute && one.value.size() == sizeof(std::int32_t)) {
            std::int32_t count = 0;
            std::memcpy(&count, bytes, sizeof count);
            words.level_count = count;
        }
    }
    return words;
}

std::span<const unsigned char> unsigned_bytes(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()};
}

FileContents read_picture(InputFile& file, const ReadOptions& options) {
    file.seek(0);
    const std::span<const std::byte> all = file.look_ahead(file.size());
    const ExrParts parts = parse_exr_headers(file, all);
    FileContents contents;
    const Choice choice = choose_picture(file, parts, contents.notes);
    const ExrPart& part = parts.parts[choice.part];
    check_compression(file, part);
    const std::vector<std::byte> bytes = checked_part(file, all, parts, choice.part);

    Header header;
    parse_header(file, unsigned_bytes(bytes), header);
    check_size(file, header, options);
    const ExrPictureWords words = read_attributes(header, part, contents);
    const bool is_half =
        std::all_of(choice.channels.begin(), choice.channels.end(),
                    [&](std::size_t i) { return header.pixel_types[i] == TINYEXR_PIXELTYPE_HALF; });
    contents.stored = is_half ? TexelFormat::rgba16f : TexelFormat::rgba32f;
    for (int i = 0; i < header.num_channels; ++i)
        if (header.pixel_types[i] == TINYEXR_PIXELTYPE_HALF)
            header.requested_pixel_types[i] = TINYEXR_PIXELTYPE_FLOAT;

    Pixels pixels;
    pixels.num_channels = header.num_channels;  // else those of a failed load would not be freed
    checked(file, [&](const char** text) {
        return LoadEXRImageFromMemory(&pixels, &header, unsigned_bytes(bytes).data(), bytes.size(),
                                      text);
    });
    pixels.is_loaded = true;
    std::vector<Image> levels;
    for (const EXRImage* level = &pixels; level; level = level->next_level)
        levels.push_back(assemble(file, header, *level, choice.channels));
    take_exr_levels(file, std::move(levels), words, options, contents);
    drop_opaque_alpha(contents);
    return contents;
}

// What the parser's containers throw, as what we throw.
FileContents read(InputFile& file, const ReadOptions& options) {
    try {
        return read_picture(file, options);
    } catch (const std::logic_error& error) {
        file.fail(fmt::format("is no OpenEXR file that can be read ({})", error.what()));
    }
}

}  // namespace

const Codec kExr{"OpenEXR", {".exr"}, {}, recognises, read, nullptr};

}  // namespace mirrorball::detail
