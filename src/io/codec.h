// What a file format gives to the rest. To add one: write src/io/NAME.cpp with its functions and a
// `const Codec kName`, declare it here, and add it to the table in codecs.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <mirrorball/io.h>

#include "file.h"

namespace mirrorball::detail {

/// What a codec writes: FileContents whose pictures, most of them large, stay their owner's.
struct ContentsView {
    using Picture = std::reference_wrapper<const Image>;

    std::vector<std::vector<Picture>> levels;  // [level][face]; never empty, all sizes consistent
    Metadata metadata;
    std::optional<Projection> projection;
    std::optional<Axes> axes;

    ContentsView() = default;
    /// \pre `contents` outlives this
    ContentsView(const FileContents& contents);
};

class RowSource;

struct Codec {
    std::string_view name;                   // "Radiance HDR"
    std::vector<std::string_view> endings;   // ".hdr", lower case; the first is the usual one
    std::vector<TexelFormat> texel_formats;  // that it writes; the first is the automatic one
    bool (*recognises)(std::span<const std::byte> head);  // the first 32 bytes or fewer
    FileContents (*read)(InputFile& file, const ReadOptions& options);
    // Writes `contents` and does not commit. Values are already within the range of the texel
    // format, which is one of texel_formats. Null if it only reads.
    void (*write)(OutputFile& file, const ContentsView& contents, const WriteOptions& options);
    bool holds_cubes = false;  // six faces in one file; else one picture
    bool holds_levels = false;
    // Opens a picture to be read row by row; null if none of the format can. Where this one cannot,
    // gives null and says why: "its scanlines do not ...". The file outlives what is returned.
    std::unique_ptr<RowSource> (*open_rows)(InputFile& file, const ReadOptions& options,
                                            std::string& obstacle) = nullptr;
};

extern const Codec kHdr, kExr, kPng, kJpeg, kTiff, kKtx2, kDds, kPfm;
// In a browser, what stands for PNG, JPEG and all that it shows by itself.
extern const Codec kDecodedPicture;

[[nodiscard]] std::span<const Codec* const> codecs();

/// \throws Error(Errc::usage) naming the endings there are
[[nodiscard]] const Codec& codec_for_name(const std::filesystem::path& path);

/// By the first bytes; the file is at its beginning afterwards. \throws Error(Errc::cannot_read)
[[nodiscard]] const Codec& codec_for_contents(InputFile& file);
/// Notes that a file's name speaks of another format than it is in.
void note_misleading_name(const InputFile& file, const Codec& codec,
                          std::vector<std::string>& notes);
/// Whether floats stored so are to be taken as sRGB, and doing it to texels of so many channels.
[[nodiscard]] bool floats_are_srgb(TexelFormat stored, Transfer transfer);
void make_linear(std::span<float> values, int channels);
inline constexpr const char* kTakenAsSrgb = "float values taken as sRGB, as asked";

/// What read_file() does with a file that is open, or in memory.
[[nodiscard]] FileContents read_contents(InputFile& file, const ReadOptions& options);

/// write_image() of mip levels, each half the one before, rounded down.
/// \throws also Error(Errc::usage) for more levels than files of the format hold
WriteReport write_levels(const std::filesystem::path& path, std::span<const Image> levels,
                         const WriteOptions& options = {});

/// \throws Error(Errc::usage) for more levels than files of the codec hold
void check_level_count(const Codec& codec, int level_count, const std::filesystem::path& path);

/// Writes with one codec, commits, and gives the count of bytes. Refuses values that are NaN.
/// \pre values are within the range of options.format, which is one of the codec's
std::uint64_t write_contents(const std::filesystem::path& path, const Codec& codec,
                             const FileContents& contents, const WriteOptions& options);

/// The texel format that a request comes down to. \throws Error(Errc::usage) if the codec has it
/// not
[[nodiscard]] TexelFormat choose_texel_format(const Codec& codec, TexelFormat wanted,
                                              const std::filesystem::path& path);

/// Checks a header's claim before anything is allocated for it: sizes positive and at most 2^20 a
/// side, `file_bytes_needed` (the least that so many texels can take in this encoding) there to be
/// read from the file's position on, and the decoded images within the memory limit.
/// \throws Error(Errc::cannot_read)
void check_claim(const InputFile& file, std::int64_t width, std::int64_t height, int channels,
                 std::int64_t image_count, std::uint64_t file_bytes_needed,
                 const ReadOptions& options);

// Texel formats: their ranges, and sRGB.

/// Largest value that the format holds; infinity for rgba32f.
[[nodiscard]] float largest_value(TexelFormat format, int channel = 0);
/// Zero for formats without a sign, else minus the largest.
[[nodiscard]] float lowest_value(TexelFormat format);
/// Clamps a texel to the format's range. Whether anything changed. NaN stays.
bool clamp_texel(std::span<float> texel, TexelFormat format);

/// sRGB's transfer curve, IEC 61966-2-1, on [0, 1]; odd and unclamped beyond.
[[nodiscard]] float srgb_to_linear(float encoded);
[[nodiscard]] float linear_to_srgb(float linear);

}  // namespace mirrorball::detail
