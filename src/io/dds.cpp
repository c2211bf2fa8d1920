// DDS: Direct3D's texture files. Microsoft, "Programming Guide for DDS".
//
//     0    "DDS "
//     4    header        124 bytes; its pixel format names the texel format in one of several ways
//     128  DX10 header   20 bytes, where the pixel format is the code "DX10": a DXGI number
//          texels        face by face (+X -X +Y -Y +Z -Z), each with all its levels, base first
//
// We write the DX10 header, which says all without guessing, and read it and the two older codes
// for half and float. Faces lie as in OpenGL and KTX2.
#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>

#include <fmt/format.h>

#include <mirrorball/error.h>

#include "codec.h"
#include "packed.h"

namespace mirrorball::detail {
namespace {

// Numbers are copied between files and memory as they are.
static_assert(std::endian::native == std::endian::little);

constexpr std::uint32_t four_cc(const char (&text)[5]) {
    return static_cast<std::uint32_t>(text[0]) | static_cast<std::uint32_t>(text[1]) << 8 |
           static_cast<std::uint32_t>(text[2]) << 16 | static_cast<std::uint32_t>(text[3]) << 24;
}
constexpr std::uint32_t kMagic = four_cc("DDS "), kDx10 = four_cc("DX10");

struct PixelFormat {
    std::uint32_t size, flags, four_cc, bit_count, masks[4];
};
struct Header {
    std::uint32_t size, flags, height, width, pitch, depth, level_count;
    std::uint32_t reserved[11];
    PixelFormat pixel_format;
    std::uint32_t caps, caps2, caps3, caps4, reserved2;
};
static_assert(sizeof(Header) == 124);
struct Dx10Header {
    std::uint32_t format, dimension, misc_flags, array_size, misc_flags2;
};
static_assert(sizeof(Dx10Header) == 20);

// Header::flags
constexpr std::uint32_t kHasCaps = 0x1, kHasHeight = 0x2, kHasWidth = 0x4, kHasPitch = 0x8,
                        kHasPixelFormat = 0x1000, kHasLevelCount = 0x20000;
// PixelFormat::flags
constexpr std::uint32_t kHasFourCc = 0x4;
// Header::caps and caps2
constexpr std::uint32_t kTexture = 0x1000, kComplex = 0x8, kMipmap = 0x400000;
constexpr std::uint32_t kCube = 0x200, kAllFaces = 0xFC00, kVolume = 0x200000;
// Dx10Header::dimension and misc_flags
constexpr std::uint32_t kTexture1d = 2, kTexture2d = 3, kTexture3d = 4, kMiscCube = 0x4;

struct Format {
    std::uint32_t dxgi;
    Packing packing;
};
constexpr Format kFormats[] = {
    {2, Packing::rgba32f},      // R32G32B32A32_FLOAT
    {6, Packing::rgb32f},       // R32G32B32_FLOAT
    {10, Packing::rgba16f},     // R16G16B16A16_FLOAT
    {26, Packing::b10g11r11f},  // R11G11B10_FLOAT
    {28, Packing::rgba8},       // R8G8B8A8_UNORM
    {29, Packing::rgba8_srgb},  // R8G8B8A8_UNORM_SRGB
    {67, Packing::rgb9e5},      // R9G9B9E5_SHAREDEXP
};
// Numbers of Direct3D 9 in the place of a four-character code.
constexpr std::uint32_t kLegacyHalf = 113, kLegacyFloat = 116;

constexpr std::string_view kWhatIsRead =
    "read are half and float RGBA, float RGB, R11G11B10, R9G9B9E5 and 8-bit RGBA";

std::string dxgi_in_words(std::uint32_t dxgi) {
    if (dxgi == 95) return "95 (BC6H_UF16)";
    if (dxgi == 96) return "96 (BC6H_SF16)";
    if ((dxgi >= 70 && dxgi <= 84) || (dxgi >= 94 && dxgi <= 99))
        return fmt::format("{} (a BC block)", dxgi);
    return fmt::format("{}", dxgi);
}

std::string four_cc_in_words(std::uint32_t code) {
    std::string text;
    for (int i = 0; i < 4; ++i) text += static_cast<char>(code >> 8 * i & 0xff);
    const bool printable =
        std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isprint(c) != 0; });
    return printable ? fmt::format("'{}'", text) : fmt::format("{}", code);
}

Packing packing_of(const InputFile& file, std::uint32_t dxgi) {
    for (const Format& format : kFormats)
        if (format.dxgi == dxgi) return format.packing;
    file.fail(fmt::format("its texel format is DXGI {}; {}", dxgi_in_words(dxgi), kWhatIsRead));
}

// What both headers come down to.
struct Description {
    Packing packing;
    bool is_cube;
};

Description describe_dx10(const InputFile& file, const Dx10Header& dx10) {
    const Packing packing = packing_of(file, dx10.format);
    if (dx10.dimension == kTexture1d || dx10.dimension == kTexture3d)
        file.fail(fmt::format("is {}; read are 2-D pictures and cubes",
                              dx10.dimension == kTexture1d ? "1-D" : "a volume"));
    if (dx10.dimension != kTexture2d)
        file.fail(fmt::format("its dimension is number {} (3 was expected)", dx10.dimension));
    // For a cube this counts cubes, not faces.
    if (dx10.array_size != 1)
        file.fail(
            fmt::format("is an array of {}; read are single pictures and cubes", dx10.array_size));
    return {packing, (dx10.misc_flags & kMiscCube) != 0};
}

Description describe_legacy(const InputFile& file, const Header& header) {
    if (!(header.pixel_format.flags & kHasFourCc))
        file.fail(fmt::format("its texels are {} bits by masks; {}", header.pixel_format.bit_count,
                              kWhatIsRead));
    if ((header.caps2 & kVolume) != 0) file.fail("is a volume; read are 2-D pictures and cubes");
    const std::uint32_t code = header.pixel_format.four_cc;
    if (code != kLegacyHalf && code != kLegacyFloat)
        file.fail(fmt::format("its texel format is {}; {}", four_cc_in_words(code), kWhatIsRead));
    const bool is_cube = (header.caps2 & kCube) != 0;
    if (is_cube && (header.caps2 & kAllFaces) != kAllFaces)
        file.fail("is a cube without all of its six faces");
    return {code == kLegacyHalf ? Packing::rgba16f : Packing::rgba32f, is_cube};
}

std::uint64_t chain_bytes(Packing packing, int width, int height, int level_count) {
    std::uint64_t bytes = 0;
    for (int level = 0; level < level_count; ++level)
        bytes += std::uint64_t(level_size(width, level)) * level_size(height, level) *
                 texel_bytes(packing);
    return bytes;
}

bool recognises(std::span<const std::byte> head) {
    return head.size() >= sizeof(kMagic) && std::memcmp(head.data(), &kMagic, sizeof(kMagic)) == 0;
}

FileContents read(InputFile& file, const ReadOptions& options) {
    file.seek(sizeof(kMagic));
    const auto header = file.read_value<Header>();
    if (header.size != sizeof(Header) || header.pixel_format.size != sizeof(PixelFormat))
        file.fail(fmt::format("its header says {} and {} bytes (124 and 32 were expected)",
                              header.size, header.pixel_format.size));
    const bool has_dx10 =
        (header.pixel_format.flags & kHasFourCc) != 0 && header.pixel_format.four_cc == kDx10;
    const Description found = has_dx10 ? describe_dx10(file, file.read_value<Dx10Header>())
                                       : describe_legacy(file, header);
    if (found.is_cube && header.width != header.height)
        file.fail(fmt::format("its cube faces are {} x {} texels, not square", header.width,
                              header.height));

    const int face_count = found.is_cube ? 6 : 1;
    // Some writers leave the flag or the count away where there is but the base.
    const bool counted = (header.flags & kHasLevelCount) != 0 || (header.caps & kMipmap) != 0;
    const std::uint32_t level_count = counted ? std::max(header.level_count, 1u) : 1;
    constexpr std::uint32_t kMostLevels =
        21;  // of the largest side that check_claim() lets through
    if (level_count > kMostLevels) file.fail(fmt::format("claims {} levels", level_count));
    check_claim(file, header.width, header.height, channel_count(found.packing),
                image_count_bound(face_count, static_cast<int>(level_count)), 0, options);
    const int width = static_cast<int>(header.width), height = static_cast<int>(header.height);
    const int levels = static_cast<int>(level_count);
    if (levels > possible_level_count(width, height))
        file.fail(fmt::format("claims {} levels; {} x {} texels can have {}", levels, width, height,
                              possible_level_count(width, height)));
    const std::uint64_t needed = face_count * chain_bytes(found.packing, width, height, levels);
    if (needed > file.remaining())
        file.fail(fmt::format("is truncated: its texels take {} bytes, and {} are left", needed,
                              file.remaining()));

    FileContents contents;
    contents.format = kDds.name;
    contents.stored = texel_format(found.packing);
    contents.levels.resize(levels);
    if (found.is_cube) contents.projection = Projection::cube;
    const Packing packing = with_transfer(found.packing, options.transfer);
    std::vector<std::byte> bytes;
    for (int face = 0; face < face_count; ++face)
        for (int level = 0; level < levels; ++level) {
            const int w = level_size(width, level), h = level_size(height, level);
            bytes.resize(chain_bytes(packing, w, h, 1));
            file.read(bytes);
            contents.levels[level].push_back(unpack(packing, bytes, w, h));
        }
    drop_opaque_alpha(contents);
    return contents;
}

void write(OutputFile& file, const ContentsView& contents, const WriteOptions& options) {
    require_halved_levels(file, contents);
    const Packing packing = packing_for(options.format);
    const auto* format = std::find_if(std::begin(kFormats), std::end(kFormats),
                                      [&](const Format& f) { return f.packing == packing; });
    const int face_count = static_cast<int>(contents.levels.front().size());
    const bool is_cube = face_count == 6;
    const bool has_levels = contents.levels.size() > 1;
    const Image& base = contents.levels.front().front();

    Header h{};
    h.size = sizeof(Header);
    h.flags = kHasCaps | kHasHeight | kHasWidth | kHasPitch | kHasPixelFormat |
              (has_levels ? kHasLevelCount : 0);
    h.height = static_cast<std::uint32_t>(base.height());
    h.width = static_cast<std::uint32_t>(base.width());
    h.pitch = h.width * texel_bytes(packing);
    h.level_count = static_cast<std::uint32_t>(contents.levels.size());
    h.pixel_format.size = sizeof(PixelFormat);
    h.pixel_format.flags = kHasFourCc;
    h.pixel_format.four_cc = kDx10;
    h.caps = kTexture | (is_cube || has_levels ? kComplex : 0) | (has_levels ? kMipmap : 0);
    h.caps2 = is_cube ? kCube | kAllFaces : 0;
    const Dx10Header dx10{format->dxgi, kTexture2d, is_cube ? kMiscCube : 0, 1, 0};

    file.write_value(kMagic);
    file.write_value(h);
    file.write_value(dx10);
    for (int face = 0; face < face_count; ++face)
        for (const std::vector<ContentsView::Picture>& level : contents.levels)
            write_packed(file, packing, level[face]);
}

}  // namespace

const Codec kDds = {
    .name = "DDS",
    .endings = {".dds"},
    .texel_formats = {TexelFormat::rgba16f, TexelFormat::rgba32f, TexelFormat::rgb9e5,
                      TexelFormat::r11g11b10f},
    .recognises = recognises,
    .read = read,
    .write = write,
    .holds_cubes = true,
    .holds_levels = true,
};

}  // namespace mirrorball::detail
