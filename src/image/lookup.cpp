// Lookups in a map, one direction at a time. Most find all four texels on one face; the rest walk
// across its edges texel by texel, as resampling does (resample/across_edges.h), by wrap().
#include <mirrorball/lookup.h>

#include <algorithm>
#include <cmath>

namespace mirrorball {
namespace {

// The four texels around a point of a face, and how far it is from the first towards the others.
struct Cell {
    int x, y;
    float fx, fy;
};

Cell cell_at(double s, double t, int width, int height) {
    const double x = s * width - 0.5, y = t * height - 0.5;
    const double x0 = std::floor(x), y0 = std::floor(y);
    return {static_cast<int>(x0), static_cast<int>(y0), static_cast<float>(x - x0),
            static_cast<float>(y - y0)};
}

// Exact where a == b.
Vec3f between(const Vec3f& a, const Vec3f& b, float share) {
    return a + (b - a) * share;
}

int index_of(double s, int size) {
    return std::clamp(static_cast<int>(s * size), 0, size - 1);
}

template <class P>
class FilteredLevel {
  public:
    explicit FilteredLevel(const Level& level)
        : level_(level),
          width_(level.width()),
          height_(level.height()) {}

    [[nodiscard]] Vec3f operator()(const FacePoint<double>& p) const {
        const Cell c = cell_at(p.s, p.t, width_, height_);
        if (all_on_face(p.face, c)) {
            const Image& face = level_.faces[p.face];
            return mixed(c, [&](int x, int y) { return face.rgb(x, y); });
        }
        return mixed(c, [&](int x, int y) { return beyond(p.face, x, y); });
    }

  private:
    template <class Texel>
    static Vec3f mixed(const Cell& c, Texel&& texel) {
        return between(between(texel(c.x, c.y), texel(c.x + 1, c.y), c.fx),
                       between(texel(c.x, c.y + 1), texel(c.x + 1, c.y + 1), c.fx), c.fy);
    }

    [[nodiscard]] bool all_on_face(int face, const Cell& c) const {
        if (c.x < 0 || c.y < 0 || c.x + 1 >= width_ || c.y + 1 >= height_) return false;
        if constexpr (P::fills_square) return true;
        for (const int y : {c.y, c.y + 1}) {
            for (const int x : {c.x, c.x + 1}) {
                if (!P::covers(centre(face, x, y))) return false;
            }
        }
        return true;
    }

    [[nodiscard]] FacePoint<double> centre(int face, int x, int y) const {
        return {face, (x + 0.5) / width_, (y + 0.5) / height_};
    }

    [[nodiscard]] bool outside(int face, int x, int y) const {
        return x < 0 || x >= width_ || y < 0 || y >= height_ ||
               (!P::fills_square && !P::covers(centre(face, x, y)));
    }

    // A texel up to half a face outside. Grids of squares go on where they are wrapped. Discs do
    // not: there the place is looked up between the texels around it, of which some may be beyond
    // a rim in turn; these count less and less, so after a few the nearest will do.
    template <int kDepth = 3>
    [[nodiscard]] Vec3f beyond(int face, int x, int y) const {
        if constexpr (P::fills_square || kDepth == 0) {
            return nearest(face, x, y);
        } else {
            if (!outside(face, x, y)) return level_.faces[face].rgb(x, y);
            const FacePoint<double> p = P::wrap(centre(face, x, y));
            const Cell c = cell_at(p.s, p.t, width_, height_);
            return mixed(c, [&](int i, int j) { return beyond<kDepth - 1>(p.face, i, j); });
        }
    }

    [[nodiscard]] Vec3f nearest(int face, int x, int y) const {
        const bool beside = x < 0 || x >= width_, above = y < 0 || y >= height_;
        if constexpr (P::three_at_corners) {
            if (beside && above) return beyond_corner(face, x, y);
        }
        if (!outside(face, x, y)) return level_.faces[face].rgb(x, y);
        const FacePoint<double> p = P::wrap(centre(face, x, y));
        return level_.faces[p.face].rgb(index_of(p.s, width_), index_of(p.t, height_));
    }

    [[nodiscard]] Vec3f beyond_corner(int face, int x, int y) const {
        const int near_x = std::clamp(x, 0, width_ - 1), near_y = std::clamp(y, 0, height_ - 1);
        const Vec3f here = nearest(face, near_x, near_y);
        return here + ((nearest(face, x, near_y) - here) + (nearest(face, near_x, y) - here)) / 3;
    }

    const Level& level_;
    int width_, height_;
};

}  // namespace

Vec3f look_up(const EnvironmentMap& map, const Vec3d& direction, int level) {
    return visit(map.projection, [&](auto projection) {
        using P = decltype(projection);
        return FilteredLevel<P>(map.levels[level])(P::project(map.axes.to_map(direction)));
    });
}

Vec3f look_up_at_lod(const EnvironmentMap& map, const Vec3d& direction, double lod) {
    const double position = std::clamp(lod, 0.0, static_cast<double>(map.level_count() - 1));
    const int level = static_cast<int>(position);
    const float share = static_cast<float>(position - level);
    return visit(map.projection, [&](auto projection) {
        using P = decltype(projection);
        const FacePoint<double> p = P::project(map.axes.to_map(direction));
        const Vec3f fine = FilteredLevel<P>(map.levels[level])(p);
        if (share == 0) return fine;
        return between(fine, FilteredLevel<P>(map.levels[level + 1])(p), share);
    });
}

}  // namespace mirrorball
