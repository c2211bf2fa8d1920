// Martin Newell's teapot, 1975: the control points of its bicubic Bezier patches, in the form that
// everyone has: z up, squashed to 3/4 of its height by Blinn, with the bottom that Crow added in
// 1987 ("The Origins of the Teapot", IEEE CG&A). The lid overlaps the rim, handle and spout stick
// through the body, and the tip of the spout is open: it is a picture of a teapot, and never was a
// closed surface.
//
// Newell lists 32 patches. Pot and lid are turned: each row of a patch is a quarter circle, all but
// (r, 0) (r, -kr) (kr, -r) (0, -r) with k = 0.56, so a row is written as its r, k r and height.
// Handle and spout are written as the half with y <= 0 and mirrored. Every u runs so that
// S_u x S_v points outside.
#include "teapot.h"

#include <algorithm>
#include <array>

#include "grid.h"

namespace mirrorball::detail {
namespace {

struct Ring {
    double radius, inner, height;
};

constexpr Ring kLid[] = {
    {0, 0, 3.15},       {0.8, 0.45, 3.15},  {0, 0, 2.85},      {0.2, 0.112, 2.7},
    {0.4, 0.224, 2.55}, {1.3, 0.728, 2.55}, {1.3, 0.728, 2.4},
};
constexpr Ring kPot[] = {
    {1.4, 0.784, 2.4},   {1.3375, 0.749, 2.53125}, {1.4375, 0.805, 2.53125}, {1.5, 0.84, 2.4},
    {1.75, 0.98, 1.875}, {2, 1.12, 1.35},          {2, 1.12, 0.9},           {2, 1.12, 0.45},
    {1.5, 0.84, 0.225},  {1.5, 0.84, 0.15},        {1.5, 0.84, 0.075},       {1.425, 0.798, 0},
    {0, 0, 0},
};

using Row = std::array<Vec3d, 4>;

// A half of a ring around a tube whose first and last points lie on y = 0.
constexpr double kHandleWidth = 0.3;
struct HalfRing {
    double first_x, first_z, last_x, last_z, width;
};
constexpr HalfRing kHandle[] = {
    {-1.6, 2.025, -1.5, 2.25, kHandleWidth}, {-2.3, 2.025, -2.5, 2.25, kHandleWidth},
    {-2.7, 2.025, -3, 2.25, kHandleWidth},   {-2.7, 1.8, -3, 1.8, kHandleWidth},
    {-2.7, 1.575, -3, 1.35, kHandleWidth},   {-2.5, 1.125, -2.65, 0.9375, kHandleWidth},
    {-2, 0.9, -1.9, 0.6, kHandleWidth},
};
constexpr HalfRing kSpout[] = {
    {1.7, 1.425, 1.7, 0.6, 0.66},       {2.6, 1.425, 3.1, 0.825, 0.66},
    {2.3, 2.1, 2.4, 2.025, 0.25},       {2.7, 2.4, 3.3, 2.4, 0.25},
    {2.8, 2.475, 3.525, 2.49375, 0.25}, {2.9, 2.475, 3.45, 2.5125, 0.15},
    {2.8, 2.4, 3.2, 2.4, 0.15},
};

Row row_of(const Ring& ring) {
    const auto& [r, k, z] = ring;
    return {Vec3d(r, 0, z), Vec3d(r, -k, z), Vec3d(k, -r, z), Vec3d(0, -r, z)};
}

Row row_of(const HalfRing& half) {
    return {Vec3d(half.first_x, 0, half.first_z), Vec3d(half.first_x, -half.width, half.first_z),
            Vec3d(half.last_x, -half.width, half.last_z), Vec3d(half.last_x, 0, half.last_z)};
}

// A cubic's weights and those of its derivative.
struct Weights {
    double value[4], slope[4];

    explicit Weights(double t) {
        const double s = 1 - t;
        value[0] = s * s * s, value[1] = 3 * s * s * t, value[2] = 3 * s * t * t;
        value[3] = t * t * t;
        slope[0] = -3 * s * s, slope[1] = 3 * s * (s - 2 * t), slope[2] = 3 * t * (2 * s - t);
        slope[3] = 3 * t * t;
    }
};

using Patch = std::array<Row, 4>;

Vec3d blend(const Patch& patch, const double (&across)[4], const double (&along)[4]) {
    Vec3d sum(0);
    for (int row = 0; row < 4; ++row)
        for (int i = 0; i < 4; ++i) sum += patch[row][i] * (along[row] * across[i]);
    return sum;
}

GridVertex evaluate(const Patch& patch, double u, double v) {
    const Weights across(u), along(v);
    const Vec3d along_v = blend(patch, across.value, along.slope);
    Vec3d along_u = blend(patch, across.slope, along.value);
    // At a row that is a point (the knob's top, the bottom's centre) S_u is 0, and beside it
    // S_u = (v - v0) S_uv to first order: what has the direction is S_uv.
    constexpr double kVanishes = 1e-9;
    if (along_u.length() < kVanishes)
        along_u = blend(patch, across.slope, along.slope) * (v < 0.5 ? 1 : -1);
    return {blend(patch, across.value, along.value), along_u.cross(along_v).normalized()};
}

// Into our axes, 2 wide in x, the box around the surface centred. The least x is the handle's; the
// most is the spout's, where the derivative of (3.3, 3.525, 3.45, 3.2) is 0.
constexpr double kLeastX = -3, kMostX = 3.4340751255;
constexpr double kMostZ = 3.15;

GridVertex in_our_world(const GridVertex& vertex) {
    constexpr double kScale = 2 / (kMostX - kLeastX);
    const Vec3d p = (vertex.position - Vec3d((kLeastX + kMostX) / 2, 0, kMostZ / 2)) * kScale;
    const Vec3d& n = vertex.normal;
    return {{p.x, p.z, -p.y}, {n.x, n.z, -n.y}};
}

// The surface below column `u` from the left: a quarter, or half a tube, and then the next of them.
// u grows to the left, seen from outside, and columns to the right.
template <class Sides, class Rings>
void add_sheet(Mesh& mesh, const Rings& rings, int side_count, int detail, const Sides& on_side,
               double top, double bottom) {
    const int columns = side_count * detail;
    const int rows = static_cast<int>(std::size(rings) - 1) / 3 * detail;
    add_grid(
        mesh, columns, rows,
        [&](int column, int row) {
            const int step = (columns - column) % columns;
            const int first = std::min(row, rows - 1) / detail;
            Patch patch;
            for (int i = 0; i < 4; ++i) patch[i] = row_of(rings[3 * first + i]);
            const double v = double(row - first * detail) / detail;
            return in_our_world(on_side(patch, step / detail, double(step % detail) / detail, v));
        },
        top, bottom);
}

Vec3d quarter_turned(const Vec3d& p, int quarters) {
    switch (quarters) {
        case 0:
            return p;
        case 1:
            return {p.y, -p.x, p.z};
        case 2:
            return {-p.x, -p.y, p.z};
        default:
            return {-p.y, p.x, p.z};
    }
}

GridVertex on_quarter(const Patch& patch, int quarter, double u, double v) {
    const GridVertex vertex = evaluate(patch, u, v);
    return {quarter_turned(vertex.position, quarter), quarter_turned(vertex.normal, quarter)};
}

GridVertex on_half(const Patch& patch, int half, double u, double v) {
    if (half == 0) return evaluate(patch, u, v);
    const auto mirrored = [](const Vec3d& p) { return Vec3d(p.x, -p.y, p.z); };
    const GridVertex vertex = evaluate(patch, 1 - u, v);
    return {mirrored(vertex.position), mirrored(vertex.normal)};
}

}  // namespace

Mesh make_teapot(int detail) {
    Mesh mesh;
    // A picture around the teapot: the lid has its upper third.
    add_sheet(mesh, kLid, 4, detail, on_quarter, 0, 1.0 / 3);
    add_sheet(mesh, kPot, 4, detail, on_quarter, 1.0 / 3, 1);
    add_sheet(mesh, kHandle, 2, detail, on_half, 0, 1);
    add_sheet(mesh, kSpout, 2, detail, on_half, 0, 1);
    return mesh;
}

}  // namespace mirrorball::detail
