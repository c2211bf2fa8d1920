// One plan makes all maps that a lobe blurs: the environment is taken apart once.
#include <mirrorball/reflection_maps.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include <mirrorball/lookup.h>
#include <mirrorball/prefilter.h>
#include <mirrorball/resample.h>

namespace mirrorball {
namespace {

constexpr double kTexelsPerWidth = 16;
constexpr int kLeastFace = 16, kMostFace = 1024;
// A cosine is wide, but it ends in a kink at the horizon, which blurs over a texel.
constexpr int kDiffuseFace = 64;
// Up to this size a map is made and uploaded in a moment.
constexpr int kQuickFace = 128;

// The last level of rough maps, of alpha 1. With texels half as wide, lookups are off by a quarter
// as much at the levels, and by as much between them, where most of the error is.
constexpr int kRoughestFace = 8;
// The first one: by four of its texels to one of the environment's.
constexpr int kFinestFace = 512, kFinestOverEnvironment = 4;

// Texels along a great circle, in edges of a cube's face, which has a quarter of them: the size of
// a map over that of a cube map as fine.
int size_over_cube(Projection projection) {
    switch (projection) {
        case Projection::cube:
            return 1;
        case Projection::equirect:
            return 4;
        default:
            return 2;
    }
}

int power_of_two_from(double size) {
    return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::ceil(size))));
}

// The edge of a cube's face as fine as the map.
double face_as_fine_as(const EnvironmentMap& map) {
    const int texels = map.projection == Projection::equirect ? map.width() : map.height();
    return static_cast<double>(texels) / size_over_cube(map.projection);
}

int finest_rough_face(const EnvironmentMap& environment) {
    const int wanted = kFinestOverEnvironment * mirror_map_size(environment, Projection::cube);
    return std::clamp(wanted, 2 * kRoughestFace, kFinestFace);
}

void add_unless_there(std::vector<Lobe>& lobes, const Lobe& lobe) {
    if (std::find(lobes.begin(), lobes.end(), lobe) == lobes.end()) lobes.push_back(lobe);
}

}  // namespace

std::size_t ReflectionMaps::index_of(const Lobe& lobe) const {
    const auto found = std::find(lobes.begin(), lobes.end(), lobe);
    assert(found != lobes.end());
    return static_cast<std::size_t>(found - lobes.begin());
}

int glossy_map_size(const Lobe& lobe, Projection projection) {
    const double width = lobe.is_delta() ? 0 : lobe.angle_holding(0.75) - lobe.angle_holding(0.25);
    const int face = width * kMostFace <= kTexelsPerWidth
                         ? kMostFace
                         : std::max(kLeastFace, power_of_two_from(kTexelsPerWidth / width));
    return face * size_over_cube(projection);
}

int mirror_map_size(const EnvironmentMap& environment, Projection projection) {
    return power_of_two_from(std::max(1.0, face_as_fine_as(environment))) *
           size_over_cube(projection);
}

EnvironmentMap make_mirror_map(const EnvironmentMap& environment, Projection projection, int size,
                               const Axes& axes, const Progress& progress) {
    EnvironmentMap map = resample(environment, projection, size, axes, {.progress = progress});
    append_mip_levels(map);
    return map;
}

PrefilterTarget glossy_target(const EnvironmentMap& environment, const Lobe& lobe,
                              Projection projection, const Axes& axes) {
    // Finer than the environment there is nothing to see.
    const int finest = std::max(kDiffuseFace * size_over_cube(projection),
                                mirror_map_size(environment, projection));
    return {lobe, projection, std::min(glossy_map_size(lobe, projection), finest), axes};
}

PrefilterTarget quicker(const PrefilterTarget& glossy) {
    PrefilterTarget result = glossy;
    if (glossy.size > kQuickFace * size_over_cube(glossy.projection)) result.size /= 2;
    return result;
}

PrefilterTarget diffuse_target(Projection projection, const Axes& axes) {
    return {{Lobe::Kind::diffuse}, projection, kDiffuseFace * size_over_cube(projection), axes};
}

std::vector<PrefilterTarget> rough_targets(const EnvironmentMap& environment, Projection projection,
                                           const Axes& axes) {
    std::vector<PrefilterTarget> targets;
    for (int face = finest_rough_face(environment); face >= kRoughestFace; face /= 2) {
        const double alpha = static_cast<double>(kRoughestFace) / face;
        targets.push_back({{Lobe::Kind::ggx, std::sqrt(alpha)},
                           projection,
                           face * size_over_cube(projection),
                           axes});
    }
    return targets;
}

EnvironmentMap levels_of(std::span<EnvironmentMap> maps) {
    EnvironmentMap result{maps.front().projection, maps.front().axes, {}};
    for (EnvironmentMap& map : maps) result.levels.push_back(std::move(map.levels[0]));
    return result;
}

ReflectionMaps make_reflection_maps(const EnvironmentMap& environment, std::span<const Lobe> lobes,
                                    Projection projection, int size, const Axes& axes,
                                    const ReflectionMapOptions& options) {
    ReflectionMaps maps;
    maps.mirror = make_mirror_map(environment, projection, size, axes);
    for (const Lobe& lobe : lobes) add_unless_there(maps.lobes, lobe);

    std::vector<PrefilterTarget> targets;
    for (const Lobe& lobe : maps.lobes)
        targets.push_back(glossy_target(environment, lobe, projection, axes));
    targets.push_back(diffuse_target(projection, axes));
    if (options.rough) {
        const std::vector<PrefilterTarget> levels = rough_targets(environment, projection, axes);
        targets.insert(targets.end(), levels.begin(), levels.end());
    }
    std::vector<EnvironmentMap> blurred = prefilter(environment, targets, options.progress);
    const auto diffuse = blurred.begin() + static_cast<std::ptrdiff_t>(maps.lobes.size());
    if (options.rough) maps.rough = levels_of(std::span(blurred).subspan(maps.lobes.size() + 1));
    maps.diffuse = std::move(*diffuse);
    blurred.erase(diffuse, blurred.end());
    maps.glossy = std::move(blurred);
    return maps;
}

double mirror_alpha(double face_size) {
    // Half of GGX's light lies within 2 alpha. This is 0.3 texels of 2 / face_size: what bilinear
    // lookup and the mean over a texel do to a small light, as measured at the built-in suns.
    return 0.6 / face_size;
}

RoughPlace rough_place(double alpha, int level_count, double mirror_alpha) {
    const double finest = std::exp2(1 - level_count);
    if (alpha < finest) {
        const double sharp = std::min(mirror_alpha, finest / 2);  // the mirror up to there
        return {alpha > sharp ? (1 - sharp / alpha) / (1 - sharp / finest) : 0, 0};
    }
    const double finer = std::exp2(std::floor(std::log2(alpha / finest))) * finest;
    const double lod = std::log2(finer / finest) + 2 * (1 - finer / alpha);
    return {1, std::min(lod, level_count - 1.0)};
}

Vec3f look_up_rough(const ReflectionMaps& maps, const Vec3d& direction, double alpha) {
    const double sharp = mirror_alpha(face_as_fine_as(maps.mirror));
    const RoughPlace place = rough_place(alpha, maps.rough.level_count(), sharp);
    const auto share = static_cast<float>(place.share);
    Vec3f sum(0);
    if (share > 0) sum += look_up_at_lod(maps.rough, direction, place.lod) * share;
    if (share < 1) sum += look_up(maps.mirror, direction) * (1 - share);
    return sum;
}

std::vector<Lobe> lobes_of(const Scene& scene) {
    std::vector<Lobe> lobes;
    for (const SceneObject& object : scene.objects) {
        if (object.material.glossy > 0) add_unless_there(lobes, object.material.lobe);
    }
    return lobes;
}

}  // namespace mirrorball
