// One plan makes all maps that a lobe blurs: the environment is taken apart once.
#include <mirrorball/reflection_maps.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include <mirrorball/prefilter.h>
#include <mirrorball/resample.h>

namespace mirrorball {
namespace {

constexpr double kTexelsPerWidth = 16;
constexpr int kLeastFace = 16, kMostFace = 1024;
// A cosine is wide, but it ends in a kink at the horizon, which blurs over a texel.
constexpr int kDiffuseFace = 64;

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
    const int texels =
        environment.projection == Projection::equirect ? environment.width() : environment.height();
    const double face = static_cast<double>(texels) / size_over_cube(environment.projection);
    return power_of_two_from(std::max(1.0, face)) * size_over_cube(projection);
}

ReflectionMaps make_reflection_maps(const EnvironmentMap& environment, std::span<const Lobe> lobes,
                                    Projection projection, int size, const Axes& axes,
                                    const Progress& progress) {
    ReflectionMaps maps;
    maps.mirror = resample(environment, projection, size, axes);
    append_mip_levels(maps.mirror);
    for (const Lobe& lobe : lobes) add_unless_there(maps.lobes, lobe);

    // Finer than the environment there is nothing to see.
    const int finest = std::max(kDiffuseFace * size_over_cube(projection),
                                mirror_map_size(environment, projection));
    std::vector<PrefilterTarget> targets;
    for (const Lobe& lobe : maps.lobes) {
        const int wanted = std::min(glossy_map_size(lobe, projection), finest);
        targets.push_back({lobe, projection, wanted, axes});
    }
    targets.push_back(
        {{Lobe::Kind::diffuse}, projection, kDiffuseFace * size_over_cube(projection), axes});
    Prefiltered blurred = PrefilterPlan(shape_of(environment), targets)(environment, progress);
    maps.diffuse = std::move(blurred.maps.back());
    blurred.maps.pop_back();
    maps.glossy = std::move(blurred.maps);
    return maps;
}

std::vector<Lobe> lobes_of(const Scene& scene) {
    std::vector<Lobe> lobes;
    for (const SceneObject& object : scene.objects) {
        if (object.material.glossy > 0) add_unless_there(lobes, object.material.lobe);
    }
    return lobes;
}

}  // namespace mirrorball
