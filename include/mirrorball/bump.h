// Bump: fine relief that a surface has in its shading only. Heights, their slopes (du/dv) and
// normals, each as a picture; their conversions; levels that keep what averaging loses; sources.
//
// The tangent frame, everywhere: x along the picture's s (right), y along -t (up), z out of the
// surface. Pictures keep their rows from the top, so y grows as the row's number falls:
//
//     y (green up, OpenGL)
//     ^            z toward the viewer
//     |
//     (0,0)-----> s, x              normal  n  ~ (-du, -dv, 1)
//     |                             du = dH/dx, dv = dH/dy, both in metres per metre
//     v t (rows)
//
// So a height that grows to the right leans its normal to the left, and one that grows upwards in
// the picture leans it down: n_y < 0, less than half green in OpenGL's form and more than half in
// Direct3D's. Classic bump mapping that moves texture coordinates (s, t) moves t by -dv.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <mirrorball/image.h>
#include <mirrorball/io.h>

namespace mirrorball {

/// What lies beyond a picture's edges.
enum class Wrap {
    repeat,  ///< itself: the picture is a tile
    clamp,   ///< nothing: slopes at an edge are one-sided, so that a ramp keeps its own
    mirror,  ///< itself, mirrored at the edge
};
[[nodiscard]] std::string_view name(Wrap wrap);
/// \throws Error(Errc::usage)
[[nodiscard]] Wrap parse_wrap(std::string_view name);

/// A relief: one channel, metres, over a picture that covers so many metres.
struct HeightMap {
    Image heights;
    double width = 1, height = 1;  ///< metres, of the whole picture
    Wrap wrap = Wrap::repeat;
};

/// du and dv: two channels, without unit.
struct SlopeMap {
    Image slopes;
};

/// Unit normals in the tangent frame above, z > 0: three channels, signed.
struct NormalMap {
    Image normals;
};

// Conversions
// ---------------------------------------------------------------------------------------

/// Derivatives by the five-point difference of fourth order along each axis,
///
///     f'(i) = (f(i-2) - 8 f(i-1) + 8 f(i+1) - f(i+2)) / 12
///
/// whose response to a wave of w radians per texel is (8 sin w - sin 2w) / 6 instead of w: exact up
/// to cubics, short by w^4/30: 0.08% at 16 texels a wave, 1.2% at 8, 15% at 4. It smooths nothing
/// across, where Sobel's and Scharr's filters lose w^2/6 along the axis (10% at 8 texels), so that
/// the error of a direction stays that of its axes. Where wrap is clamp, one-sided differences of
/// the same order at the edges; of lower order in pictures of fewer than five texels. An axis of
/// one texel is flat.
/// \pre one channel; width and height of the relief above 0
/// \throws Error(Errc::cannot_read) if a height is NaN or infinite, or a slope beyond all floats
[[nodiscard]] SlopeMap slopes(const HeightMap& relief);
[[nodiscard]] NormalMap normals(const HeightMap& relief);

/// n = (-du, -dv, 1) / length, and back. Normals that lie nearly in the surface or point into it
/// (n_z under 0.01 of the length) count as slopes of 100.
[[nodiscard]] NormalMap normals(const SlopeMap& map);
[[nodiscard]] SlopeMap slopes(const NormalMap& map);

/// How much more a relief jumps from its right edge to its left one, or from its bottom to its top,
/// than between neighbours inside: ratios of root mean squares, about 1 for a tile. 0 where there
/// is no jump.
struct Seams {
    double across = 0, down = 0;
};
[[nodiscard]] Seams seams(const HeightMap& relief);

// Stored forms
// -------------------------------------------------------------------------------------

/// Which way the green channel of a stored normal map points: up in the picture (OpenGL, glTF,
/// Blender) or down (Direct3D, Unreal).
enum class Green { up, down };
[[nodiscard]] std::string_view name(Green green);
/// \throws Error(Errc::usage)
[[nodiscard]] Green parse_green(std::string_view name);

/// The picture that a file holds: 1/2 + n/2. Numbers, not light: without sRGB's curve
/// (WriteOptions::transfer).
[[nodiscard]] Image stored_normals(const NormalMap& map, Green green);

/// What was odd about a picture of normals.
struct NormalFaults {
    std::int64_t inward_count = 0;    ///< pointed into the surface, and were turned out of it
    std::int64_t without_count = 0;   ///< had no direction, and became (0, 0, 1)
    double largest_length_error = 0;  ///< before they were made unit length
    bool signed_values = false;       ///< the picture held n itself
};

/// Normals of a picture that holds 1/2 + n/2 or, if some of it is clearly negative or only so of
/// unit length, n itself. `step` is the distance of two codes (1/255 for 8 bits): the two next to
/// one half, neither of which is one half, both stand for 0, so that flat stays flat. \throws
/// Error(Errc::cannot_read) if it has fewer than three channels or holds NaN or infinity
[[nodiscard]] NormalMap parse_normals(const Image& picture, Green green, double step = 0,
                                      NormalFaults* faults = nullptr);

// Files
// ---------------------------------------------------------------------------------------------

enum class BumpKind {
    height,  ///< metres, by BumpReadOptions::scale
    normal,  ///< 1/2 + n/2, or n itself
    slopes,  ///< du, dv; of 8 and 16 bits 1/2 + slope / (2 range). Spelled dudv
};
[[nodiscard]] std::string_view name(BumpKind kind);
/// \throws Error(Errc::usage) naming the kinds there are
[[nodiscard]] BumpKind parse_bump_kind(std::string_view name);

struct BumpReadOptions {
    std::optional<BumpKind> kind;  ///< unless told, grey pictures are heights, others normals
    double scale = 1;              ///< metres per value of a picture of heights
    double width = 1;              ///< metres that it covers from left to right; texels are square
    std::optional<Wrap> wrap;      ///< of heights; repeat unless told
    Green green = Green::up;
    double range = 1;  ///< slope that 8 and 16 bits of du/dv reach to either side
    Transfer transfer = Transfer::linear;
    std::uint64_t memory_limit = kUnlimitedMemory;
};

/// Heights where the file has them, and slopes of whatever it has.
struct BumpPicture {
    BumpKind kind = BumpKind::height;
    std::optional<HeightMap> relief = {};
    SlopeMap slopes = {};
    std::optional<NormalMap> normals = {};  ///< as they were read
    /// What was odd about it, for people: one sentence each, without the file's name.
    std::vector<std::string> remarks = {};
};
/// \throws what read_image() does, and Error(Errc::cannot_read) naming the file where it has too
/// few channels or holds a value that is not finite
[[nodiscard]] BumpPicture read_bump(const std::filesystem::path& path,
                                    const BumpReadOptions& options = {});

// Levels
// -------------------------------------------------------------------------------------------

/// What a texel of a smaller level knows of the slopes under it: means by area of du, dv, their
/// squares and their product (LEAN mapping: Olano and Baker 2010), and of the unit normals
/// (Toksvig 2005). All of them may be interpolated and averaged further; variances may not.
struct BumpLevel {
    Image mean;    ///< du, dv
    Image second;  ///< du^2, dv^2, du dv
    Image normal;  ///< mean of the unit normals, shorter than 1 where they differ
};

/// Variances of slopes and their covariance.
struct SlopeCovariance {
    double du = 0, dv = 0, both = 0;

    /// Largest and smallest over all directions, and the direction of the largest, in radians from
    /// x toward y.
    struct Principal {
        double largest, smallest, angle;
    };
    [[nodiscard]] Principal principal() const;
    /// Mean over all directions.
    [[nodiscard]] double mean() const { return (du + dv) / 2; }
};

/// From the slopes themselves down to 1 x 1; each level has half the texels a side, rounded down.
/// A texel is the mean over exactly the area that it covers in the first level, odd sizes included.
[[nodiscard]] std::vector<BumpLevel> bump_levels(const SlopeMap& map);

/// Second moments less the means' products. Differences that are no more than the rounding of the
/// stored floats (2^-22 of a moment) are 0.
[[nodiscard]] SlopeCovariance covariance(const BumpLevel& level, int x, int y);

/// Roughness of a microfacet lobe of `alpha` once slopes of such a variance, too fine to be seen,
/// have become part of it:
///
///     alpha'^2 = alpha^2 + 2 variance, at most 1
///
/// Beckmann's normals have slopes of variance alpha^2/2 along each axis, and variances of
/// independent slopes add: exact for it when the relief's are normally distributed (Olano and Baker
/// 2010, section 3). For GGX, whose variance is infinite, the same is the usual approximation
/// (Kaplanyan, Hill, Patney, Lefohn 2016). Anisotropic lobes take principal()'s, each its own.
[[nodiscard]] double alpha_with_variance(double alpha, double variance);

/// The same from the length of the mean normal alone (Toksvig 2005, "Mipmapping Normal Maps"), in
/// all directions alike: a Blinn exponent N becomes N f, f = length / (length + N (1 - length)),
/// with N = 2/alpha^2 - 2.
[[nodiscard]] double alpha_with_mean_length(double alpha, double length);

// Sources
// ------------------------------------------------------------------------------------------

struct BumpSource {
    std::string name, description;
    double width;  ///< metres that the tile covers unless told
    bool moves;    ///< depends on the time
};
[[nodiscard]] std::vector<BumpSource> bump_sources();

struct BumpSourceOptions {
    double width = 0;   ///< metres of the tile; 0: the source's own. Heights grow with it
    double height = 0;  ///< metres; 0: texels are square
    double time = 0;    ///< seconds
};

/// A tile: its right edge continues its left one, its bottom its top, at any size and time. Waves
/// shorter than four texels fade out, and those of two are gone, so that nothing aliases. The same
/// bits for any number of threads.
/// \pre width, height >= 1
/// \throws Error(Errc::usage) naming the sources there are
[[nodiscard]] HeightMap make_bump(std::string_view name, int width, int height,
                                  const BumpSourceOptions& options = {});

/// One wave of the source "waves": h = amplitude cos(kx x + ky y - omega time + phase), x to the
/// right and y up in metres from the tile's lower left corner.
struct WaterWave {
    double kx, ky;     ///< radians per metre; a whole number of waves fits the tile
    double amplitude;  ///< metres
    double phase;

    /// Deep water: omega^2 = g k, radians per second.
    [[nodiscard]] double omega() const;
    [[nodiscard]] double height(double x, double y, double time) const;
    /// Its rate of change, metres per second.
    [[nodiscard]] double velocity(double x, double y, double time) const;
};

/// Those of a tile of so many metres, for whoever wants to move them in a shader.
[[nodiscard]] std::vector<WaterWave> water_waves(double width, double height);

}  // namespace mirrorball
