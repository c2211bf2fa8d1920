// KTX 2.0: textures as graphics interfaces take them, in one file with all faces and levels.
// Khronos, "KTX File Format Specification", version 2.0; "Khronos Data Format Specification" 1.3.
//
//     0   identifier        12 bytes
//     12  header            vkFormat typeSize width height depth layers faces levels
//     supercompression 48  index             offset and length of: descriptor, key/values, global
//     data (ours: none) 80  level index       per level, base first: offset, length, length before
//     supercompression
//         descriptor        what the bits of a texel mean; follows from vkFormat
//         key/values        sorted by key; ours are strings with a NUL
//         levels            smallest first, so that a stream can be shown before it has all come;
//                           each begins at a multiple of lcm(texel bytes, 4), or anywhere once
//                           supercompressed; in it the faces, tightly packed
//
// We read and write single 2-D pictures and cubes. Arrays, volumes and block compression are
// refused.
#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include <mirrorball/error.h>

#include "codec.h"
#include "orientation.h"
#include "packed.h"
#include "zstandard.h"

namespace mirrorball::detail {
namespace {

// Numbers are copied between files and memory as they are.
static_assert(std::endian::native == std::endian::little);

constexpr std::array<unsigned char, 12> kIdentifier = {0xAB, 'K',  'T',  'X',  ' ',  '2',
                                                       '0',  0xBB, '\r', '\n', 0x1A, '\n'};

struct Header {
    std::uint32_t vk_format, type_size, width, height, depth, layer_count, face_count, level_count,
        supercompression;
    std::uint32_t descriptor_offset, descriptor_length, key_value_offset, key_value_length;
    std::uint64_t global_offset, global_length;
};
// In the file the 64-bit numbers follow the 32-bit ones at once; in memory there is a gap.
constexpr std::size_t kHeaderBytes32 = 13 * 4;
constexpr std::uint64_t kLevelIndexOffset = sizeof(kIdentifier) + kHeaderBytes32 + 2 * 8;

struct LevelEntry {
    std::uint64_t offset, length, unpacked_length;
};

constexpr std::uint32_t kNone = 0, kBasis = 1, kZstandard = 2, kZlib = 3;

// The formats that we know, with their numbers in Vulkan and the size of what a big-endian machine
// would have to swap.
struct Format {
    std::uint32_t vk_format;
    std::uint32_t type_size;
    Packing packing;
};
constexpr Format kFormats[] = {
    {97, 2, Packing::rgba16f},      // R16G16B16A16_SFLOAT
    {109, 4, Packing::rgba32f},     // R32G32B32A32_SFLOAT
    {123, 4, Packing::rgb9e5},      // E5B9G9R9_UFLOAT_PACK32
    {122, 4, Packing::b10g11r11f},  // B10G11R11_UFLOAT_PACK32
    {106, 4, Packing::rgb32f},      // R32G32B32_SFLOAT
    {90, 2, Packing::rgb16f},       // R16G16B16_SFLOAT
    {37, 1, Packing::rgba8},        // R8G8B8A8_UNORM
    {43, 1, Packing::rgba8_srgb},   // R8G8B8A8_SRGB
};

const Format& format_for(Packing packing) {
    return *std::find_if(std::begin(kFormats), std::end(kFormats),
                         [&](const Format& f) { return f.packing == packing; });
}

// A few that users meet and that we do not read, so that the message can say what it was.
std::string format_in_words(std::uint32_t vk_format) {
    switch (vk_format) {
        case 0:
            return "VK_FORMAT_UNDEFINED, as Basis Universal textures have";
        case 143:
            return "143 (BC6H_UFLOAT_BLOCK)";
        case 144:
            return "144 (BC6H_SFLOAT_BLOCK)";
        default:
            if (vk_format >= 131 && vk_format <= 146)
                return fmt::format("{} (a BC block)", vk_format);
            if (vk_format >= 147 && vk_format <= 156)
                return fmt::format("{} (an ETC block)", vk_format);
            if (vk_format >= 157 && vk_format <= 184)
                return fmt::format("{} (an ASTC block)", vk_format);
            return fmt::format("{}", vk_format);
    }
}

std::uint64_t round_up(std::uint64_t value, std::uint64_t step) {
    return (value + step - 1) / step * step;
}

std::uint64_t level_alignment(Packing packing, std::uint32_t supercompression) {
    return supercompression == kNone ? std::lcm(texel_bytes(packing), 4) : 1;
}

std::uint64_t level_bytes(Packing packing, int face_count, int width, int height) {
    return std::uint64_t(width) * height * face_count * texel_bytes(packing);
}

// Data format descriptor --------------------------------------------------------------------------

constexpr std::uint8_t kRed = 0, kGreen = 1, kBlue = 2, kAlpha = 15;
constexpr std::uint8_t kLinearFlag = 0x10, kExponentFlag = 0x20, kSignedFlag = 0x40,
                       kFloatFlag = 0x80;
constexpr std::uint32_t kFloatOne = 0x3F800000, kFloatMinusOne = 0xBF800000;
constexpr std::uint8_t kPrimariesBt709 = 1, kTransferLinear = 1, kTransferSrgb = 2;

struct Sample {
    std::uint16_t bit_offset;
    std::uint8_t bit_length_less_one;
    std::uint8_t channel_and_flags;
    std::uint32_t position;      // of the sample in the texel block: its only texel
    std::uint32_t lower, upper;  // what stands for 0 (or -1) and for 1; of floats, their bits
};
static_assert(sizeof(Sample) == 16);

struct Descriptor {
    std::uint32_t total_length;
    std::uint32_t vendor_and_type;  // 0: Khronos, basic
    std::uint16_t version;
    std::uint16_t block_length;
    std::uint8_t colour_model, primaries, transfer, flags;
    std::uint8_t block_dimensions[4];  // less one
    std::uint8_t plane_bytes[8];
};
static_assert(sizeof(Descriptor) == 28);

Sample sample(int bit_offset, int bit_length, int channel_and_flags, std::uint32_t lower,
              std::uint32_t upper) {
    return {static_cast<std::uint16_t>(bit_offset),
            static_cast<std::uint8_t>(bit_length - 1),
            static_cast<std::uint8_t>(channel_and_flags),
            0,
            lower,
            upper};
}

std::vector<Sample> samples(Packing packing) {
    constexpr std::uint8_t kChannels[] = {kRed, kGreen, kBlue, kAlpha};
    std::vector<Sample> result;
    switch (packing) {
        case Packing::b10g11r11f:
            return {sample(0, 11, kRed | kFloatFlag, 0, kFloatOne),
                    sample(11, 11, kGreen | kFloatFlag, 0, kFloatOne),
                    sample(22, 10, kBlue | kFloatFlag, 0, kFloatOne)};
        case Packing::rgb9e5:
            // Each channel is a mantissa and, after it, the exponent that all share. The figures
            // for `upper` are those of the Data Format Specification's example of this format.
            for (int c = 0; c < 3; ++c) {
                result.push_back(sample(9 * c, 9, kChannels[c], 0, 8448));
                result.push_back(sample(27, 5, kChannels[c] | kExponentFlag, 15, 31));
            }
            return result;
        case Packing::rgba8:
        case Packing::rgba8_srgb:
            for (int c = 0; c < 4; ++c) {
                const bool uncurved = packing == Packing::rgba8_srgb && c == 3;
                result.push_back(
                    sample(8 * c, 8, kChannels[c] | (uncurved ? kLinearFlag : 0), 0, 255));
            }
            return result;
        default: {
            const int bits = 8 * texel_bytes(packing) / channel_count(packing);
            for (int c = 0; c < channel_count(packing); ++c)
                result.push_back(sample(bits * c, bits, kChannels[c] | kFloatFlag | kSignedFlag,
                                        kFloatMinusOne, kFloatOne));
            return result;
        }
    }
}

// plane_bytes stay those of the texels when levels are supercompressed: so KTX-Software since 4.4
// and the revised specification; before it they were to be 0, which made some formats undecodable.
std::vector<std::byte> descriptor_bytes(Packing packing) {
    const std::vector<Sample> all = samples(packing);
    Descriptor d{};
    d.block_length =
        static_cast<std::uint16_t>(sizeof(Descriptor) - 4 + all.size() * sizeof(Sample));
    d.total_length = 4 + d.block_length;
    d.version = 2;
    d.colour_model = 1;  // RGBSDA
    d.primaries = kPrimariesBt709;
    d.transfer = packing == Packing::rgba8_srgb ? kTransferSrgb : kTransferLinear;
    d.plane_bytes[0] = static_cast<std::uint8_t>(texel_bytes(packing));

    std::vector<std::byte> bytes(d.total_length);
    std::memcpy(bytes.data(), &d, sizeof d);
    std::memcpy(bytes.data() + sizeof d, all.data(), all.size() * sizeof(Sample));
    return bytes;
}

// Only what could change the meaning of the texels; the rest follows from vkFormat.
void read_descriptor(InputFile& file, const Header& header, FileContents& contents) {
    if (header.descriptor_length < sizeof(Descriptor))
        file.fail(fmt::format("its data format descriptor has {} bytes (at least {} were expected)",
                              header.descriptor_length, sizeof(Descriptor)));
    file.seek(header.descriptor_offset);
    const auto d = file.read_value<Descriptor>();
    if (d.total_length != header.descriptor_length)
        file.fail(fmt::format("its data format descriptor says {} bytes, its index {}",
                              d.total_length, header.descriptor_length));
    if (d.primaries != 0 && d.primaries != kPrimariesBt709)
        contents.notes.push_back(fmt::format(
            "has colour primaries number {}; its values are kept as they are, as if Rec. 709",
            d.primaries));
}

// Key/values --------------------------------------------------------------------------------------

constexpr std::string_view kOrientationKey = "KTXorientation", kWriterKey = "KTXwriter";

void append_key_value(std::vector<std::byte>& bytes, std::string_view key, std::string_view value) {
    const auto append = [&](const void* data, std::size_t size) {
        const auto* from = static_cast<const std::byte*>(data);
        bytes.insert(bytes.end(), from, from + size);
    };
    const auto length = static_cast<std::uint32_t>(key.size() + 1 + value.size() + 1);
    append(&length, sizeof length);
    append(key.data(), key.size());
    bytes.push_back(std::byte{0});
    append(value.data(), value.size());
    bytes.push_back(std::byte{0});
    bytes.resize(round_up(bytes.size(), 4));
}

// Keys that begin with KTX describe a file, not its content: a source file's are not passed on.
std::vector<std::byte> key_value_bytes(const Metadata& metadata) {
    Metadata all;  // sorted by bytes, which for UTF-8 is by code point
    for (const auto& [key, value] : metadata)
        if (!key.empty() && !key.starts_with("KTX") && !key.starts_with("ktx")) all[key] = value;
    all[std::string(kOrientationKey)] = "rd";  // s to the right, t down
    all[std::string(kWriterKey)] = "mirrorball " MIRRORBALL_VERSION;

    std::vector<std::byte> bytes;
    for (const auto& [key, value] : all)
        // A NUL would end the key, or the value for most readers.
        append_key_value(bytes, key.substr(0, key.find('\0')), value.substr(0, value.find('\0')));
    return bytes;
}

bool is_text(std::string_view value) {
    return std::none_of(value.begin(), value.end(), [](char c) {
        const auto code = static_cast<unsigned char>(c);
        return code == 0x7f || (code < 0x20 && c != '\n' && c != '\t' && c != '\r');
    });
}

// Values may be binary; those are of other programs and are left out.
Metadata read_key_values(InputFile& file, const Header& header) {
    Metadata metadata;
    if (header.key_value_length == 0) return metadata;
    std::vector<char> block(header.key_value_length);
    file.seek(header.key_value_offset);
    file.read(std::as_writable_bytes(std::span(block)));

    std::string_view rest(block.data(), block.size());
    while (rest.size() >= 4) {
        std::uint32_t length;
        std::memcpy(&length, rest.data(), 4);
        rest.remove_prefix(4);
        if (length < 2 || length > rest.size())
            file.fail(fmt::format("a key/value pair claims {} bytes, and {} are left", length,
                                  rest.size()));
        const std::string_view pair = rest.substr(0, length);
        const std::size_t end = pair.find('\0');
        if (end == std::string_view::npos || end == 0)
            file.fail("a key/value pair has no key that ends in a NUL");
        std::string_view value = pair.substr(end + 1);
        if (value.ends_with('\0')) value.remove_suffix(1);
        if (is_text(value)) metadata[std::string(pair.substr(0, end))] = value;
        rest.remove_prefix(std::min<std::size_t>(round_up(length, 4), rest.size()));
    }
    return metadata;
}

// Reading -----------------------------------------------------------------------------------------

void check_range(const InputFile& file, std::string_view what, std::uint64_t offset,
                 std::uint64_t length) {
    if (offset > file.size() || length > file.size() - offset)
        file.fail(fmt::format("its {} is at byte {} with {} bytes, and the file has {}", what,
                              offset, length, file.size()));
}

Header read_header(InputFile& file) {
    std::array<unsigned char, 12> identifier;
    file.read(std::as_writable_bytes(std::span(identifier)));
    if (identifier != kIdentifier) file.fail("does not begin as a KTX2 file does");
    Header h{};
    file.read(std::as_writable_bytes(std::span(&h, 1)).first(kHeaderBytes32));
    h.global_offset = file.read_value<std::uint64_t>();
    h.global_length = file.read_value<std::uint64_t>();
    return h;
}

const Format& check_header(const InputFile& file, const Header& h) {
    const auto* format = std::find_if(std::begin(kFormats), std::end(kFormats),
                                      [&](const Format& f) { return f.vk_format == h.vk_format; });
    if (format == std::end(kFormats))
        file.fail(
            fmt::format("its texel format is {}; read are half and float RGB and RGBA, "
                        "E5B9G9R9, B10G11R11 and 8-bit RGBA",
                        format_in_words(h.vk_format)));
    if (h.supercompression != kNone && h.supercompression != kZstandard)
        file.fail(fmt::format("its supercompression is {}{}; read are none (0) and Zstandard (2)",
                              h.supercompression,
                              h.supercompression == kBasis  ? " (BasisLZ)"
                              : h.supercompression == kZlib ? " (ZLIB)"
                                                            : ""));
    if (h.depth != 0)
        file.fail(fmt::format("is a volume of depth {}; read are 2-D and cubes", h.depth));
    if (h.layer_count != 0)
        file.fail(fmt::format("is an array of {} layers; read are single pictures and cubes",
                              h.layer_count));
    if (h.face_count != 1 && h.face_count != 6)
        file.fail(fmt::format("has {} faces (1 or 6 were expected)", h.face_count));
    if (h.width < 1 || h.height < 1)
        file.fail(
            fmt::format("is {} x {} texels; 2-D pictures and cubes have both", h.width, h.height));
    if (h.face_count == 6 && h.width != h.height)
        file.fail(fmt::format("its cube faces are {} x {} texels, not square", h.width, h.height));
    return *format;
}

// Reads one level's bytes as they are once unpacked.
void read_level(InputFile& file, const LevelEntry& entry, std::uint32_t supercompression,
                std::span<std::byte> out) {
    file.seek(entry.offset);
    if (supercompression == kNone) {
        file.read(out);
        return;
    }
    std::vector<std::byte> packed(entry.length);
    file.read(packed);
    unpack_zstandard(file, packed, out);
}

// Our pictures run to the right and down; a cube of any other orientation is not valid KTX2.
void apply_orientation(const InputFile& file, FileContents& contents) {
    const auto found = contents.metadata.find(std::string(kOrientationKey));
    if (found == contents.metadata.end() || found->second == "rd") return;
    const std::string& orientation = found->second;
    const bool known = orientation == "ru" || orientation == "ld" || orientation == "lu";
    if (!known || contents.levels.front().size() == 6)
        file.fail(fmt::format("its KTXorientation is '{}' ('rd' was expected)", orientation));
    const Orientation stored{false, orientation[0] == 'l', orientation[1] == 'u'};
    for (auto& faces : contents.levels) faces.front() = oriented(std::move(faces.front()), stored);
    contents.notes.push_back(
        fmt::format("its KTXorientation '{}' was turned to 'rd'", orientation));
}

bool recognises(std::span<const std::byte> head) {
    return head.size() >= kIdentifier.size() &&
           std::memcmp(head.data(), kIdentifier.data(), kIdentifier.size()) == 0;
}

FileContents read(InputFile& file, const ReadOptions& options) {
    const Header header = read_header(file);
    const Format& format = check_header(file, header);
    const int face_count = static_cast<int>(header.face_count);

    // A level count of 0 asks the reader to make the mips; what is stored is the base.
    const std::uint32_t level_count = std::max(header.level_count, 1u);
    constexpr std::uint32_t kMostLevels =
        21;  // of the largest side that check_claim() lets through
    if (level_count > kMostLevels) file.fail(fmt::format("claims {} levels", level_count));

    // A Zstandard block holds at most 2^17 bytes and takes at least 4: its header and one byte.
    constexpr double kLargestRatio = 1 << 15;
    const double texels = double(header.width) * header.height * face_count;
    const double base_bytes = texels * texel_bytes(format.packing);
    const double least = header.supercompression == kNone ? base_bytes : base_bytes / kLargestRatio;
    if (least > static_cast<double>(file.remaining()))
        file.fail(
            fmt::format("is truncated: {} x {} texels need at least {:.0f} bytes, and {} are left",
                        header.width, header.height, least, file.remaining()));
    check_claim(file, header.width, header.height, channel_count(format.packing),
                image_count_bound(face_count, static_cast<int>(level_count)),
                static_cast<std::uint64_t>(least), options);
    const int width = static_cast<int>(header.width), height = static_cast<int>(header.height);
    if (static_cast<int>(level_count) > possible_level_count(width, height))
        file.fail(fmt::format("claims {} levels; {} x {} texels can have {}", level_count, width,
                              height, possible_level_count(width, height)));

    std::vector<LevelEntry> entries(level_count);
    file.read(std::as_writable_bytes(std::span(entries)));
    check_range(file, "data format descriptor", header.descriptor_offset, header.descriptor_length);
    check_range(file, "key/value data", header.key_value_offset, header.key_value_length);

    FileContents contents;
    contents.format = kKtx2.name;
    contents.stored = texel_format(format.packing);
    if (face_count == 6) contents.projection = Projection::cube;
    read_descriptor(file, header, contents);
    contents.metadata = read_key_values(file, header);

    const Packing packing = with_transfer(format.packing, options.transfer);
    std::vector<std::byte> bytes;
    for (int level = 0; level < static_cast<int>(level_count); ++level) {
        const LevelEntry& entry = entries[level];
        const int w = level_size(width, level), h = level_size(height, level);
        const std::uint64_t expected = level_bytes(packing, face_count, w, h);
        check_range(file, fmt::format("level {}", level), entry.offset, entry.length);
        if (entry.unpacked_length != expected ||
            (header.supercompression == kNone && entry.length != expected))
            file.fail(fmt::format("level {} has {} bytes, unpacked {} ({} were expected)", level,
                                  entry.length, entry.unpacked_length, expected));
        bytes.resize(expected);
        read_level(file, entry, header.supercompression, bytes);

        std::vector<Image>& faces = contents.levels.emplace_back();
        const std::uint64_t face_bytes = expected / face_count;
        for (int face = 0; face < face_count; ++face)
            faces.push_back(
                unpack(packing, std::span(bytes).subspan(face * face_bytes, face_bytes), w, h));
    }
    drop_opaque_alpha(contents);
    apply_orientation(file, contents);
    return contents;
}

// Writing -----------------------------------------------------------------------------------------

std::vector<std::byte> packed_faces(Packing packing,
                                    const std::vector<ContentsView::Picture>& faces) {
    const Image& first = faces.front();
    const std::uint64_t face_bytes = level_bytes(packing, 1, first.width(), first.height());
    std::vector<std::byte> bytes(face_bytes * faces.size());
    for (std::size_t face = 0; face < faces.size(); ++face)
        pack(packing, faces[face], std::span(bytes).subspan(face * face_bytes, face_bytes));
    return bytes;
}

void pad_to(OutputFile& file, std::uint64_t alignment) {
    const std::vector<std::byte> zeros(round_up(file.position(), alignment) - file.position());
    file.write(zeros);
}

void write_header(OutputFile& file, const Header& h) {
    file.write(std::as_bytes(std::span(kIdentifier)));
    file.write(std::as_bytes(std::span(&h, 1)).first(kHeaderBytes32));
    file.write_value(h.global_offset);
    file.write_value(h.global_length);
}

void write(OutputFile& file, const ContentsView& contents, const WriteOptions& options) {
    require_halved_levels(file, contents);
    const Packing packing = packing_for(options.format);
    const Format& format = format_for(packing);
    const int face_count = static_cast<int>(contents.levels.front().size());
    const int level_count = static_cast<int>(contents.levels.size());
    const Image& base = contents.levels.front().front();
    const std::vector<std::byte> descriptor = descriptor_bytes(packing);
    const std::vector<std::byte> key_values = key_value_bytes(contents.metadata);
    std::vector<LevelEntry> entries(level_count);

    Header h{};
    h.vk_format = format.vk_format;
    h.type_size = format.type_size;
    h.width = static_cast<std::uint32_t>(base.width());
    h.height = static_cast<std::uint32_t>(base.height());
    h.face_count = static_cast<std::uint32_t>(face_count);
    h.level_count = static_cast<std::uint32_t>(level_count);
    h.supercompression = options.compress.value_or(false) ? kZstandard : kNone;
    h.descriptor_offset =
        static_cast<std::uint32_t>(kLevelIndexOffset + entries.size() * sizeof(LevelEntry));
    h.descriptor_length = static_cast<std::uint32_t>(descriptor.size());
    h.key_value_offset = h.descriptor_offset + h.descriptor_length;
    h.key_value_length = static_cast<std::uint32_t>(key_values.size());

    write_header(file, h);
    file.write(std::as_bytes(std::span(entries)));  // their room, until their figures are known
    file.write(descriptor);
    file.write(key_values);

    for (int level = level_count - 1; level >= 0; --level) {
        const std::vector<ContentsView::Picture>& faces = contents.levels[level];
        pad_to(file, level_alignment(packing, h.supercompression));
        LevelEntry& entry = entries[level];
        entry.offset = file.position();
        entry.unpacked_length = level_bytes(packing, face_count, level_size(base.width(), level),
                                            level_size(base.height(), level));
        if (h.supercompression == kZstandard)
            file.write(pack_zstandard(file, packed_faces(packing, faces)));
        else
            for (const Image& face : faces) write_packed(file, packing, face);
        entry.length = file.position() - entry.offset;
    }
    const std::uint64_t end = file.position();
    file.seek(kLevelIndexOffset);
    file.write(std::as_bytes(std::span(entries)));
    file.seek(end);
}

}  // namespace

const Codec kKtx2 = {
    .name = "KTX2",
    .endings = {".ktx2"},
    .texel_formats = {TexelFormat::rgba16f, TexelFormat::rgba32f, TexelFormat::rgb9e5,
                      TexelFormat::r11g11b10f},
    .recognises = recognises,
    .read = read,
    .write = write,
    .holds_cubes = true,
    .holds_levels = true,
};

}  // namespace mirrorball::detail
