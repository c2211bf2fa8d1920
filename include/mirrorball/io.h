// Files: pictures and environment maps in, pictures and environment maps out.
//
// Reading tells apart formats by their first bytes, never by the name alone. Nothing is allocated
// on a header's word before the file's length and the memory limit have been checked against it.
// Writing goes to a temporary file beside the target that is synced and renamed over it: the target
// is the old file or the whole new one, never a part.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <mirrorball/environment_map.h>
#include <mirrorball/progress.h>

namespace mirrorball {

/// Bytes that one request may hold at its peak, roughly: what is decoded and what is made of it.
inline constexpr std::uint64_t kUnlimitedMemory = std::numeric_limits<std::uint64_t>::max();

// Pictures
// ------------------------------------------------------------------------------------------

/// How numbers in a file stand for light. Files of floats are linear; 8- and 16-bit ones are sRGB
/// unless the user says otherwise.
enum class Transfer { automatic, linear, srgb };

/// How a texel is stored. `automatic` is the format's richest that is usual for it.
enum class TexelFormat {
    automatic,
    rgba32f,
    rgba16f,
    rgbe8,       ///< shared exponent (Radiance HDR)
    rgb9e5,      ///< shared exponent (KTX2, DDS)
    r11g11b10f,  ///< B10G11R11 (KTX2, DDS)
    unorm16,     ///< PNG, TIFF
    unorm8,
};
[[nodiscard]] std::string_view name(TexelFormat format);
/// \throws Error(Errc::usage)
[[nodiscard]] TexelFormat parse_texel_format(std::string_view name);

/// How the faces of a map lie in a file that holds one picture.
enum class Layout {
    automatic,            ///< reading: by shape; writing: the projection's usual one
    single,               ///< a projection of one face; one picture
    horizontal_cross,     ///< 4 x 3 faces: . +Y . . / -X +Z +X -Z / . -Y . .
    vertical_cross,       ///< 3 x 4 faces: . +Y . / -X +Z +X / . -Y . / . -Z (upside down) .
    horizontal_strip,     ///< 6 x 1: +X -X +Y -Y +Z -Z
    vertical_strip,       ///< 1 x 6
    side_by_side,         ///< dual paraboloid: front, back
    side_by_side_turned,  ///< the same, the back turned by 180 degrees as the survey's Eq. 4 has it
};
[[nodiscard]] std::string_view name(Layout layout);
/// \throws Error(Errc::usage)
[[nodiscard]] Layout parse_layout(std::string_view name);

/// Free text that travels with a map: keys and values, UTF-8. Keys of ours begin with
/// "mirrorball.".
using Metadata = std::map<std::string, std::string>;

/// What a file holds, as its format tells it and before anyone guesses.
struct FileContents {
    std::string format;  ///< "Radiance HDR", "KTX2", ...
    TexelFormat stored = TexelFormat::automatic;
    std::vector<std::vector<Image>> levels;  ///< [level][face]; a plain picture is one of each
    Metadata metadata;
    std::optional<Projection> projection;  ///< where the format itself says
    std::optional<Axes> axes;              ///< likewise
    std::vector<std::string> notes;        ///< what a person should be told, a sentence each
};

struct ReadOptions {
    Transfer transfer = Transfer::automatic;
    std::uint64_t memory_limit = kUnlimitedMemory;
    /// How far into its files reading is; of built-in environments, how much is drawn.
    Progress progress = {};
};

struct WriteOptions {
    TexelFormat format = TexelFormat::automatic;
    /// Losslessly, where the format can. Unset: as opens most widely, so EXR yes (every reader has
    /// ZIP), KTX2 no (many viewers have no Zstandard decoder).
    std::optional<bool> compress = {};
    /// Of 8- and 16-bit integers. `automatic` is sRGB; `linear` is for numbers that are no light
    /// (normals, heights), which the file then does not mark as sRGB. Floats are always linear.
    Transfer transfer = Transfer::automatic;
    /// Into formats that hold metadata (KTX2, OpenEXR, Radiance HDR); elsewhere it is left out.
    Metadata metadata = {};
};

/// Texels that the stored format could not hold and that were clamped to its range.
struct WriteReport {
    std::int64_t clipped_texel_count = 0;
    /// Integral of what was cut off over the sphere; maps only. Of several levels, each of which is
    /// a whole sphere, that of the level that loses most.
    Vec3d lost_flux{0, 0, 0};
    std::uint64_t byte_count = 0;
};

/// \throws Error(Errc::cannot_read) naming the file, what was found and what was expected
[[nodiscard]] FileContents read_file(const std::filesystem::path& path,
                                     const ReadOptions& options = {});
[[nodiscard]] Image read_image(const std::filesystem::path& path, const ReadOptions& options = {});

/// The format follows from the name's ending. Values that it cannot hold are clamped and counted.
/// \throws Error(Errc::usage) for an ending or texel format that it does not have,
///         Error(Errc::cannot_write) with the system's reason
WriteReport write_image(const std::filesystem::path& path, const Image& image,
                        const WriteOptions& options = {});

/// Formats there are: name, endings, whether read and written. For help text.
struct FormatInfo {
    std::string name;
    std::vector<std::string> endings;
    bool reads, writes;
};
[[nodiscard]] std::vector<FormatInfo> formats();

// Environment maps
// ----------------------------------------------------------------------------------

/// A circle in a picture, in pixels from its top left corner: the outline of a photographed ball.
struct CropCircle {
    double x, y, radius;
};

struct MapReadOptions : ReadOptions {
    std::optional<Projection> projection;  ///< else the file's word, else its shape
    Layout layout = Layout::automatic;
    std::string axes;                ///< parse_axes() text; empty: the file's word, else default
    std::optional<CropCircle> crop;  ///< sphere and angular maps
    bool repair = false;             ///< replace texels that are no number by their neighbours
};

struct LoadedMap {
    EnvironmentMap map;
    std::string format;
    TexelFormat stored = TexelFormat::automatic;
    Metadata metadata;
    std::vector<std::string> notes;  ///< guesses made, texels repaired, negative texels kept, ...
};

/// `source` is a file; a pattern for six faces or two paraboloids, `%s` standing for the face (px
/// nx py ny pz nz, posx negx ..., right left top bottom front back, +x -x ...; front back); the
/// faces' names themselves, separated by commas; or "builtin:NAME". \throws
/// Error(Errc::cannot_read); a texel that is NaN or infinite is one, unless options.repair
[[nodiscard]] LoadedMap read_map(const std::string& source, const MapReadOptions& options = {});

struct MapWriteOptions : WriteOptions {
    Layout layout = Layout::automatic;
};

/// One file, or one per face where the name has a `%s`. Formats that hold one picture take level 0
/// only; a map with more levels is refused there, so that none is lost in silence.
WriteReport write_map(const std::string& target, const EnvironmentMap& map,
                      const MapWriteOptions& options = {});

}  // namespace mirrorball
