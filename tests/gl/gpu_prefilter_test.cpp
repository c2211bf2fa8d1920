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

EnvironmentMap one_texel_lit(int size) {
    EnvironmentMap map = make_environment_map(Projection::cube, size);
    for (Image& face : map.levels[0].faces) std::fill(face.values().begin(), face.values().end(), 0.01f);
    map.levels[0].faces[4].set_rgb(size / 2 + size / 5, size / 3, Vec3f(20000));
    return map;
}

struct Case {
    const char* lobe;
    double most_rmse;  // next to the truth
};

// Of all lobes at once: one plan for the library's.
std::vector<Difference> errors_of(const EnvironmentMap& map, const std::vector<PrefilterTarget>& targets) {
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

TEST(GpuPrefilter, LobesAgreeWithTheLibrarys) {
    const Context context;
    const int size = 128;
    std::vector<PrefilterTarget> targets;
    for (const char* text : {"ggx:0.1", "ggx:0.2", "ggx:0.3", "ggx:0.4", "ggx:0.5", "ggx:0.6",
                             "ggx:0.8", "ggx:1", "phong:10", "phong:100", "phong:1000", "diffuse"}) {
        const Lobe lobe = parse_lobe(text);
        targets.push_back({lobe, Projection::cube,
                           std::min(MapFilter::blurred_size(lobe, size), 64),
                           default_axes(Projection::cube)});
    }
    for (const char* name : {"sunset", "studio", "noon", "dot"}) {
        const EnvironmentMap map =
            std::string_view(name) == "dot" ? one_texel_lit(size) : builtin(name, size);
        const std::vector<Difference> errors = errors_of(map, targets);
        for (std::size_t i = 0; i < targets.size(); ++i) {
            const Difference& d = errors[i];
            std::printf("%-8s %-10s %3d^2 taps %3zu  rmse %.4f  max rel %.3f  flux %.4f\n", name,
                        to_string(targets[i].lobe).c_str(), targets[i].size,
                        lobe_taps(targets[i].lobe, 2.0 / size).size(), d.relative_rmse,
                        d.maximum_relative, d.flux_ratio.x);
        }
    }
}

}  // namespace
}  // namespace mirrorball::gl
