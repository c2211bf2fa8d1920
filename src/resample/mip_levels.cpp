#include <mirrorball/resample.h>

#include <algorithm>
#include <vector>

#include "core/parallel.h"

namespace mirrorball {
namespace {

// The texels of the finer level that lie under texel i of the coarser, along one axis: [first,
// last]. Where sizes are odd the outer ones lie under it with a part only.
struct Under {
    int first, last;
};

Under texels_under(int i, int coarse, int fine) {
    const std::int64_t from = std::int64_t{i} * fine, to = std::int64_t{i + 1} * fine;
    return {static_cast<int>(from / coarse), static_cast<int>((to - 1) / coarse)};
}

// What of the finer level lies under a texel of the coarser: texels, and the exact solid angle of
// the part of each that does. It is the same for all faces.
struct Part {
    int x, y;
    double solid_angle;
};

template <class P>
void parts_under(int x, int y, int width, int height, int fine_width, int fine_height,
                 std::vector<Part>& parts) {
    parts.clear();
    const Under columns = texels_under(x, width, fine_width);
    const Under rows = texels_under(y, height, fine_height);
    for (int j = rows.first; j <= rows.last; ++j) {
        for (int i = columns.first; i <= columns.last; ++i) {
            const FaceRect part{
                std::max(static_cast<double>(x) / width, static_cast<double>(i) / fine_width),
                std::max(static_cast<double>(y) / height, static_cast<double>(j) / fine_height),
                std::min(static_cast<double>(x + 1) / width,
                         static_cast<double>(i + 1) / fine_width),
                std::min(static_cast<double>(y + 1) / height,
                         static_cast<double>(j + 1) / fine_height)};
            parts.push_back({i, j, P::solid_angle(0, part)});
        }
    }
}

Vec3f mean_of(const std::vector<Part>& parts, const Image& fine) {
    Vec3d sum(0.0);
    double total = 0;
    for (const Part& part : parts) {
        sum += Vec3d(fine.rgb(part.x, part.y)) * part.solid_angle;
        total += part.solid_angle;
    }
    return total > 0 ? Vec3f(sum / total) : Vec3f(0.0f);
}

template <class P>
Level next_level(const Level& fine) {
    const int height = std::max(1, fine.height() / 2), width = P::aspect * height;
    Level coarse;
    for (int face = 0; face < P::face_count; ++face) coarse.faces.emplace_back(width, height, 3);
    detail::parallel_for(height, [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        std::vector<Part> parts;
        for (int x = 0; x < width; ++x) {
            parts_under<P>(x, y, width, height, fine.width(), fine.height(), parts);
            for (int face = 0; face < P::face_count; ++face)
                coarse.faces[face].set_rgb(x, y, mean_of(parts, fine.faces[face]));
        }
    });
    return coarse;
}

}  // namespace

void append_mip_levels(EnvironmentMap& map, int level_count) {
    const int most = full_level_count(map.projection, map.width());
    const int count = level_count > 0 ? std::min(level_count, most) : most;
    while (map.level_count() < count) {
        map.levels.push_back(visit(
            map.projection, [&](auto p) { return next_level<decltype(p)>(map.levels.back()); }));
    }
}

int full_level_count(Projection projection, int size) {
    int count = 1;
    for (int height = size / aspect(projection); height > 1; height /= 2) ++count;
    return count;
}

}  // namespace mirrorball
