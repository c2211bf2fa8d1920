#include "map_filter.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <mirrorball/projections/cube.h>

#include "check.h"
#include "framebuffer_guard.h"
#include "lobe_taps.h"

namespace mirrorball::gl {
namespace {

// Lobes with a core this wide, in radians, are summed over a level with such faces, into such
// faces: ggx:0.38 and up.
constexpr double kWideCore = 0.15;
constexpr int kGatheredFace = 16, kWideFace = 32, kDiffuseFace = 16;
constexpr int kTableSize = 256;
// Narrow ones, into faces with that many texels in the core.
constexpr double kTexelsInCore = 2.5;

bool is_wide(const Lobe& lobe) {
    return !lobe.is_delta() && lobe.angle_holding(0.25) >= kWideCore;
}

// The lobe's weight by the sine of half the angle, next to its largest. What the level that it is
// summed over is blurred by, a Gaussian of half a texel, is taken off: k - s^2/2 of k's Laplacian
// on the sphere. Not near the horizon, where lobes end in a kink.
Image lobe_table(const Lobe& lobe) {
    constexpr double kBlur = 0.5 * 2.0 / kGatheredFace, kStep = 0.01;
    constexpr double kSmoothBelow = 1.3;
    const auto value = [&](double angle) { return lobe.value(std::cos(angle)); };
    std::vector<double> weights;
    for (int i = 0; i < kTableSize; ++i) {
        const double angle = 2 * std::asin(i / (kTableSize - 1.0));
        double weight = value(angle);
        if (angle < kSmoothBelow) {
            const double before = value(std::abs(angle - kStep)), after = value(angle + kStep);
            const double bend = (before + after - 2 * weight) / (kStep * kStep);
            const double slope = (after - before) / (2 * kStep);
            const double laplacian = i == 0 ? 2 * bend : bend + slope / std::tan(angle);
            weight = std::max(0.0, weight - kBlur * kBlur / 2 * laplacian);
        }
        weights.push_back(weight);
    }
    const double largest = *std::max_element(weights.begin(), weights.end());
    Image table(kTableSize, 1, 1);
    for (int i = 0; i < kTableSize; ++i)
        *table.at(i, 0) = static_cast<float>(weights[static_cast<std::size_t>(i)] / largest);
    return table;
}

Texture cube_room(int size, bool levels) {
    const int level_count = levels ? 1 + static_cast<int>(std::log2(size)) : 1;
    return make_texture(GL_TEXTURE_CUBE_MAP, size, size, level_count, Cube::face_count);
}

// What can be looked up until further notice.
void show_levels(const Texture& cube, int first, int last) {
    cube.bind(0);
    glTexParameteri(cube.target, GL_TEXTURE_BASE_LEVEL, first);
    glTexParameteri(cube.target, GL_TEXTURE_MAX_LEVEL, last);
}

}  // namespace

MapTextures MapFilter::room(int size, const Material& material) {
    MapTextures maps;
    maps.mirror = cube_room(size, true);
    if (material.glossy > 0) {
        maps.glossy.push_back(cube_room(blurred_size(material.lobe, size), false));
    }
    if (material.diffuse > 0)
        maps.diffuse = cube_room(blurred_size({Lobe::Kind::diffuse}, size), false);
    return maps;
}

void MapFilter::make(const MapTextures& maps, const Material& material) {
    make_levels(maps.mirror);
    if (!maps.glossy.empty()) blur(maps.mirror, material.lobe, maps.glossy[0]);
    if (!maps.diffuse.empty()) blur(maps.mirror, {Lobe::Kind::diffuse}, maps.diffuse);
}

int MapFilter::blurred_size(const Lobe& lobe, int source_size) {
    if (lobe.kind == Lobe::Kind::diffuse) return std::min(source_size, kDiffuseFace);
    if (is_wide(lobe)) return std::min(source_size, kWideFace);
    // Made for each picture, it is coarser than what is made once (glossy_map_size()).
    int size = kWideFace;
    while (size < source_size && 2.0 / size * kTexelsInCore > lobe.angle_holding(0.25)) size *= 2;
    return std::min(source_size, size);
}

void MapFilter::draw_faces(const Program& program, const Texture& into, int level) const {
    const FramebufferGuard guard;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    const int size = std::max(1, into.width >> level);
    glViewport(0, 0, size, size);
    glDisable(GL_DEPTH_TEST);
    make_cubes_seamless();
    glBindVertexArray(nothing_.name());
    program.set("u_size", static_cast<float>(size));
    for (int face = 0; face < Cube::face_count; ++face) {
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
                               GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face),
                               into.name.name(), level);
        if (face == 0) check_framebuffer("filtering a cube map");
        program.set("u_face", face);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    check("filtering a cube map");
}

void MapFilter::make_levels(const Texture& cube) {
    const Program& program = programs_.get("full.vert", "halve.frag");
    program.use();
    program.set("u_cube", 0);
    for (int level = 1; level < cube.level_count; ++level) {
        show_levels(cube, level - 1, level - 1);
        program.set("u_step", 0.75f / static_cast<float>(std::max(1, cube.width >> (level - 1))));
        draw_faces(program, cube, level);
    }
    show_levels(cube, 0, cube.level_count - 1);
}

const std::vector<Imath::V4f>& MapFilter::taps_for(const Lobe& lobe, int source_size) {
    const auto found = std::find_if(taps_.begin(), taps_.end(), [&](const Taps& taps) {
        return taps.lobe == lobe && taps.source_size == source_size;
    });
    if (found != taps_.end()) return found->taps;
    // A texel's edge in the middle of a face is 2 / size.
    return taps_.emplace_back(Taps{lobe, source_size, lobe_taps(lobe, 2.0 / source_size)}).taps;
}

const Texture& MapFilter::table_for(const Lobe& lobe) {
    const auto found = std::find_if(tables_.begin(), tables_.end(),
                                    [&](const Table& table) { return table.lobe == lobe; });
    if (found != tables_.end()) return found->texture;
    return tables_.emplace_back(Table{lobe, upload(lobe_table(lobe))}).texture;
}

void MapFilter::blur(const Texture& cube, const Lobe& lobe, const Texture& into, int level) {
    if (is_wide(lobe)) {
        gather(cube, lobe, into, level);
    } else {
        blur_by_taps(cube, lobe, into, level);
    }
}

void MapFilter::blur_by_taps(const Texture& cube, const Lobe& lobe, const Texture& into,
                             int level) {
    const std::vector<Imath::V4f>& taps = taps_for(lobe, cube.width);
    const Program& program =
        programs_.get("full.vert", "blur.frag", {fmt::format("TAP_COUNT {}", taps.size())});
    program.use();
    cube.bind(0);
    program.set("u_cube", 0);
    program.set("u_taps", taps);
    draw_faces(program, into, level);
}

void MapFilter::gather(const Texture& cube, const Lobe& lobe, const Texture& into, int level) {
    int source_level = 0;
    while (cube.width >> source_level > kGatheredFace) ++source_level;
    const Texture& table = table_for(lobe);
    const Program& program = programs_.get("full.vert", "gather.frag");
    program.use();
    cube.bind(0);
    program.set("u_cube", 0);
    table.bind(1);
    program.set("u_lobe", 1);
    program.set("u_level", source_level);
    program.set("u_integral", static_cast<float>(lobe.integral()));
    draw_faces(program, into, level);
}

}  // namespace mirrorball::gl
