// Reading a level across face edges and poles: the slow and general way to weigh a stencil.
//
// A face's texels are met in the order in which they lie; a texel asked for beyond an edge is the
// one that the projection's wrap() finds there.
#pragma once

#include <mirrorball/projection.h>

#include "resample/rgbx.h"
#include "resample/weigh.h"

namespace mirrorball::detail {

template <class P>
class AcrossEdges {
  public:
    /// \pre level outlives this
    explicit AcrossEdges(const MovedLevel& level)
        : level_(level),
          width_(level.width),
          height_(level.height) {}

    /// Stencil k.
    [[nodiscard]] Rgbx weigh(const Stencils& stencils, int k) const {
        const Corner corner{stencils.face, stencils.column[k], stencils.row[k]};
        const float *const columns = stencils.columns[k], *const rows = stencils.rows[k];
        if (stencils.kind[k] == BoxKind::smooth) return smooth(corner, columns, rows);
        Rgbx sum{};
        for (int j = 0; j < 4; ++j) {
            if (rows[j] == 0) continue;
            Rgbx row{};
            for (int i = 0; i < 4; ++i)
                if (columns[i] != 0) row += texel(corner, i, j) * columns[i];
            sum += row * rows[j];
        }
        return sum;
    }

  private:
    struct Corner {
        int face, column, row;
    };

    Rgbx smooth(const Corner& corner, const float* columns, const float* rows) const {
        Rgbx sums[4];
        for (int i = 0; i < 4; ++i)
            sums[i] = monotone_cubic(texel(corner, i, 0), texel(corner, i, 1), texel(corner, i, 2),
                                     texel(corner, i, 3), rows);
        return monotone_cubic(sums[0], sums[1], sums[2], sums[3], columns);
    }

    // Column i and row j of a stencil, where the level's move carries them.
    Rgbx texel(const Corner& corner, int i, int j) const {
        const Move& move = level_.moves[corner.face];
        const int x = mirrored(move.flip_s, corner.column + i, 1, width_),
                  y = mirrored(move.flip_t, corner.row + j, 1, height_);
        return fetch(move.face, x + move.quarters * (width_ / 4), y);
    }

    // Any texel up to half a face beyond the edges; along a panorama's rows, any.
    Rgbx fetch(int face, int x, int y) const {
        const bool beside = x < 0 || x >= width_, above = y < 0 || y >= height_;
        if constexpr (P::three_at_corners) {
            if (beside && above) return beyond_corner(face, x, y);
        }
        if (P::fills_square && !beside && !above) return load(face, x, y);
        FacePoint<double> p{face, (x + 0.5) / width_, (y + 0.5) / height_};
        if (beside || above || !P::covers(p)) p = P::wrap(p);
        return load(p.face, index(p.s, width_), index(p.t, height_));
    }

    Rgbx load(int face, int x, int y) const {
        return load_rgbx(level_.faces[face] + 3 * (static_cast<std::ptrdiff_t>(y) * width_ + x));
    }

    // Where three faces meet there is no fourth texel: the mean of the three stands for it, so that
    // all of them agree at the corner.
    Rgbx beyond_corner(int face, int x, int y) const {
        const int near_x = x < 0 ? 0 : width_ - 1, near_y = y < 0 ? 0 : height_ - 1;
        return (fetch(face, near_x, near_y) + fetch(face, x, near_y) + fetch(face, near_x, y)) *
               (1.0f / 3);
    }

    static int index(double s, int size) {
        const int i = static_cast<int>(s * size);
        return i < 0 ? 0 : i >= size ? size - 1 : i;
    }

    const MovedLevel& level_;
    int width_, height_;
};

}  // namespace mirrorball::detail
