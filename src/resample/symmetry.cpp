#include "resample/symmetry.h"

#include <cmath>
#include <optional>
#include <utility>

namespace mirrorball::detail {
namespace {

// The 48 symmetries of the cube, as frames: the axes in any order and of any sign. The identity is
// the first.
std::vector<Axes> cube_symmetries() {
    std::vector<Axes> all;
    for (const auto& [a, b, c] : {std::array{0, 1, 2}, std::array{0, 2, 1}, std::array{1, 0, 2},
                                  std::array{1, 2, 0}, std::array{2, 0, 1}, std::array{2, 1, 0}})
        for (int signs = 0; signs < 8; ++signs) {
            Axes axes{Vec3d(0.0), Vec3d(0.0), Vec3d(0.0)};
            axes.x[a] = signs & 1 ? -1 : 1;
            axes.y[b] = signs & 2 ? -1 : 1;
            axes.z[c] = signs & 4 ? -1 : 1;
            all.push_back(axes);
        }
    return all;
}

// Points in no special place, on the used part of every projection and off it; enough of them that
// no face is carried to itself but by what carries each of its texels.
constexpr std::pair<double, double> kProbes[] = {{0.31, 0.42}, {0.62, 0.77}, {0.23, 0.71},
                                                 {0.55, 0.09}, {0.88, 0.46}, {0.87, 0.81},
                                                 {0.12, 0.93}, {0.07, 0.16}};

FacePoint<double> moved(const FacePoint<double>& p, const Move& move) {
    const double s = (move.flip_s ? 1 - p.s : p.s) + 0.25 * move.quarters;
    return {move.face, s >= 1 ? s - 1 : s, move.flip_t ? 1 - p.t : p.t};
}

template <class P>
bool carries(int face, const Axes& symmetry, const Move& move) {
    for (const auto& [s, t] : kProbes) {
        const FacePoint<double> p{face, s, t};
        if (!P::covers(p)) continue;
        const Vec3d expected = symmetry.to_world(P::direction(p)),
                    found = P::direction(moved(p, move));
        if ((found - expected).length() > 1e-9) return false;
    }
    return true;
}

// How a symmetry moves a face, found by trying all ways to move one. Rows have to stay rows.
template <class P>
std::optional<Move> find_move(int face, const Axes& symmetry, int quarters) {
    for (int to = 0; to < P::face_count; ++to)
        for (int way = 0; way < 4 * quarters; ++way) {
            const Move move{to, (way & 1) != 0, (way & 2) != 0, way / 4};
            if (carries<P>(face, symmetry, move)) return move;
        }
    return std::nullopt;
}

std::optional<Moves> find_source_moves(const Grid& source, const Axes& symmetry) {
    return visit(source.projection, [&](auto p) -> std::optional<Moves> {
        using P = decltype(p);
        const int quarters = P::aspect == 2 && source.width % 4 == 0 ? 4 : 1;
        Moves moves;
        for (int face = 0; face < P::face_count; ++face) {
            const std::optional<Move> move = find_move<P>(face, symmetry, quarters);
            if (!move) return std::nullopt;
            moves[face] = *move;
        }
        return moves;
    });
}

// A symmetry of the target's frame in the source's.
Axes seen_from_source(const Axes& symmetry, const Axes& to_source) {
    const auto image = [&](const Vec3d& axis) {
        return to_source.to_world(symmetry.to_world(to_source.to_map(axis)));
    };
    return {image({1, 0, 0}), image({0, 1, 0}), image({0, 0, 1})};
}

struct Symmetry {
    std::array<std::optional<Move>, kMostFaces> target;  // of each face, where it has one
    Moves source;
};

std::vector<Symmetry> find_symmetries(const Grid& target, const Grid& source,
                                      const Axes& to_source) {
    std::vector<Symmetry> found;
    for (const Axes& axes : cube_symmetries()) {
        const auto moves = find_source_moves(source, seen_from_source(axes, to_source));
        if (!moves) continue;
        Symmetry symmetry{{}, *moves};
        visit(target.projection, [&](auto p) {
            using P = decltype(p);
            for (int face = 0; face < P::face_count; ++face)
                symmetry.target[face] = find_move<P>(face, axes, 1);
        });
        found.push_back(symmetry);
    }
    return found;
}

// A face in halves along either axis, where its size is even.
struct Part {
    int face, half_x, half_y;
};

}  // namespace

std::vector<Patch> find_patches(const Grid& target, const Grid& source, const Axes& to_source) {
    const std::vector<Symmetry> symmetries = find_symmetries(target, source, to_source);
    const int halves_x = target.width % 2 == 0 ? 2 : 1, halves_y = target.height % 2 == 0 ? 2 : 1;
    const int part_width = target.width / halves_x, part_height = target.height / halves_y;
    bool taken[kMostFaces][2][2] = {};
    const auto patch_of = [&](const Part& part) {
        Patch patch{
            part.face, part.half_x * part_width, part.half_y * part_height, part_width, part_height,
            {}};
        for (const Symmetry& symmetry : symmetries) {
            const std::optional<Move>& move = symmetry.target[part.face];
            if (!move) continue;
            bool& is_taken = taken[move->face][mirrored(move->flip_s, part.half_x, 1, halves_x)]
                                  [mirrored(move->flip_t, part.half_y, 1, halves_y)];
            if (is_taken) continue;
            is_taken = true;
            patch.repeats.push_back({move->face, move->flip_s, move->flip_t, symmetry.source});
        }
        return patch;
    };
    std::vector<Patch> patches;
    for (int face = 0; face < face_count(target.projection); ++face)
        for (int half_y = 0; half_y < halves_y; ++half_y)
            for (int half_x = 0; half_x < halves_x; ++half_x)
                if (!taken[face][half_x][half_y])
                    patches.push_back(patch_of({face, half_x, half_y}));
    return patches;
}

}  // namespace mirrorball::detail
