// Reading a level of an environment map between its texels, across face edges and poles.
//
// A face's texels are met in the order in which they lie; a texel asked for beyond an edge is the
// one that the projection's wrap() finds there. Nearly all reads are inside a face and take the
// texels as they are, four floats at a time (Image pads its end for that).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>

#include <mirrorball/environment_map.h>

namespace mirrorball::detail {

/// Red, green, blue and one unused lane, as the processor adds and multiplies them.
using Rgbx = float __attribute__((vector_size(16)));
using Mask = int __attribute__((vector_size(16)));

// One instruction; the choice of a lane by a comparison, which says the same, takes four.
inline Rgbx smaller(Rgbx a, Rgbx b) {
#if defined(__SSE__)
    return __builtin_ia32_minps(a, b);
#else
    return a < b ? a : b;
#endif
}
inline Rgbx larger(Rgbx a, Rgbx b) {
#if defined(__SSE__)
    return __builtin_ia32_maxps(a, b);
#else
    return a > b ? a : b;
#endif
}
inline Rgbx magnitude(Rgbx v) {
    return (Rgbx)((Mask)v & 0x7fffffff);
}

/// std::floor for values that fit an int; a library call where the processor's baseline has no such
/// instruction, and this is the innermost loop.
inline int floor_to_int(double v) {
    const int truncated = static_cast<int>(v);
    return truncated - (v < truncated ? 1 : 0);
}

inline Rgbx load_rgbx(const float* rgb) {
    Rgbx value;
    std::memcpy(&value, rgb, sizeof value);
    return value;
}

/// Cubic Hermite interpolation between b (at x = 0) and c (x = 1), with the slope of the parabola
/// through three neighbours, as far as monotone: never more than three times the smaller of the two
/// differences beside it, and level at a peak (Fritsch and Carlson 1980). So the curve stays
/// between b and c; a plain cubic would swing below zero beside a sun.
inline Rgbx monotone_cubic(Rgbx a, Rgbx b, Rgbx c, Rgbx d, float x) {
    const auto slope = [&](Rgbx left, Rgbx right) {
        const Rgbx central = (left + right) * 0.5f;
        const Rgbx most = smaller(magnitude(left), magnitude(right)) * 3.0f;
        const Rgbx limited = smaller(magnitude(central), most);
        const Mask same_sign = left * right > 0.0f;
        return (Rgbx)(((Mask)limited | ((Mask)central & (int)0x80000000)) & same_sign);
    };
    const Rgbx step = c - b;
    const Rgbx at_b = slope(b - a, step), at_c = slope(step, d - c);
    return b +
           x * (at_b + x * ((3.0f * step - 2.0f * at_b - at_c) + x * (at_b + at_c - 2.0f * step)));
}

template <class P>
class Sampler {
  public:
    /// \pre level outlives this
    explicit Sampler(const Level& level)
        : level_(level),
          width_(level.width()),
          height_(level.height()) {}

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }

    /// Smooth, and nowhere beyond the neighbours' values.
    [[nodiscard]] Rgbx bicubic(const FacePoint<double>& p) const {
        const Position at(p, width_, height_);
        Rgbx rows[4];
        if (inside(p.face, at.x - 1, at.y - 1, at.x + 2, at.y + 2)) {
            const float* texel = level_.faces[p.face].at(at.x - 1, at.y - 1);
            for (int j = 0; j < 4; ++j, texel += 3 * static_cast<std::ptrdiff_t>(width_))
                rows[j] = monotone_cubic(load_rgbx(texel), load_rgbx(texel + 3),
                                         load_rgbx(texel + 6), load_rgbx(texel + 9), at.fx);
        } else {
            for (int j = 0; j < 4; ++j) {
                const int y = at.y - 1 + j;
                rows[j] =
                    monotone_cubic(fetch(p.face, at.x - 1, y), fetch(p.face, at.x, y),
                                   fetch(p.face, at.x + 1, y), fetch(p.face, at.x + 2, y), at.fx);
            }
        }
        return monotone_cubic(rows[0], rows[1], rows[2], rows[3], at.fy);
    }

    /// The mean of the bilinear interpolant over a box of width x height texels about p, exact.
    ///
    /// A texel at distance x along an axis weighs (G(x + h/2) - G(x - h/2)) / h, G the integral of
    /// the interpolant's tent. Boxes that tile the face give each texel's flux away exactly once.
    /// \pre 0 < width, height <= kLargestBox
    [[nodiscard]] Rgbx box_mean(const FacePoint<double>& p, double width, double height) const {
        const Weights columns(p.s * width_ - 0.5, width), rows(p.t * height_ - 0.5, height);
        // a box of up to 1 or 2 texels sees 3 or 4 at most along each axis
        const int most = std::max(width, height) <= 1 ? 3 : std::max(width, height) <= 2 ? 4 : 0;
        const int column_count = most > 0 ? most : columns.count;
        const int row_count = most > 0 ? most : rows.count;
        if (!inside(p.face, columns.first, rows.first, columns.first + column_count - 1,
                    rows.first + row_count - 1))
            return weighed_across_edges(p.face, columns, rows);
        const float* texel = level_.faces[p.face].at(columns.first, rows.first);
        if (most == 3) return weighed(texel, columns, 3, rows, 3);
        if (most == 4) return weighed(texel, columns, 4, rows, 4);
        return weighed(texel, columns, column_count, rows, row_count);
    }

    static constexpr double kLargestBox = 8;

  private:
    // Of the texels along one axis that a box at u (in texels, from the first one's centre) sees.
    struct Weights {
        int first, count;
        float
            weight[(static_cast<int>(kLargestBox) + 3 + 3) / 4 * 4];  // by fours; zero beyond count

        Weights(double u, double h) {
            const double half = h / 2;
            first = floor_to_int(u - half - 1) + 1;
            count = floor_to_int(u + half + 1) + 1 - first;
            if (h > kWide)
                weigh(static_cast<float>(first - u), static_cast<float>(half));
            else
                weigh_narrow(first - u, std::max(half, 1e-6));
        }

      private:
        // A narrow box takes differences of nearly equal integrals, which need doubles; and one of
        // no width would divide by it, where the tent is the limit, to rounding.
        static constexpr double kWide = 0.25;

        void weigh_narrow(double x, double half) {
            for (int i = 0; i < 4; ++i, x += 1)
                weight[i] = static_cast<float>((tent_integral(x + half) - tent_integral(x - half)) *
                                               (0.5 / half));
        }
        static double tent_integral(double x) {
            x = std::min(std::max(x, -1.0), 1.0);
            return x - x * std::abs(x) * 0.5;
        }

        // The same, four texels at a time.
        void weigh(float x, float half) {
            const float scale = 0.5f / half;
            Rgbx at = {x, x + 1, x + 2, x + 3};
            for (int i = 0; i < count; i += 4, at += 4.0f) {
                const Rgbx w = (tent_integral(at + half) - tent_integral(at - half)) * scale;
                std::memcpy(weight + i, &w, sizeof w);
            }
        }
        static Rgbx tent_integral(Rgbx x) {
            constexpr Rgbx one = {1, 1, 1, 1};
            x = smaller(larger(x, -one), one);
            return x - x * magnitude(x) * 0.5f;
        }
    };

    // Inlined for counts known beforehand, too, so that the usual boxes have no loops to guess.
    // Weights beyond a count are zero.
    [[gnu::always_inline]] Rgbx weighed(const float* texel, const Weights& columns,
                                        int column_count, const Weights& rows,
                                        int row_count) const {
        Rgbx sum{};
        for (int j = 0; j < row_count; ++j, texel += 3 * static_cast<std::ptrdiff_t>(width_)) {
            Rgbx row{};
            for (int i = 0; i < column_count; ++i)
                row += load_rgbx(texel + 3 * i) * columns.weight[i];
            sum += row * rows.weight[j];
        }
        return sum;
    }

    [[gnu::noinline]] Rgbx weighed_across_edges(int face, const Weights& columns,
                                                const Weights& rows) const {
        Rgbx sum{};
        for (int j = 0; j < rows.count; ++j) {
            Rgbx row{};
            for (int i = 0; i < columns.count; ++i)
                row += fetch(face, columns.first + i, rows.first + j) * columns.weight[i];
            sum += row * rows.weight[j];
        }
        return sum;
    }

    // Between the centres of texels (x, y) and (x + 1, y + 1).
    struct Position {
        int x, y;
        float fx, fy;

        Position(const FacePoint<double>& p, int width, int height) {
            const double u = p.s * width - 0.5, v = p.t * height - 0.5;
            x = floor_to_int(u), y = floor_to_int(v);
            fx = static_cast<float>(u - x), fy = static_cast<float>(v - y);
        }
    };

    // Whether all texels of a block, the last ones included, are used ones of this face.
    bool inside(int face, int x0, int y0, int x1, int y1) const {
        if (x0 < 0 || y0 < 0 || x1 >= width_ || y1 >= height_) return false;
        if constexpr (!P::fills_square) {
            return P::covers(centre(face, x0, y0)) && P::covers(centre(face, x1, y0)) &&
                   P::covers(centre(face, x0, y1)) && P::covers(centre(face, x1, y1));
        }
        return true;
    }

    FacePoint<double> centre(int face, int x, int y) const {
        return {face, (x + 0.5) / width_, (y + 0.5) / height_};
    }

    // Any texel up to half a face beyond the edges.
    Rgbx fetch(int face, int x, int y) const {
        if constexpr (P::three_at_corners) {
            const bool beside = x < 0 || x >= width_, above = y < 0 || y >= height_;
            if (beside && above) return beyond_corner(face, x, y);
        }
        FacePoint<double> p = centre(face, x, y);
        if (x < 0 || y < 0 || x >= width_ || y >= height_ || !P::covers(p)) p = P::wrap(p);
        return load_rgbx(level_.faces[p.face].at(index(p.s, width_), index(p.t, height_)));
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

    const Level& level_;
    int width_, height_;
};

}  // namespace mirrorball::detail
