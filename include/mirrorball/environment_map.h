// EnvironmentMap: the light that arrives at a point from every direction, as images.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <mirrorball/axes.h>
#include <mirrorball/image.h>
#include <mirrorball/lobe.h>
#include <mirrorball/projection.h>

namespace mirrorball {

/// One mip level: an image per face, all of one size, three channels each.
struct Level {
    std::vector<Image> faces;
    /// What the source was filtered with; none for the source itself and its plain box-filtered
    /// mips.
    std::optional<Lobe> lobe;

    [[nodiscard]] int width() const { return faces.front().width(); }
    [[nodiscard]] int height() const { return faces.front().height(); }
};

/// Radiance (W m^-2 sr^-1, scene-linear RGB, Rec. 709 primaries unless the owner knows better) or,
/// at a level filtered with the diffuse lobe, irradiance (W m^-2, not divided by pi). Level 0 is
/// the finest. Every level has face_count(projection) faces with height >= 1 and width ==
/// aspect(projection) * height.
struct EnvironmentMap {
    Projection projection = Projection::equirect;
    Axes axes;
    std::vector<Level> levels;

    [[nodiscard]] int width(int level = 0) const { return levels[level].width(); }
    [[nodiscard]] int height(int level = 0) const { return levels[level].height(); }
    [[nodiscard]] int level_count() const { return static_cast<int>(levels.size()); }
};

/// One level, all zero, in the projection's default axes. `size` is the edge in texels of a face,
/// and the width of an equirect (which is twice its height). \throws Error(Errc::usage) if size <
/// 1, or odd for an equirect
[[nodiscard]] EnvironmentMap make_environment_map(Projection projection, int size);

/// All that decides where a map's texels lie; `size` as in make_environment_map().
struct MapShape {
    Projection projection = Projection::equirect;
    int size = 0;
    Axes axes;

    bool operator==(const MapShape&) const = default;
};
[[nodiscard]] MapShape shape_of(const EnvironmentMap& map);
/// The same in the shape's axes.
[[nodiscard]] EnvironmentMap make_environment_map(const MapShape& shape);

/// Bytes that such a map holds, to check against a limit before making it.
[[nodiscard]] std::uint64_t environment_map_bytes(Projection projection, std::int64_t size);

/// Integral of radiance over the sphere, per channel, by exact texel solid angles, in double.
[[nodiscard]] Vec3d flux(const EnvironmentMap& map, int level = 0);

/// What `info` and the report print of a level. Unused texels do not count.
struct LevelStatistics {
    Vec3d flux;              ///< integral of radiance over the sphere
    Vec3f minimum, maximum;  ///< per channel, of the finite values
    double rms;              ///< root mean square by solid angle, over the three channels
    std::int64_t texel_count, non_finite_count, negative_count;  ///< texels with any such channel
};
[[nodiscard]] LevelStatistics statistics(const EnvironmentMap& map, int level = 0);

/// How visible the edges of the picture are on the sphere: the mean step between texels that touch
/// across a seam over the mean step between the texels just inside. 1 where there is no seam to
/// see.
[[nodiscard]] double seam_ratio(const EnvironmentMap& map, int level = 0);

}  // namespace mirrorball
