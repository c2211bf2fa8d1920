// The layout, numbers being little-endian:
//
//     magic, version and flags
//     a header for each part: attributes (name, type, size, value), a zero; of several parts one
//     more zero behind the last header
//     a table for each part: where in the file each of its chunks begins
//     chunks: the part's number, if there are several; where in the picture it lies (a scanline's
//     y, or a tile's place and level); its size; its bytes
//
// A part alone is then the same with other numbers in its table, and no part's number.
#include "exr_parts.h"

#include <algorithm>
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
constexpr Compression kCompressions[] = {{"no method", 1}, {"RLE", 1},    {"ZIPS", 1}, {"ZIP", 16},
                                         {"PIZ", 32},      {"PXR24", 16}, {"B44", 32}, {"B44A", 32},
                                         {"DWAA", 32},     {"DWAB", 256}};

// Attributes whose size a reader takes for granted.
struct Expected {
    std::string_view name;
    std::size_t size;
};
constexpr Expected kSizes[] = {{"compression", 1},    {"tiles", 9},      {"dataWindow", 16},
                               {"displayWindow", 16}, {"chunkCount", 4}, {"lineOrder", 1}};

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

std::vector<std::string> channel_names(const InputFile& file, std::span<const std::byte> list) {
    constexpr std::size_t kBehindName = 16;  // type, linearity, sampling along x and y
    std::vector<std::string> names;
    Reader reader(file, list);
    for (std::string name = reader.text(); !name.empty(); name = reader.text()) {
        names.push_back(std::move(name));
        reader.take(kBehindName);
    }
    return names;
}

std::string text_of(const ExrPart& part, std::string_view name) {
    const ExrPart::Attribute* found = part.find(name);
    if (!found) return {};
    return {reinterpret_cast<const char*>(found->value.data()), found->value.size()};
}

ExrPart parse_part(const InputFile& file, std::span<const std::byte> bytes, Reader& reader) {
    ExrPart part;
    const std::size_t begin = reader.position();
    for (std::string name = reader.text(); !name.empty(); name = reader.text()) {
        ExrPart::Attribute attribute{std::move(name), reader.text(), {}};
        attribute.value = reader.take(reader.number<std::uint32_t>());
        for (const Expected& expected : kSizes)
            if (attribute.name == expected.name && attribute.value.size() != expected.size)
                file.fail(fmt::format("its attribute {} has {} bytes, expected {}", attribute.name,
                                      attribute.value.size(), expected.size));
        part.attributes.push_back(std::move(attribute));
    }
    part.header = bytes.subspan(begin, reader.position() - begin);
    for (const std::string_view needed : {"channels", "compression", "dataWindow", "displayWindow"})
        if (!part.find(needed)) file.fail(fmt::format("has no attribute {}", needed));
    part.channels = channel_names(file, part.find("channels")->value);
    const std::string type = text_of(part, "type");
    part.is_deep = type.starts_with("deep");
    part.is_tiled = type == "tiledimage";
    return part;
}

const Compression* compression_of(const ExrPart& part) {
    const auto code = std::to_integer<std::size_t>(part.find("compression")->value[0]);
    return code < std::size(kCompressions) ? &kCompressions[code] : nullptr;
}

// Lines that no chunk holds would be whatever memory held before.
void check_chunk_count(const InputFile& file, const ExrPart& part) {
    const ExrPart::Attribute* count = part.find("chunkCount");
    const Compression* method = compression_of(part);
    if (!count || !method || part.is_tiled || part.is_deep) return;
    std::int32_t said = 0, top = 0, bottom = 0;
    std::memcpy(&said, count->value.data(), sizeof said);
    const std::byte* window = part.find("dataWindow")->value.data();
    std::memcpy(&top, window + 4, sizeof top);
    std::memcpy(&bottom, window + 12, sizeof bottom);
    const std::int64_t lines = std::int64_t{bottom} - top + 1;
    const std::int64_t needed = (lines + method->lines - 1) / method->lines;
    if (lines > 0 && said != needed)
        file.fail(fmt::format("has {} chunks of {} lines, expected {}", said, lines, needed));
}

std::uint32_t chunk_count(const InputFile& file, const ExrPart& part) {
    const ExrPart::Attribute* count = part.find("chunkCount");
    if (!count) file.fail("has several parts, and one without the attribute chunkCount");
    std::uint32_t value = 0;
    std::memcpy(&value, count->value.data(), sizeof value);
    return value;
}

void append(std::vector<std::byte>& to, std::span<const std::byte> bytes) {
    to.resize(to.size() + bytes.size());
    std::copy(bytes.begin(), bytes.end(), to.end() - static_cast<std::ptrdiff_t>(bytes.size()));
}

template <class T>
void append_number(std::vector<std::byte>& to, T value) {
    append(to, std::as_bytes(std::span<const T>(&value, 1)));
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
    result.has_long_names = (version & kLongNames) != 0;
    do {
        result.parts.push_back(parse_part(file, bytes, reader));
    } while (result.is_multipart && bytes.size() > reader.position() &&
             bytes[reader.position()] != std::byte{0});
    if (result.is_multipart) {
        reader.take(1);
    } else {
        result.parts.front().is_deep |= (version & kDeep) != 0;
        result.parts.front().is_tiled = (version & kTiled) != 0;
    }
    for (const ExrPart& part : result.parts) check_chunk_count(file, part);
    result.headers_end = reader.position();
    return result;
}

std::vector<std::byte> single_part(const InputFile& file, std::span<const std::byte> bytes,
                                   const ExrParts& parts, std::size_t part) {
    const ExrPart& chosen = parts.parts[part];
    Reader table(file, bytes, parts.headers_end);
    for (std::size_t i = 0; i < part; ++i)
        table.take(std::uint64_t{8} * chunk_count(file, parts.parts[i]));
    const std::uint32_t count = chunk_count(file, chosen);
    // Is the table there? Before anything is set aside for it.
    Reader(table).take(std::uint64_t{8} * count);

    std::vector<std::byte> result;
    append_number(result, kMagic);
    append_number(result, std::uint32_t{2} | (chosen.is_tiled ? kTiled : 0u) |
                              (parts.has_long_names ? kLongNames : 0u));
    append(result, chosen.header);
    std::vector<std::byte> chunks;
    const std::uint64_t chunks_begin = result.size() + std::uint64_t{8} * count;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto offset = table.number<std::uint64_t>();
        if (offset == 0) file.fail(kNeverWritten);
        if (offset > bytes.size())
            file.fail(
                fmt::format("is truncated: refers to byte {}, but has {}", offset, bytes.size()));
        Reader chunk(file, bytes, static_cast<std::size_t>(offset));
        const auto number = chunk.number<std::uint32_t>();
        if (number != part)
            file.fail(
                fmt::format("chunk {} of its part {} is of part {}", i, part + 1, number + 1));
        const std::span<const std::byte> place = chunk.take(chosen.is_tiled ? 16 : 4);
        const auto size = chunk.number<std::uint32_t>();
        append_number(result, chunks_begin + chunks.size());
        append(chunks, place);
        append_number(chunks, size);
        append(chunks, chunk.take(size));
        // Else a short file could stand for a long one.
        if (chunks.size() > bytes.size()) file.fail("its chunks lie upon one another");
    }
    append(result, chunks);
    return result;
}

}  // namespace mirrorball::detail
