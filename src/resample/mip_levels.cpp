#include <mirrorball/resample.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace mirrorball {
namespace {

// The texels of the finer level that lie under texel i of the coarser, along one axis: [first, last].
// Where sizes are odd the outer ones lie under it with a part only.
struct Under {
    int first, last;
};

Under texels_under(int i, int coarse, int fine) {
    const std::int64_t from = std::int64_t{i} * fine, to = std::int64_t{i + 1} * fine;
    return {static_cast<int>(from / coarse), static_cast<int>((to - 1) / coarse)};
}

// Mean of the finer level over a rectangle, by the exact solid angle of what each texel has in it.
template <class P>
Vec3f mean_under(const Image& fine, int face, const FaceRect& rect, const Under& columns,
                 const Under& rows) {
    Vec3d sum(0.0);
    double total = 0;
    for (int y = rows.first; y <= rows.last; ++y) {
        for (int x = columns.first; x <= columns.last; ++x) {
            const FaceRect part{std::max(rect.s0, static_cast<double>(x) / fine.width()),
                                std::max(rect.t0, static_cast<double>(y) / fine.height()),
                                std::min(rect.s1, static_cast<double>(x + 1) / fine.width()),
                                std::min(rect.t1, static_cast<double>(y + 1) / fine.height())};
            const double solid_angle = P::solid_angle(face, part);
            sum += Vec3d(fine.rgb(x, y)) * solid_angle;
            total += solid_angle;
        }
    }
    return total > 0 ? Vec3f(sum / total) : Vec3f(0.0f);
}

template <class P>
Level next_level(const Level& fine) {
    const int height = std::max(1, fine.height() / 2), width = P::aspect * height;
    Level coarse;
    for (int face = 0; face < P::face_count; ++face) {
        Image& image = coarse.faces.emplace_back(width, height, 3);
        detail::parallel_for(height, [&](std::int64_t row) {
            const int y = static_cast<int>(row);
            const Under rows = texels_under(y, height, fine.height());
            for (int x = 0; x < width; ++x) {
                const FaceRect rect{static_cast<double>(x) / width, static_cast<double>(y) / height,
                                    static_cast<double>(x + 1) / width,
                                    static_cast<double>(y + 1) / height};
                image.set_rgb(x, y, mean_under<P>(fine.faces[face], face, rect,
                                                  texels_under(x, width, fine.width()), rows));
            }
        });
    }
    return coarse;
}

}  // namespace

void append_mip_levels(EnvironmentMap& map, int level_count) {
    const int most = full_level_count(map.projection, map.width());
    const int count = level_count > 0 ? std::min(level_count, most) : most;
    while (map.level_count() < count) {
        map.levels.push_back(visit(map.projection, [&](auto p) {
            return next_level<decltype(p)>(map.levels.back());
        }));
    }
}

int full_level_count(Projection projection, int size) {
    int count = 1;
    for (int height = size / aspect(projection); height > 1; height /= 2) ++count;
    return count;
}

}  // namespace mirrorball
