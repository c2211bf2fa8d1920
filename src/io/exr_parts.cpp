// The layout, numbers being little-endian:
//
//     magic, version and flags
//     a header for each part: attributes (name, type, size, value), a zero; of several parts one
//     more zero behind the last header
//     a table for each part: where in the file each of its chunks begins
//     chunks: the part's number, if there are several; where in the picture it lies (a scanline's
//     y, or a tile's place and level); its size; its bytes
//
// A table's order is fixed, whatever the order of the chunks: by levels, and in each by rows.
#include "exr_parts.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <iterator>

#include <fmt/format.h>

#include "exr_words.h"

namespace mirrorball::detail {
namespace {

constexpr std::uint32_t kMagic = 20000630;
enum Flag : std::uint32_t {
    kVersionMask = 0xff,
    kTiled = 0x200,
    kLongNames = 0x400,
    kDeep = 0x800,
    kMultipart = 0x1000,
};
constexpr std::size_t kLongestName = 255;
struct Compression {
    std::string_view name;
    int lines;  // of a picture in one chunk
};
constexpr std::string_view kPlain = "no method";
constexpr Compression kCompressions[] = {{kPlain, 1},  {"RLE", 1},    {"ZIPS", 1}, {"ZIP", 16},
                                         {"PIZ", 32},  {"PXR24", 16}, {"B44", 32}, {"B44A", 32},
                                         {"DWAA", 32}, {"DWAB", 256}};

// Attributes whose size a reader takes for granted.
struct Expected {
    std::string_view name;
    std::size_t size;
};
constexpr Expected kSizes[] = {
    {"compression", 1},      {"dataWindow", 16},        {"displayWindow", 16},    {"lineOrder", 1},
    {"pixelAspectRatio", 4}, {"screenWindowCenter", 8}, {"screenWindowWidth", 4}, {"tiles", 9},
    {"chunkCount", 4}};
// What a file needs to be one, beside its tiles.
constexpr std::string_view kNeeded[] = {
    "channels",  "compression",      "dataWindow",         "displayWindow",
    "lineOrder", "pixelAspectRatio", "screenWindowCenter", "screenWindowWidth"};

// Takes one thing after the other, none of it from beyond the end.
class Reader {
  public:
    Reader(const InputFile& file, std::span<const std::byte> bytes, std::size_t at = 0)
        : file_(file),
          bytes_(bytes),
          at_(at) {}

    [[nodiscard]] std::size_t position() const { return at_; }
    std::span<const std::byte> take(std::uint64_t count) {
        if (count > bytes_.size() - at_)
            file_.fail(
                fmt::format("is truncated: ends at byte {}, in the middle of {} bytes that "
                            "begin at {}",
                            bytes_.size(), count, at_));
        at_ += static_cast<std::size_t>(count);
        return bytes_.subspan(at_ - static_cast<std::size_t>(count),
                              static_cast<std::size_t>(count));
    }
    template <class T>
    T number() {
        T value;
        std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
        return value;
    }
    // Up to a zero, which is passed over.
    std::string text() {
        std::string result;
        for (char c = number<char>(); c != 0; c = number<char>()) {
            result += c;
            if (result.size() > kLongestName)
                file_.fail(fmt::format("has a name of more than {} characters at byte {}",
                                       kLongestName, at_ - result.size()));
        }
        return result;
    }

  private:
    const InputFile& file_;
    std::span<const std::byte> bytes_;
    std::size_t at_;
};

struct Channel {
    std::string name;
    std::int32_t type, x_sampling, y_sampling;
};

std::vector<Channel> parse_channels(const InputFile& file, std::span<const std::byte> list) {
    std::vector<Channel> channels;
    Reader reader(file, list);
    for (std::string name = reader.text(); !name.empty(); name = reader.text()) {
        const auto type = reader.number<std::int32_t>();
        reader.take(4);  // of linearity, and reserved
        const auto x_sampling = reader.number<std::int32_t>();
        channels.push_back({std::move(name), type, x_sampling, reader.number<std::int32_t>()});
    }
    return channels;
}

std::string text_of(const ExrPart& part, std::string_view name) {
    const ExrPart::Attribute* found = part.find(name);
    if (!found) return {};
    return {reinterpret_cast<const char*>(found->value.data()), found->value.size()};
}

ExrPart parse_part(const InputFile& file, Reader& reader) {
    ExrPart part;
    for (std::string name = reader.text(); !name.empty(); name = reader.text()) {
        ExrPart::Attribute attribute{std::move(name), reader.text(), {}};
        attribute.value = reader.take(reader.number<std::uint32_t>());
        for (const Expected& expected : kSizes)
            if (attribute.name == expected.name && attribute.value.size() != expected.size)
                file.fail(fmt::format("its attribute {} has {} bytes, expected {}", attribute.name,
                                      attribute.value.size(), expected.size));
        part.attributes.push_back(std::move(attribute));
    }
    for (const std::string_view needed : kNeeded)
        if (!part.find(needed)) file.fail(fmt::format("has no attribute {}", needed));
    for (Channel& channel : parse_channels(file, part.find("channels")->value))
        part.channels.push_back(std::move(channel.name));
    const std::string type = text_of(part, "type");
    part.is_deep = type.starts_with("deep");
    part.is_tiled = type == "tiledimage";
    return part;
}

const Compression* compression_of(const ExrPart& part) {
    const auto code = std::to_integer<std::size_t>(part.find("compression")->value[0]);
    return code < std::size(kCompressions) ? &kCompressions[code] : nullptr;
}

template <class T, std::size_t kCount>
std::array<T, kCount> numbers(const ExrPart& part, std::string_view name) {
    std::array<T, kCount> result;
    std::memcpy(result.data(), part.find(name)->value.data(), sizeof result);
    return result;
}

// What of a part says how it lies in chunks.
struct Layout {
    std::int64_t width, height;
    std::int32_t top;
    std::uint64_t pixel_size = 0;  // bytes of all channels
    int lines = 0;                 // of a chunk, if there are no tiles
    std::int64_t tile_width = 0, tile_height = 0;
    bool has_levels = false, rounds_up = false;

    [[nodiscard]] int level_count() const {
        if (!has_levels) return 1;
        int count = 1;
        while (level_size(std::max(width, height), count - 1) > 1) ++count;
        return count;
    }
    [[nodiscard]] std::int64_t level_size(std::int64_t size, int level) const {
        const std::int64_t rest = rounds_up ? (std::int64_t{1} << level) - 1 : 0;
        return std::max<std::int64_t>((size + rest) >> level, 1);
    }
};

std::uint64_t pixel_size(const InputFile& file, const ExrPart& part) {
    constexpr std::uint64_t kSizeOf[] = {4, 2, 4};  // whole numbers, half and full floats
    std::uint64_t size = 0;
    for (const Channel& channel : parse_channels(file, part.find("channels")->value)) {
        if (channel.x_sampling != 1 || channel.y_sampling != 1)
            file.fail(sub_sampled(channel.name, channel.x_sampling, channel.y_sampling));
        if (channel.type < 0 || channel.type >= static_cast<int>(std::size(kSizeOf)))
            file.fail(fmt::format("its channel {} has values of an unknown type", channel.name));
        size += kSizeOf[channel.type];
    }
    return size;
}

void take_tiles(const InputFile& file, const ExrPart& part, Layout& layout) {
    if (!part.find("tiles")) file.fail("has no attribute tiles");
    const auto [tile_width, tile_height] = numbers<std::uint32_t, 2>(part, "tiles");
    layout.tile_width = tile_width, layout.tile_height = tile_height;
    // Each is set aside whole, be the picture as small as it may.
    const double texels = double(layout.tile_width) * double(layout.tile_height);
    const double pixels = double(layout.width) * double(layout.height);
    if (texels < 1 || texels > std::max(4 * pixels, double{1 << 22}))
        file.fail(
            tiles_too_large(layout.tile_width, layout.tile_height, layout.width, layout.height));
    const auto mode = std::to_integer<unsigned>(part.find("tiles")->value[8]);
    if ((mode & 15) == 2) file.fail(kRipmapLevels);
    if ((mode & 15) > 2 || mode >> 4 > 1) file.fail("has levels of an unknown kind");
    layout.has_levels = (mode & 15) == 1;
    layout.rounds_up = mode >> 4 == 1;
}

Layout layout_of(const InputFile& file, const ExrPart& part) {
    const auto [left, top, right, bottom] = numbers<std::int32_t, 4>(part, "dataWindow");
    Layout layout{std::int64_t{right} - left + 1, std::int64_t{bottom} - top + 1, top};
    if (layout.width < 1 || layout.height < 1)
        file.fail(fmt::format("its data window is {} x {}", layout.width, layout.height));
    layout.pixel_size = pixel_size(file, part);
    if (part.is_tiled) {
        take_tiles(file, part, layout);
    } else {
        const Compression* method = compression_of(part);
        if (!method) file.fail("is compressed by an unknown method");
        layout.lines = method->lines;
    }
    return layout;
}

// In the order of the table: place says where in the picture it lies, as its own words do.
struct Chunk {
    std::vector<std::int32_t> place;
    std::uint64_t plain_size;  // its bytes, not compressed
};

template <class Use>
void for_each_tile(const Layout& layout, Use&& use) {
    const int level_count = layout.level_count();
    for (int level = 0; level < level_count; ++level) {
        const std::int64_t width = layout.level_size(layout.width, level),
                           height = layout.level_size(layout.height, level);
        for (std::int64_t top = 0, y = 0; top < height; top += layout.tile_height, ++y) {
            const std::int64_t lines = std::min(layout.tile_height, height - top);
            for (std::int64_t left = 0, x = 0; left < width; left += layout.tile_width, ++x) {
                const std::int64_t texels = lines * std::min(layout.tile_width, width - left);
                use(Chunk{
                    {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), level, level},
                    texels * layout.pixel_size});
            }
        }
    }
}

template <class Use>
void for_each_chunk(const Layout& layout, Use&& use) {
    if (layout.lines == 0) return for_each_tile(layout, use);
    for (std::int64_t y = 0; y < layout.height; y += layout.lines) {
        const auto lines = std::min<std::int64_t>(layout.lines, layout.height - y);
        use(Chunk{{static_cast<std::int32_t>(layout.top + y)},
                  lines * layout.width * layout.pixel_size});
    }
}

std::uint32_t chunk_count(const InputFile& file, const ExrPart& part) {
    if (!part.find("chunkCount"))
        file.fail("has several parts, and one without the attribute chunkCount");
    return numbers<std::uint32_t, 1>(part, "chunkCount")[0];
}

void append(std::vector<std::byte>& to, std::span<const std::byte> bytes) {
    to.resize(to.size() + bytes.size());
    std::copy(bytes.begin(), bytes.end(), to.end() - static_cast<std::ptrdiff_t>(bytes.size()));
}

template <class T>
void append_number(std::vector<std::byte>& to, T value) {
    append(to, std::as_bytes(std::span<const T>(&value, 1)));
}

void append_attribute(std::vector<std::byte>& to, const ExrPart::Attribute& attribute) {
    for (const std::string* text : {&attribute.name, &attribute.type}) {
        append(to, std::as_bytes(std::span<const char>(text->data(), text->size())));
        to.push_back(std::byte{0});
    }
    append_number(to, static_cast<std::uint32_t>(attribute.value.size()));
    append(to, attribute.value);
}

// Of a file with this part alone: what a picture needs and no more. Chunks say where they lie, so
// the order of the lines is the usual one.
std::vector<std::byte> plain_header(const ExrPart& part) {
    constexpr std::byte kIncreasingLines{0};
    std::vector<std::byte> header;
    append_number(header, kMagic);
    append_number(header, std::uint32_t{2} | (part.is_tiled ? kTiled : 0u) | kLongNames);
    for (const std::string_view name : kNeeded) {
        ExrPart::Attribute attribute = *part.find(name);
        if (name == "lineOrder") attribute.value = {&kIncreasingLines, 1};
        append_attribute(header, attribute);
    }
    if (part.is_tiled) append_attribute(header, *part.find("tiles"));
    header.push_back(std::byte{0});
    return header;
}

}  // namespace

const ExrPart::Attribute* ExrPart::find(std::string_view name) const {
    const auto found = std::find_if(attributes.begin(), attributes.end(),
                                    [&](const Attribute& one) { return one.name == name; });
    return found == attributes.end() ? nullptr : &*found;
}

std::string_view ExrPart::compression() const {
    const Compression* method = compression_of(*this);
    return method ? method->name : "an unknown method";
}

ExrParts parse_exr_headers(const InputFile& file, std::span<const std::byte> bytes) {
    Reader reader(file, bytes);
    if (reader.number<std::uint32_t>() != kMagic) file.fail("is no OpenEXR file");
    const auto version = reader.number<std::uint32_t>();
    if ((version & kVersionMask) != 2)
        file.fail(fmt::format("is of version {} of OpenEXR, expected 2", version & kVersionMask));
    ExrParts result;
    result.is_multipart = (version & kMultipart) != 0;
    do {
        result.parts.push_back(parse_part(file, reader));
    } while (result.is_multipart && bytes.size() > reader.position() &&
             bytes[reader.position()] != std::byte{0});
    if (result.is_multipart) {
        reader.take(1);
    } else {
        result.parts.front().is_deep |= (version & kDeep) != 0;
        result.parts.front().is_tiled = (version & kTiled) != 0;
    }
    result.headers_end = reader.position();
    return result;
}

std::vector<std::byte> checked_part(const InputFile& file, std::span<const std::byte> bytes,
                                    const ExrParts& parts, std::size_t part) {
    const ExrPart& chosen = parts.parts[part];
    const Layout layout = layout_of(file, chosen);
    const bool is_plain = chosen.compression() == kPlain;
    Reader table(file, bytes, parts.headers_end);
    for (std::size_t i = 0; i < part; ++i)
        table.take(std::uint64_t{8} * chunk_count(file, parts.parts[i]));

    std::vector<std::uint64_t> offsets;
    std::vector<std::byte> chunks;
    for_each_chunk(layout, [&](const Chunk& expected) {
        const auto offset = table.number<std::uint64_t>();
        if (offset == 0) file.fail(kNeverWritten);
        if (offset > bytes.size())
            file.fail(
                fmt::format("is truncated: refers to byte {}, but has {}", offset, bytes.size()));
        Reader chunk(file, bytes, static_cast<std::size_t>(offset));
        if (parts.is_multipart) {
            const auto number = chunk.number<std::uint32_t>();
            if (number != part)
                file.fail(fmt::format("chunk {} of its part {} is of part {}", offsets.size(),
                                      part + 1, number + 1));
        }
        offsets.push_back(chunks.size());
        for (const std::int32_t place : expected.place) {
            const auto found = chunk.number<std::int32_t>();
            if (found != place)
                file.fail(fmt::format("its chunk {} is at {}, expected {}", offsets.size() - 1,
                                      found, place));
            append_number(chunks, found);
        }
        const auto size = chunk.number<std::uint32_t>();
        if (size == 0 || size > expected.plain_size || (is_plain && size < expected.plain_size))
            file.fail(fmt::format("its chunk {} has {} bytes for {} of pixels", offsets.size() - 1,
                                  size, expected.plain_size));
        append_number(chunks, size);
        append(chunks, chunk.take(size));
        // Else a short file could stand for a long one.
        if (chunks.size() > bytes.size()) file.fail("its chunks lie upon one another");
    });

    if (chosen.find("chunkCount") && chunk_count(file, chosen) != offsets.size())
        file.fail(
            fmt::format("has {} chunks, expected {}", chunk_count(file, chosen), offsets.size()));

    std::vector<std::byte> result = plain_header(chosen);
    const std::uint64_t chunks_begin = result.size() + 8 * offsets.size();
    for (const std::uint64_t offset : offsets) append_number(result, chunks_begin + offset);
    append(result, chunks);
    return result;
}

}  // namespace mirrorball::detail
