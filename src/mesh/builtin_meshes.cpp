// Meshes made of equations.
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <mirrorball/error.h>
#include <mirrorball/mesh.h>

#include "grid.h"
#include "teapot.h"
#include "tidy.h"

namespace mirrorball {
namespace {

using detail::GridVertex;

struct Turn {
    double cosine, sine;
};

// The angle of `step` out of `per_quarter` steps to a quarter turn. Exact at whole quarters, so
// that poles are points and seams close to the bit.
Turn turn(int step, int per_quarter) {
    const double angle = kPi / 2 * (step % per_quarter) / per_quarter;
    const double c = std::cos(angle), s = std::sin(angle);
    switch (step / per_quarter % 4) {
        case 0:
            return {c, s};
        case 1:
            return {-s, c};
        case 2:
            return {-c, -s};
        default:
            return {s, -c};
    }
}

// Columns go from -z by -x, +z and +x back to -z: to the right, seen from outside.
Mesh sphere(int detail) {
    Mesh mesh;
    detail::add_grid(mesh, 4 * detail, 2 * detail, [&](int column, int row) {
        const Turn around = turn(column, detail), down = turn(row, detail);
        const Vec3d p(-down.sine * around.sine, down.cosine, -down.sine * around.cosine);
        return GridVertex{p, p};
    });
    return mesh;
}

// The seams are where the tube is next to the axis, and at -z.
Mesh torus(int detail) {
    constexpr double kTubeRadius = 0.4;
    const int ring = 2 * detail;  // the ring is 2.5 times as long as the tube is round
    Mesh mesh;
    detail::add_grid(mesh, 4 * ring, 4 * detail, [&](int column, int row) {
        const Turn around = turn(column, ring), along = turn(row, detail);
        const Vec3d outward(-around.sine, 0, -around.cosine);
        const Vec3d normal = outward * -along.cosine + Vec3d(0, along.sine, 0);
        return GridVertex{outward + normal * kTubeRadius, normal};
    });
    return mesh;
}

// The square of half-width 1 around `normal`; right and down as seen from outside.
void add_square(Mesh& mesh, int detail, const Vec3d& normal, const Vec3d& right,
                const Vec3d& down) {
    detail::add_grid(mesh, detail, detail, [&](int column, int row) {
        const double a = 2.0 * column / detail - 1, b = 2.0 * row / detail - 1;
        return GridVertex{right * a + down * b, normal};
    });
}

Mesh plane(int detail) {
    Mesh mesh;
    add_square(mesh, detail, {0, 1, 0}, {1, 0, 0}, {0, 0, 1});
    return mesh;
}

Mesh cube(int detail) {
    const Vec3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    const Vec3d sides[6][3] = {{x, -z, -y}, {-x, z, -y}, {y, x, z},
                               {-y, x, -z}, {z, x, -y},  {-z, -x, -y}};
    Mesh mesh;
    for (const auto& [normal, right, down] : sides) {
        const std::size_t first = mesh.positions.size();
        add_square(mesh, detail, normal, right, down);
        for (std::size_t i = first; i < mesh.positions.size(); ++i)
            mesh.positions[i] += Vec3f(normal);
    }
    return mesh;
}

struct Builtin {
    std::string_view name, description;
    Mesh (*make)(int detail);
    int usual_detail;
};

constexpr int kMostDetail = 512;

// Plane and cube are cut finely too: methods that look up per vertex are to show what they can.
constexpr Builtin kBuiltins[] = {
    {"sphere", "radius 1; poles on y", sphere, 32},
    {"torus", "about y; radius 1 to the middle of a tube of radius 0.4", torus, 20},
    {"plane", "-1 to 1 in x and z, facing +y", plane, 32},
    {"cube", "-1 to 1; flat faces", cube, 32},
    {"teapot", "Newell's, spout towards +x, 2 wide", detail::make_teapot, 16},
};

}  // namespace

std::vector<BuiltinMesh> builtin_meshes() {
    std::vector<BuiltinMesh> result;
    for (const Builtin& builtin : kBuiltins)
        result.push_back({std::string(builtin.name), std::string(builtin.description)});
    return result;
}

Mesh make_mesh(std::string_view name, int detail) {
    if (detail < 0 || detail > kMostDetail)
        throw Error(Errc::usage, fmt::format("mesh {}: its detail is {} (expected 0 to {})", name,
                                             detail, kMostDetail));
    std::string names;
    for (const Builtin& builtin : kBuiltins) {
        if (builtin.name == name) {
            Mesh mesh = builtin.make(detail == 0 ? builtin.usual_detail : detail);
            detail::tidy(mesh);
            return mesh;
        }
        names += fmt::format("{}{}", names.empty() ? "" : ", ", builtin.name);
    }
    throw Error(Errc::usage, fmt::format("there is no mesh '{}' (expected {})", name, names));
}

}  // namespace mirrorball
