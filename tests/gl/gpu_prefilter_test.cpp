// What the graphics card makes of a cube map, next to the library's own prefilter.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include <mirrorball/builtin.h>
#include <mirrorball/compare.h>
#include <mirrorball/gl/context.h>
#include <mirrorball/prefilter.h>
#include <mirrorball/projections/cube.h>
#include <mirrorball/reflection_maps.h>
#include <mirrorball/resample.h>

#include "gl/framebuffer_guard.h"
#include "gl/lobe_taps.h"
#include "gl/map_filter.h"

namespace mirrorball::gl {
namespace {

EnvironmentMap read_back(const Texture& cube, int level = 0) {
    const int size = std::max(1, cube.width >> level);
    EnvironmentMap map = make_environment_map(Projection::cube, size);
    const FramebufferGuard guard;
    const Framebuffer framebuffer;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    Image texels(size, size, 4);
    for (int face = 0; face < Cube::face_count; ++face) {
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
                               GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face),
                               cube.name.name(), level);
        glReadPixels(0, 0, size, size, GL_RGBA, GL_FLOAT, texels.values().data());
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x)
                std::copy_n(texels.at(x, y), 3, map.levels[0].faces[face].at(x, y));
        }
    }
    return map;
}

EnvironmentMap builtin(std::string_view name, int size) {
    return make_builtin(name, Projection::cube, size, default_axes(Projection::cube));
}

// A cube texture whose levels are made by the filter, with the map's light.
Texture cube_of(const EnvironmentMap& map, MapFilter& filter) {
    EnvironmentMap with_levels = map;
    append_mip_levels(with_levels);
    Texture cube = upload(with_levels);
    filter.make_levels(cube);
    return cube;
}

// The sum of all texels' directions, by their light.
void add_directions(const EnvironmentMap& map, Vec3d& sum) {
    const int size = map.width();
    for (int face = 0; face < Cube::face_count; ++face) {
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                const FacePoint<double> place{face, (x + 0.5) / size, (y + 0.5) / size};
                sum += Cube::direction(place) *
                       (Cube::density(place) * map.levels[0].faces[face].at(x, y)[0]);
            }
        }
    }
}

EnvironmentMap one_texel_lit(int size) {
    EnvironmentMap map = make_environment_map(Projection::cube, size);
    for (Image& face : map.levels[0].faces)
        std::fill(face.values().begin(), face.values().end(), 0.01f);
    map.levels[0].faces[4].set_rgb(size / 2 + size / 5, size / 3, Vec3f(20000));
    return map;
}

// Of all lobes at once: one plan for the library's.
std::vector<Difference> errors_of(const EnvironmentMap& map,
                                  const std::vector<PrefilterTarget>& targets) {
    MapFilter filter;
    const std::vector<EnvironmentMap> truths = prefilter(map, targets);
    const Texture cube = cube_of(map, filter);
    std::vector<Difference> errors;
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const Texture blurred =
            make_texture(GL_TEXTURE_CUBE_MAP, targets[i].size, targets[i].size, 1, 6);
        filter.blur(cube, targets[i].lobe, blurred);
        errors.push_back(compare(read_back(blurred), truths[i]));
    }
    return errors;
}

constexpr int kSourceSize = 128;

PrefilterTarget target_for(std::string_view text) {
    const Lobe lobe = parse_lobe(text);
    const int size = MapFilter::blurred_size(lobe, kSourceSize);
    return {lobe, Projection::cube, size <= 32 ? 16 : 64,  // few texels of wide ones will do
            default_axes(Projection::cube)};
}

void expect_agreement(std::string_view name, const EnvironmentMap& map,
                      const std::vector<PrefilterTarget>& targets, double most_rmse,
                      double most_flux_error) {
    const std::vector<Difference> errors = errors_of(map, targets);
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const Difference& d = errors[i];
        const std::string lobe = to_string(targets[i].lobe);
        std::printf("%-7s %-10s %2d^2  rmse %.4f  flux %.4f\n", std::string(name).c_str(),
                    lobe.c_str(), targets[i].size, d.relative_rmse, d.flux_ratio.x);
        EXPECT_LT(d.relative_rmse, most_rmse) << name << " " << lobe;
        EXPECT_NEAR(d.flux_ratio.x, 1, most_flux_error) << name << " " << lobe;
    }
}

// Summed over a level of 16 x 16 faces: what is left is how that level was made. Bounds are what
// was measured, and half as much again.
TEST(GpuPrefilter, WideLobesAgreeWithTheLibrarys) {
    const Context context;
    const std::vector<PrefilterTarget> targets = {target_for("ggx:0.4"),  target_for("ggx:0.5"),
                                                  target_for("ggx:0.7"),  target_for("ggx:1"),
                                                  target_for("phong:10"), target_for("diffuse")};
    expect_agreement("sunset", builtin("sunset", kSourceSize), targets, 0.025, 0.005);
    expect_agreement("studio", builtin("studio", kSourceSize), targets, 0.03, 0.007);
    expect_agreement("texel", one_texel_lit(kSourceSize), targets, 0.03, 0.005);
}

// Spots of a few texels: next to a light of one texel their grid shows.
TEST(GpuPrefilter, NarrowLobesAgreeWithTheLibrarys) {
    const Context context;
    const std::vector<PrefilterTarget> targets = {target_for("ggx:0.1"), target_for("ggx:0.2"),
                                                  target_for("ggx:0.3"), target_for("phong:100"),
                                                  target_for("phong:1000")};
    expect_agreement("sunset", builtin("sunset", kSourceSize), targets, 0.14, 0.02);
    expect_agreement("studio", builtin("studio", kSourceSize), targets, 0.045, 0.035);
    expect_agreement("texel", one_texel_lit(kSourceSize), targets, 0.2, 0.04);
}

TEST(GpuPrefilter, UniformLightStaysUniform) {
    const Context context;
    MapFilter filter;
    EnvironmentMap map = make_environment_map(Projection::cube, 32);
    for (Image& face : map.levels[0].faces)
        std::fill(face.values().begin(), face.values().end(), 2.0f);
    const Texture cube = cube_of(map, filter);
    const Texture blurred = make_texture(GL_TEXTURE_CUBE_MAP, 16, 16, 1, 6);
    for (const char* text : {"ggx:0.2", "ggx:0.6", "phong:50", "diffuse", "charlie:0.5"}) {
        const Lobe lobe = parse_lobe(text);
        filter.blur(cube, lobe, blurred);
        const LevelStatistics facts = statistics(read_back(blurred));
        const double expected = 2 * lobe.integral();
        EXPECT_NEAR(facts.minimum.x, expected, expected * 2e-3) << text;  // half floats
        EXPECT_NEAR(facts.maximum.x, expected, expected * 2e-3) << text;
    }
}

// The sum of what the taps weigh, and their directions, by themselves.
TEST(GpuPrefilter, TapsAddUpToTheLobe) {
    for (const char* text : {"ggx:0.05", "ggx:0.2", "ggx:0.37", "phong:30", "phong:10000"}) {
        const std::vector<Imath::V4f> taps = lobe_taps(parse_lobe(text), 2.0 / 256);
        double sum = 0;
        for (const Imath::V4f& tap : taps) {
            sum += tap.w;
            EXPECT_GE(tap.w, 0);
            EXPECT_LE(tap.x * tap.x + tap.y * tap.y, 1);
        }
        EXPECT_NEAR(sum, 1, 1e-5) << text;
        EXPECT_LE(taps.size(), 200u) << text;  // uniforms of ES 3.0: 224
    }
}

// Halving keeps light where it is: its centre of mass stays within a few percent of a texel.
TEST(GpuPrefilter, LevelsKeepLightAndItsPlace) {
    const Context context;
    MapFilter filter;
    EnvironmentMap map = make_environment_map(Projection::cube, 32);
    map.levels[0].faces[0].set_rgb(13, 18, Vec3f(1000));
    const Texture cube = cube_of(map, filter);
    const auto centre = [](const EnvironmentMap& m) {
        Vec3d sum(0);
        add_directions(m, sum);
        return sum.normalized();
    };
    const Vec3d expected = centre(map);
    for (int level = 1; level <= 3; ++level) {
        const EnvironmentMap halved = read_back(cube, level);
        EXPECT_NEAR(flux(halved).x / flux(map).x, 1, 0.04) << level;
        const double texel = 2.0 / halved.width();
        EXPECT_LT((centre(halved) - expected).length(), 0.06 * texel) << level;
    }
}

}  // namespace
}  // namespace mirrorball::gl
