#include "prefilter/light_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "image/for_each_texel.h"

namespace mirrorball::detail {
namespace {

// A cell stands for its children while its radius is at most this share of the scale on which the
// lobe varies over it. Light is taken to come from where it comes on average, so the error goes
// with the square of this; the time goes with its inverse square.
constexpr double kOpening = 0.13;

// A lobe has a crease at its horizon; cells that lie across it are opened further.
constexpr double kCreaseOpening = 0.03;

// Light that weighs less than this share of the axis's is left out.
constexpr double kNegligible = 1e-7;

constexpr int kLargestFace = 1024;

// From the steepest of a table's lines; no finer than a texel of 2048 along the equator.
double table_scale(const LobeTable& table) {
    double slope = 0;
    for (std::size_t i = 1; i < table.angles.size(); ++i)
        slope = std::max(slope, std::abs(table.weights[i] - table.weights[i - 1]) /
                                    (table.angles[i] - table.angles[i - 1]));
    const double peak = *std::max_element(table.weights.begin(), table.weights.end());
    return std::clamp(peak / (2 * slope), 0.003, 0.3);
}

// Wide lobes end in a crease at the horizon, which bounds their scale.
double scale_of(const Lobe& lobe) {
    const double exponent = std::max(lobe.parameter, 1.0);
    switch (lobe.kind) {
        case Lobe::Kind::phong:
            return std::min(0.6, 1.5 / std::sqrt(exponent));
        case Lobe::Kind::blinn_phong:
            return std::min(0.6, 3.0 / std::sqrt(exponent));
        case Lobe::Kind::ggx:
            return std::min(0.5, 1.2 * lobe.parameter * lobe.parameter);
        case Lobe::Kind::charlie:
            return std::min(0.3, 2 * lobe.parameter * lobe.parameter);
        case Lobe::Kind::tabulated:
            return table_scale(*lobe.table);
        default:
            return 0.6;
    }
}

// By bisection: every lobe falls monotonically but for rings and tables, which reach all they can.
double reach_of(const LobeKernel& kernel, Lobe::Kind kind) {
    if (kind == Lobe::Kind::charlie || kind == Lobe::Kind::tabulated)
        return 2 * std::sin(kernel.widest_angle() / 2);
    const double least = kNegligible * kernel(1);
    double near = 0, far = std::sqrt(2.0);
    for (int i = 0; i < 50; ++i) {
        const double middle = (near + far) / 2;
        (kernel(1 - middle * middle / 2) > least ? near : far) = middle;
    }
    return far;
}

// So that a cell holds about one texel, or none.
int finest_level(const EnvironmentMap& source) {
    const double texel_count =
        static_cast<double>(face_count(source.projection)) * source.width() * source.height();
    const unsigned size = std::bit_ceil(static_cast<unsigned>(std::sqrt(texel_count / 6)) + 1);
    return std::bit_width(std::min(size, unsigned{kLargestFace})) - 1;
}

// Cells in Morton order: the bits of x and y take turns, x first.
std::size_t morton(int x, int y) {
    std::size_t index = 0;
    for (int bit = 0; (x >> bit) + (y >> bit) > 0; ++bit)
        index |= static_cast<std::size_t>((x >> bit) & 1) << (2 * bit) |
                 static_cast<std::size_t>((y >> bit) & 1) << (2 * bit + 1);
    return index;
}

struct Place {
    int x, y;
};
Place from_morton(std::size_t index) {
    Place place{0, 0};
    for (int bit = 0; index > 0; ++bit, index >>= 2) {
        place.x |= static_cast<int>(index & 1) << bit;
        place.y |= static_cast<int>(index >> 1 & 1) << bit;
    }
    return place;
}

double brightness(const Vec3f& flux) {
    return std::abs(flux.x) + std::abs(flux.y) + std::abs(flux.z);
}

}  // namespace

TreeLobe::TreeLobe(const Lobe& lobe)
    : kernel(lobe),
      integral(lobe.integral()),
      scale(scale_of(lobe)),
      reach(reach_of(kernel, lobe.kind)),
      power_tail(lobe.kind == Lobe::Kind::ggx) {
    if (lobe.kind != Lobe::Kind::phong && lobe.kind != Lobe::Kind::blinn_phong) return;
    table_scale = kTableSteps / (reach * reach);
    const double peak = kernel(1);
    for (int i = 0; i <= kTableSteps; ++i)
        table.push_back(static_cast<float>(kernel(1 - i / table_scale / 2) / peak));
}

LightTree::LightTree(const EnvironmentMap& source) : levels_(finest_level(source) + 1) {
    for (int level = 0; level < static_cast<int>(levels_.size()); ++level)
        levels_[level].resize(std::size_t{6} << (2 * level));
    sort_in(source);
    for (int level = static_cast<int>(levels_.size()) - 2; level >= 0; --level)
        gather_children(level);
    for (int level = 0; level < static_cast<int>(levels_.size()); ++level) finish(level);
}

// Until finish(), a cell's direction is the sum of its texels' directions, weighed by their light.
void LightTree::sort_in(const EnvironmentMap& source) {
    const int level = static_cast<int>(levels_.size()) - 1, size = 1 << level;
    for_each_direction(
        source, 0, [&](const Vec3d& direction, const Vec3f& radiance, double solid_angle) {
            const FacePoint<double> at = Cube::project(direction);
            const std::size_t place = morton(std::min(static_cast<int>(at.s * size), size - 1),
                                             std::min(static_cast<int>(at.t * size), size - 1));
            Cell& cell = levels_[level][(static_cast<std::size_t>(at.face) << 2 * level) + place];
            const Vec3f flux = radiance * static_cast<float>(solid_angle);
            // a trace of solid angle gives dark cells a direction, too
            cell.direction += Vec3f(direction * (brightness(flux) + 1e-6 * solid_angle));
            cell.flux += flux;
            cell.solid_angle += static_cast<float>(solid_angle);
        });
}

void LightTree::gather_children(int level) {
    for (std::size_t i = 0; i < levels_[level].size(); ++i) {
        Cell& cell = levels_[level][i];
        for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) {
            const Cell& child = levels_[level + 1][k];
            cell.direction += child.direction;
            cell.flux += child.flux;
            cell.solid_angle += child.solid_angle;
        }
    }
}

void LightTree::finish(int level) {
    const std::size_t size = std::size_t{1} << level, face_cells = size * size;
    parallel_for(6 * static_cast<std::int64_t>(size), [&](std::int64_t part) {
        for (std::size_t i = part * size; i < (part + 1) * size; ++i) {
            Cell& cell = levels_[level][i];
            if (cell.solid_angle == 0) continue;
            const auto [x, y] = from_morton(i % face_cells);
            const Vec3d sum(cell.direction), centre = sum / sum.length();
            double radius = 0;
            for (const auto& [dx, dy] :
                 {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)}) {
                const double edge = 1.0 / static_cast<double>(size);
                const FacePoint<double> corner{static_cast<int>(i / face_cells), (x + dx) * edge,
                                               (y + dy) * edge};
                radius = std::max(radius, (Cube::direction(corner) - centre).length());
            }
            cell.direction = Vec3f(centre);
            cell.radius = static_cast<float>(radius);
        }
    });
}

struct LightTree::Nearest {
    Vec3d axis;
    double chord = 3;
    const Cell* cell = nullptr;
};

// What one lobe about one axis gathers on its way down the tree.
struct LightTree::Walk {
    const TreeLobe& lobe;
    Vec3d axis;
    Vec3d sum{0.0};
    double weight = 0;
};

void LightTree::visit_cell(Walk& walk, std::size_t level, std::size_t index) const {
    const Cell& cell = levels_[level][index];
    if (cell.solid_angle == 0) return;
    const TreeLobe& lobe = walk.lobe;
    const double cosine = std::min(1.0, walk.axis.dot(Vec3d(cell.direction)));
    const double chord2 = 2 - 2 * cosine, radius = cell.radius, beyond = lobe.reach + radius;
    if (chord2 > beyond * beyond) return;
    const double scale2 = lobe.scale * lobe.scale + (lobe.power_tail ? chord2 : 0);
    const double opening = std::abs(cosine) < radius ? kCreaseOpening : kOpening;
    if (level + 1 == levels_.size() || radius * radius <= opening * opening * scale2) {
        const double weight = lobe.weight(chord2);
        walk.sum += Vec3d(cell.flux) * weight;
        walk.weight += weight * cell.solid_angle;
        return;
    }
    for (std::size_t k = 4 * index; k < 4 * index + 4; ++k) visit_cell(walk, level + 1, k);
}

// The lit cell nearest to the axis, passing over all that cannot be nearer than the best so far.
void LightTree::visit_nearest(Nearest& nearest, std::size_t level, std::size_t index) const {
    const Cell& cell = levels_[level][index];
    if (cell.solid_angle == 0) return;
    const double chord = (Vec3d(cell.direction) - nearest.axis).length();
    if (chord - cell.radius >= nearest.chord) return;
    if (level + 1 == levels_.size()) {
        if (chord < nearest.chord) nearest.chord = chord, nearest.cell = &cell;
        return;
    }
    for (std::size_t k = 4 * index; k < 4 * index + 4; ++k) visit_nearest(nearest, level + 1, k);
}

Vec3d LightTree::filtered(const TreeLobe& lobe, const Vec3d& axis) const {
    Walk walk{lobe, axis};
    for (std::size_t face = 0; face < 6; ++face) visit_cell(walk, 0, face);
    if (walk.weight < std::numeric_limits<double>::min()) {
        // narrower than a texel: the nearest is all that the lobe could see
        Nearest nearest{axis};
        for (std::size_t face = 0; face < 6; ++face) visit_nearest(nearest, 0, face);
        return Vec3d(nearest.cell->flux) * (lobe.integral / nearest.cell->solid_angle);
    }
    return walk.sum * (lobe.integral / walk.weight);
}

}  // namespace mirrorball::detail
