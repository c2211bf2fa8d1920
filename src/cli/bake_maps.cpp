#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include <mirrorball/compare.h>
#include <mirrorball/prefilter.h>
#include <mirrorball/tone_map.h>

#include "bake.h"
#include "chain.h"

namespace mirrorball::cli {
namespace {

constexpr int kLargestEnvironment = 2048;
constexpr int kLeastPhong = 16, kLargestPhong = 512;

// A face's edge on which the lobe spans three texels from its peak to half of that.
int size_for_phong(const Lobe& lobe) {
    const double half = std::acos(std::pow(0.5, 1 / std::max(lobe.parameter, 1e-9)));
    const double size = 3 * (kPi / 2) / half;
    return std::clamp(static_cast<int>(std::bit_ceil(static_cast<unsigned>(size))), kLeastPhong,
                      kLargestPhong);
}

// Sizes halve from level to level, so level 0 is what the most demanding level needs.
int phong_size(const std::vector<Lobe>& lobes) {
    int size = 1 << (lobes.size() - 1);
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        size = std::max(size, std::min(kLargestPhong, size_for_phong(lobes[i]) << i));
    }
    return size;
}

Vec3d ratio(const Vec3d& a, const Vec3d& b) {
    return {a.x / b.x, a.y / b.y, a.z / b.z};
}

std::vector<LevelFacts> facts_of(const BakedMap& baked, const Vec3d& source_flux) {
    std::vector<LevelFacts> facts;
    for (int level = 0; level < baked.map.level_count(); ++level) {
        const auto& lobe = baked.map.levels[level].lobe;
        const LevelStatistics s = statistics(baked.map, level);
        const double integral = lobe ? lobe->integral() : 1;
        std::optional<double> error;
        if (!baked.estimated_errors.empty()) error = baked.estimated_errors[level];
        facts.push_back({level, baked.map.width(level), lobe, s, seam_ratio(baked.map, level),
                         error, ratio(s.flux, source_flux * integral)});
    }
    return facts;
}

// Irradiance of the nine coefficients, as a map to compare with the one that was integrated.
EnvironmentMap irradiance_map(const NineHarmonics& irradiance, const EnvironmentMap& like) {
    EnvironmentMap map = like;
    for (int face = 0; face < face_count(map.projection); ++face) {
        Image& image = map.levels[0].faces[face];
        visit(map.projection, [&](auto projection) {
            for (int y = 0; y < image.height(); ++y) {
                for (int x = 0; x < image.width(); ++x) {
                    const FacePoint<double> centre{face, (x + 0.5) / image.width(),
                                                   (y + 0.5) / image.height()};
                    const Vec3d normal = map.axes.to_world(projection.direction(centre));
                    image.set_rgb(x, y, Vec3f(evaluate(irradiance, normal)));
                }
            }
        });
    }
    return map;
}

void make_environment(Bake& bake, ProgressBar& bar) {
    EnvironmentMap& map = bake.environment.map;
    map = resample(bake.source.map, Projection::cube, bake.options.environment_size,
                   default_axes(Projection::cube), {.progress = bar.stage("Environment", 0.05)});
    append_mip_levels(map);
}

// The maps of the targets that bake_targets() names, in its order.
void make_prefiltered(Bake& bake, Plans& plans, ProgressBar& bar) {
    const Progress progress = bar.stage("Prefiltering", 0.75);
    Prefiltered results = plans.plan_for(bake.source.map)(bake.source.map, progress);
    auto map = results.maps.begin();
    auto error = results.errors.begin();
    const auto take = [&](BakedMap& baked, std::ptrdiff_t count) {
        baked.map = join_levels({std::move_iterator(map), std::move_iterator(map + count)});
        baked.estimated_errors.assign(error, error + count);
        map += count;
        error += count;
    };
    const std::ptrdiff_t phong_count = std::ssize(bake.options.phong);
    take(bake.specular, std::ssize(results.maps) - phong_count - 1);
    take(bake.phong, phong_count);
    take(bake.diffuse, 1);
}

}  // namespace

std::vector<PrefilterTarget> bake_targets(const BakeOptions& options) {
    const Axes axes = default_axes(Projection::cube);
    const int levels =
        options.level_count > 0 ? options.level_count : usual_level_count(options.size);
    std::vector<PrefilterTarget> targets =
        chain_targets(level_lobes(options.mapping, levels), Projection::cube, options.size, axes);
    const auto phong =
        chain_targets(options.phong, Projection::cube, phong_size(options.phong), axes);
    targets.insert(targets.end(), phong.begin(), phong.end());
    targets.push_back({{Lobe::Kind::diffuse}, Projection::cube, options.diffuse_size, axes});
    return targets;
}

void choose_environment_size(Bake& bake, std::uint64_t most_bytes) {
    int& size = bake.options.environment_size;
    if (size > 0) return;
    const int kept = size_that_keeps_resolution(bake.source.map, Projection::cube);
    size =
        std::min(kLargestEnvironment, static_cast<int>(std::bit_ceil(static_cast<unsigned>(kept))));
    while (size > 1 && bytes_needed(Projection::cube, size, true) > most_bytes) size /= 2;
}

void compute_maps(Bake& bake, Plans& plans, ProgressBar& bar) {
    Stopwatch watch;
    bake.source_statistics = statistics(bake.source.map);
    make_environment(bake, bar);
    bake.exposure = usual_exposure(bake.environment.map);
    bake.timings.push_back({"cube and its mips", watch.lap()});

    make_prefiltered(bake, plans, bar);
    bake.timings.push_back({"prefiltering", watch.lap()});

    bake.radiance = analyse_nine(bake.source.map);
    bake.harmonics_error =
        compare(irradiance_map(convolved_with_cosine(bake.radiance), bake.diffuse.map),
                bake.diffuse.map)
            .relative_rmse;
    bake.timings.push_back({"spherical harmonics", watch.lap()});

    for (BakedMap* baked : {&bake.environment, &bake.specular, &bake.phong, &bake.diffuse}) {
        stop_if_interrupted();
        baked->facts = facts_of(*baked, bake.source_statistics.flux);
    }
    bake.timings.push_back({"figures", watch.lap()});
}

void write_maps(Bake& bake, const std::filesystem::path& folder) {
    Stopwatch watch;
    MapWriteOptions options;
    options.format = bake.options.format;
    for (BakedMap* baked : {&bake.environment, &bake.specular, &bake.phong, &bake.diffuse}) {
        stop_if_interrupted();
        baked->written = write_map((folder / baked->file).string(), baked->map, options);
    }
    bake.timings.push_back({"writing maps", watch.lap()});
}

}  // namespace mirrorball::cli
