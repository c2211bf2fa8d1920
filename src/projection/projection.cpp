#include <mirrorball/projection.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <mirrorball/error.h>

#include "core/parallel.h"

namespace mirrorball {
namespace {

FaceRect texel_rect(int x, int y, int width, int height) {
    return {static_cast<double>(x) / width, static_cast<double>(y) / height,
            static_cast<double>(x + 1) / width, static_cast<double>(y + 1) / height};
}

// Every projection looks the same mirrored left to right and top to bottom, so a quarter will do;
// it also makes the table exactly symmetric.
template <class P>
std::vector<double> make_solid_angle_table(int width, int height) {
    std::vector<double> table(static_cast<std::size_t>(width) * height);
    detail::parallel_for((height + 1) / 2, [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        double* top = table.data() + static_cast<std::size_t>(y) * width;
        double* bottom = table.data() + static_cast<std::size_t>(height - 1 - y) * width;
        for (int x = 0; x < (width + 1) / 2; ++x) {
            const double value = P::solid_angle(0, texel_rect(x, y, width, height));
            top[x] = top[width - 1 - x] = bottom[x] = bottom[width - 1 - x] = value;
        }
    });
    return table;
}

// Longest and shortest half axis of the ellipse that a texel's unit circle becomes on the sphere.
struct Footprint {
    double longest, shortest;
};

Footprint footprint(const Vec3d& ds, const Vec3d& dt) {
    // the singular values of the 3 x 2 matrix [ds dt], from its 2 x 2 Gram matrix
    const double a = ds.dot(ds), b = ds.dot(dt), c = dt.dot(dt);
    const double middle = (a + c) / 2, radius = std::hypot((a - c) / 2, b);
    const double area = ds.cross(dt).length(), longest = std::sqrt(middle + radius);
    return {longest, area / longest};
}

template <class P>
ProjectionFacts measure_projection(int size) {
    const int width = P::aspect * size;
    const std::vector<double> solid_angles = make_solid_angle_table<P>(width, size);
    double smallest = 4 * kPi, largest = 0, worst_stretch = 1, longest_step = 0;
    double used_area = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < width; ++x) {
            const FaceRect r = texel_rect(x, y, width, size);
            const FacePoint<double> centre{0, (r.s0 + r.s1) / 2, (r.t0 + r.t1) / 2};
            if (P::covers(centre)) used_area += 1;
            bool whole = true;
            for (const auto& [s, t] : {std::pair(r.s0, r.t0), std::pair(r.s1, r.t0),
                                       std::pair(r.s0, r.t1), std::pair(r.s1, r.t1)})
                whole = whole && P::covers(FacePoint<double>{0, s, t});
            if (!whole) continue;
            const double solid_angle = solid_angles[static_cast<std::size_t>(y) * width + x];
            smallest = std::min(smallest, solid_angle);
            largest = std::max(largest, solid_angle);
            const Tangents<double> tangents = P::tangents(centre, P::direction(centre));
            const Footprint f = footprint(tangents.ds / width, tangents.dt / size);
            worst_stretch = std::max(worst_stretch, f.longest / f.shortest);
            longest_step = std::max(longest_step, f.longest);
        }
    }
    const double pixel_count = static_cast<double>(P::face_count) * width * size;
    const double steps_per_degree = longest_step / (kPi / 180);
    return {used_area / (static_cast<double>(width) * size),   largest / smallest, worst_stretch,
            pixel_count * steps_per_degree * steps_per_degree, P::seam_count,      P::pole_count};
}

}  // namespace

std::string_view name(Projection projection) {
    return visit(projection, [](auto p) -> std::string_view { return decltype(p)::name; });
}

Projection parse_projection(std::string_view text) {
    std::string known;
    for (std::size_t i = 0; i < kProjectionCount; ++i) {
        const Projection projection = static_cast<Projection>(i);
        if (name(projection) == text) return projection;
        known += fmt::format("{}{}", known.empty() ? "" : ", ", name(projection));
    }
    throw Error(Errc::usage, fmt::format("no projection \"{}\"; there are {}", text, known));
}

int face_count(Projection projection) {
    return visit(projection, [](auto p) { return decltype(p)::face_count; });
}

int aspect(Projection projection) {
    return visit(projection, [](auto p) { return decltype(p)::aspect; });
}

std::vector<double> solid_angle_table(Projection projection, int width, int height) {
    return visit(projection,
                 [&](auto p) { return make_solid_angle_table<decltype(p)>(width, height); });
}

ProjectionFacts measure(Projection projection, int size) {
    return visit(projection, [&](auto p) { return measure_projection<decltype(p)>(size); });
}

}  // namespace mirrorball
