// What all formats have in common: which there are, how one is told from another, what a texel
// format can hold, and the frame around reading and writing a file.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <mirrorball/error.h>

#include "codec.h"

namespace mirrorball {
namespace {

struct TexelFormatEntry {
    TexelFormat format;
    std::string_view name;
    std::array<float, 3> largest;  // of red (and alpha), green, blue
    bool has_sign;
    bool is_float;
};

constexpr float kInfinity = std::numeric_limits<float>::infinity();

constexpr TexelFormatEntry kTexelFormats[] = {
    {TexelFormat::automatic, "automatic", {kInfinity, kInfinity, kInfinity}, true, true},
    {TexelFormat::rgba32f, "rgba32f", {kInfinity, kInfinity, kInfinity}, true, true},
    {TexelFormat::rgba16f, "rgba16f", {65504, 65504, 65504}, true, true},
    // Mantissa 255/256 at exponent 255 - 128.
    {TexelFormat::rgbe8, "rgbe8", {0x1.fep126f, 0x1.fep126f, 0x1.fep126f}, false, true},
    // Mantissa 511/512 at exponent 31 - 15.
    {TexelFormat::rgb9e5, "rgb9e5", {65408, 65408, 65408}, false, true},
    // Mantissas of 6 bits for red and green, of 5 for blue.
    {TexelFormat::r11g11b10f, "r11g11b10f", {65024, 65024, 64512}, false, true},
    {TexelFormat::unorm16, "unorm16", {1, 1, 1}, false, false},
    {TexelFormat::unorm8, "unorm8", {1, 1, 1}, false, false},
};

struct LayoutEntry {
    Layout layout;
    std::string_view name;
};

constexpr LayoutEntry kLayouts[] = {
    {Layout::automatic, "automatic"},
    {Layout::single, "single"},
    {Layout::horizontal_cross, "horizontal-cross"},
    {Layout::vertical_cross, "vertical-cross"},
    {Layout::horizontal_strip, "horizontal-strip"},
    {Layout::vertical_strip, "vertical-strip"},
    {Layout::side_by_side, "side-by-side"},
    {Layout::side_by_side_turned, "side-by-side-turned"},
};

const TexelFormatEntry& entry(TexelFormat format) {
    return *std::find_if(std::begin(kTexelFormats), std::end(kTexelFormats),
                         [&](const TexelFormatEntry& e) { return e.format == format; });
}

// The entry of a table that has this name, or an error that lists the names.
template <class Table>
const auto& find_name(const Table& table, std::string_view name, std::string_view what) {
    std::vector<std::string_view> names;
    for (const auto& e : table) {
        if (e.name == name) return e;
        names.push_back(e.name);
    }
    throw Error(Errc::usage, fmt::format("{} '{}' is not known; there are {}", what, name,
                                         fmt::join(names, ", ")));
}

// ".HDR" of "sky.HDR" as ".hdr"; empty where there is none.
std::string lower_case_ending(const std::filesystem::path& path) {
    std::string ending = path.extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return ending;
}

bool has_ending(const detail::Codec& codec, std::string_view ending) {
    return std::find(codec.endings.begin(), codec.endings.end(), ending) != codec.endings.end();
}

std::string bytes_in_words(double bytes) {
    constexpr std::array kUnits{"bytes", "KiB", "MiB", "GiB", "TiB", "PiB"};
    std::size_t unit = 0;
    while (bytes >= 1024 && unit + 1 < kUnits.size()) bytes /= 1024, ++unit;
    return fmt::format("{:.{}f} {}", bytes, unit == 0 ? 0 : 1, kUnits[unit]);
}

void refuse_nan(const FileContents& contents, const std::filesystem::path& path) {
    for (const auto& faces : contents.levels)
        for (const Image& image : faces)
            for (int y = 0; y < image.height(); ++y) {
                const std::span<const float> row = image.row(y);
                const auto bad =
                    std::find_if(row.begin(), row.end(), [](float v) { return std::isnan(v); });
                if (bad == row.end()) continue;
                throw Error(Errc::cannot_write,
                            fmt::format("{}: texel ({}, {}) is not a number (NaN), which no file "
                                        "should hold",
                                        path.string(), (bad - row.begin()) / image.channels(), y));
            }
}

}  // namespace

std::string_view name(TexelFormat format) {
    return entry(format).name;
}

TexelFormat parse_texel_format(std::string_view name) {
    return find_name(kTexelFormats, name, "texel format").format;
}

std::string_view name(Layout layout) {
    return std::find_if(std::begin(kLayouts), std::end(kLayouts),
                        [&](const LayoutEntry& e) { return e.layout == layout; })
        ->name;
}

Layout parse_layout(std::string_view name) {
    return find_name(kLayouts, name, "layout").layout;
}

std::vector<FormatInfo> formats() {
    std::vector<FormatInfo> result;
    for (const detail::Codec* codec : detail::codecs())
        result.push_back({std::string(codec->name),
                          {codec->endings.begin(), codec->endings.end()},
                          codec->read != nullptr,
                          codec->write != nullptr});
    return result;
}

FileContents read_file(const std::filesystem::path& path, const ReadOptions& options) {
    detail::InputFile file(path);
    file.report_to(options.progress);
    return detail::read_contents(file, options);
}

Image read_image(const std::filesystem::path& path, const ReadOptions& options) {
    FileContents contents = read_file(path, options);
    const std::size_t face_count = contents.levels.front().size();
    if (face_count != 1)
        throw Error(Errc::cannot_read,
                    fmt::format("{}: has {} faces, where one picture was expected", path.string(),
                                face_count));
    return std::move(contents.levels.front().front());
}

WriteReport write_image(const std::filesystem::path& path, const Image& image,
                        const WriteOptions& options) {
    return detail::write_levels(path, {&image, 1}, options);
}

WriteReport detail::write_levels(const std::filesystem::path& path, std::span<const Image> levels,
                                 const WriteOptions& options) {
    if (levels.empty() || levels.front().empty())
        throw Error(Errc::usage, fmt::format("{}: the picture is empty", path.string()));
    const detail::Codec& codec = detail::codec_for_name(path);
    WriteOptions chosen = options;
    chosen.format = detail::choose_texel_format(codec, options.format, path);
    detail::check_level_count(codec, static_cast<int>(levels.size()), path);

    FileContents contents;
    contents.format = codec.name;
    contents.stored = chosen.format;
    contents.metadata = options.metadata;

    WriteReport report;
    for (const Image& level : levels) {
        Image copy = level;
        const std::span<float> values = copy.values();
        const std::size_t channels = copy.channels();
        for (std::size_t i = 0; i < values.size(); i += channels)
            report.clipped_texel_count +=
                detail::clamp_texel(values.subspan(i, channels), chosen.format);
        contents.levels.push_back({std::move(copy)});
    }
    report.byte_count = detail::write_contents(path, codec, contents, chosen);
    return report;
}

namespace detail {

std::span<const Codec* const> codecs() {
    static const std::vector<const Codec*> kTable = {
        &kHdr,
        &kExr,
#if defined(__EMSCRIPTEN__)
        &kDecodedPicture,
#else
        &kPng,
        &kJpeg,
        &kTiff,
#endif
        &kKtx2,
        &kDds,
        &kPfm,
    };
    return kTable;
}

ContentsView::ContentsView(const FileContents& contents)
    : metadata(contents.metadata),
      projection(contents.projection),
      axes(contents.axes) {
    for (const std::vector<Image>& faces : contents.levels)
        levels.emplace_back(faces.begin(), faces.end());
}

const Codec& codec_for_name(const std::filesystem::path& path) {
    const std::string ending = lower_case_ending(path);
    std::vector<std::string_view> endings;
    for (const Codec* codec : codecs()) {
        if (codec->write == nullptr) {
            if (has_ending(*codec, ending))
                throw Error(Errc::usage, fmt::format("{}: {} files can be read, but not written",
                                                     path.string(), codec->name));
            continue;
        }
        if (has_ending(*codec, ending)) return *codec;
        endings.insert(endings.end(), codec->endings.begin(), codec->endings.end());
    }
    throw Error(Errc::usage,
                fmt::format("{}: the ending '{}' names no format that can be written; there are {}",
                            path.string(), ending, fmt::join(endings, " ")));
}

const Codec& codec_for_contents(InputFile& file) {
    std::array<std::byte, 32> head;
    const std::size_t count = file.read_some(head);
    file.seek(0);
    if (count == 0) file.fail("is empty");
    for (const Codec* codec : codecs())
        if (codec->recognises(std::span<const std::byte>(head).first(count))) return *codec;

    std::vector<std::string_view> names;
    for (const Codec* codec : codecs()) names.push_back(codec->name);
    file.fail(fmt::format("is in no format that is known here, by its first bytes; known are {}",
                          fmt::join(names, ", ")));
}

void note_misleading_name(const InputFile& file, const Codec& codec,
                          std::vector<std::string>& notes) {
    const std::string ending = lower_case_ending(file.name());
    if (has_ending(codec, ending) || ending.empty()) return;
    notes.push_back(fmt::format("is a {} file, whatever its name says", codec.name));
}

// Files of floats hold linear values; a user who knows better says so.
bool floats_are_srgb(TexelFormat stored, Transfer transfer) {
    return transfer == Transfer::srgb && entry(stored).is_float;
}

void make_linear(std::span<float> values, int channels) {
    const bool has_alpha = channels == 2 || channels == 4;
    const int colour_count = has_alpha ? channels - 1 : channels;
    for (std::size_t i = 0; i < values.size(); i += channels)
        for (int c = 0; c < colour_count; ++c) values[i + c] = srgb_to_linear(values[i + c]);
}

FileContents read_contents(InputFile& file, const ReadOptions& options) {
    const Codec& codec = codec_for_contents(file);
    try {
        FileContents contents = codec.read(file, options);
        contents.format = codec.name;
        if (floats_are_srgb(contents.stored, options.transfer)) {
            for (auto& faces : contents.levels)
                for (Image& image : faces) make_linear(image.values(), image.channels());
            contents.notes.emplace_back(kTakenAsSrgb);
        }
        note_misleading_name(file, codec, contents.notes);
        return contents;
    } catch (const std::bad_alloc&) {
        file.fail("needs more memory than there is");
    } catch (const std::length_error&) {
        file.fail("needs more memory than a program can have");
    }
}

void check_level_count(const Codec& codec, int level_count, const std::filesystem::path& path) {
    if (level_count == 1 || codec.holds_levels) return;
    throw Error(Errc::usage,
                fmt::format("{}: {} files hold one level and this has {}; KTX2 holds them all "
                            "(a name that ends in .ktx2)",
                            path.string(), codec.name, level_count));
}

std::uint64_t write_contents(const std::filesystem::path& path, const Codec& codec,
                             const FileContents& contents, const WriteOptions& options) {
    refuse_nan(contents, path);
    OutputFile file(path);
    codec.write(file, contents, options);
    file.commit();
    return file.size();
}

TexelFormat choose_texel_format(const Codec& codec, TexelFormat wanted,
                                const std::filesystem::path& path) {
    const std::vector<TexelFormat>& there = codec.texel_formats;
    if (wanted == TexelFormat::automatic) return there.front();
    if (std::find(there.begin(), there.end(), wanted) != there.end()) return wanted;
    std::vector<std::string_view> names;
    for (const TexelFormat format : there) names.push_back(name(format));
    throw Error(Errc::usage, fmt::format("{}: {} files hold no {}; they hold {}", path.string(),
                                         codec.name, name(wanted), fmt::join(names, ", ")));
}

void check_claim(const InputFile& file, std::int64_t width, std::int64_t height, int channels,
                 std::int64_t image_count, std::uint64_t file_bytes_needed,
                 const ReadOptions& options) {
    constexpr std::int64_t kLargestSide = std::int64_t{1} << 20;
    if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide)
        file.fail(fmt::format("claims {} x {} texels (a side must have 1 to {})", width, height,
                              kLargestSide));
    if (channels < 1 || channels > 4)
        file.fail(fmt::format("claims {} channels (1 to 4 were expected)", channels));
    if (image_count < 1) file.fail(fmt::format("claims {} images", image_count));
    if (file_bytes_needed > file.remaining())
        file.fail(
            fmt::format("is truncated: {} x {} texels need at least {} bytes, and {} are left",
                        width, height, file_bytes_needed, file.remaining()));
    // In floating point, since the product of wild claims overflows integers.
    const double decoded_bytes = static_cast<double>(width) * static_cast<double>(height) *
                                 channels * static_cast<double>(image_count) * sizeof(float);
    if (decoded_bytes > static_cast<double>(options.memory_limit))
        file.fail(
            fmt::format("needs {} of memory once decoded ({} x {} texels), over the limit of {}",
                        bytes_in_words(decoded_bytes), width, height,
                        bytes_in_words(static_cast<double>(options.memory_limit))));
}

float largest_value(TexelFormat format, int channel) {
    return entry(format).largest[channel == 3 ? 0 : channel];
}

float lowest_value(TexelFormat format) {
    return entry(format).has_sign ? -entry(format).largest[0] : 0.0f;
}

bool clamp_texel(std::span<float> texel, TexelFormat format) {
    const TexelFormatEntry& range = entry(format);
    bool clamped = false;
    for (std::size_t c = 0; c < texel.size(); ++c) {
        const float largest = range.largest[c == 3 ? 0 : c];
        const float lowest = range.has_sign ? -largest : 0.0f;
        // Written so that NaN is neither.
        if (texel[c] > largest) texel[c] = largest, clamped = true;
        if (texel[c] < lowest) texel[c] = lowest, clamped = true;
    }
    return clamped;
}

// Double inside, so that 16-bit codes survive a round trip whatever the mathematics library.
float srgb_to_linear(float encoded) {
    const double v = std::abs(static_cast<double>(encoded));
    const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    return static_cast<float>(std::copysign(linear, encoded));
}

float linear_to_srgb(float linear) {
    const double v = std::abs(static_cast<double>(linear));
    const double encoded = v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    return static_cast<float>(std::copysign(encoded, linear));
}

}  // namespace detail
}  // namespace mirrorball
