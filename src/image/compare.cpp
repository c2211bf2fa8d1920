#include <mirrorball/compare.h>

#include <cmath>

#include <mirrorball/resample.h>

#include "image/for_each_texel.h"

namespace mirrorball {
namespace {

bool same_texels(const EnvironmentMap& a, const EnvironmentMap& b, int level) {
    return a.projection == b.projection && a.axes == b.axes && a.level_count() > level &&
           a.width(level) == b.width(level) && a.height(level) == b.height(level);
}

// \pre both are alike in shape
Difference compare_texels(const EnvironmentMap& a, int level_a, const EnvironmentMap& b,
                          int level_b) {
    const auto for_each = [&](auto&& f) {
        detail::for_each_texel(b, level_b, [&](int face, int x, int y, double solid_angle) {
            f(face, x, y, Vec3d(a.levels[level_a].faces[face].rgb(x, y)),
              Vec3d(b.levels[level_b].faces[face].rgb(x, y)), solid_angle);
        });
    };

    double error = 0, power = 0, total = 0;
    Vec3d flux_a(0.0), flux_b(0.0);
    for_each([&](int, int, int, const Vec3d& va, const Vec3d& vb, double solid_angle) {
        error += (va - vb).dot(va - vb) * solid_angle;
        power += vb.dot(vb) * solid_angle;
        flux_a += va * solid_angle;
        flux_b += vb * solid_angle;
        total += solid_angle;
    });

    Difference d{};
    d.relative_rmse = error > 0 ? std::sqrt(error / power) : 0;
    for (int c = 0; c < 3; ++c)
        d.flux_ratio[c] = flux_a[c] == flux_b[c] ? 1 : flux_a[c] / flux_b[c];
    const double floor = 1e-2 * std::sqrt(power / (3 * total));
    for_each([&](int face, int x, int y, const Vec3d& va, const Vec3d& vb, double) {
        for (int c = 0; c < 3; ++c) {
            const double difference = std::abs(va[c] - vb[c]);
            if (!(difference > 0)) continue;
            d.maximum = std::max(d.maximum, difference);
            const double relative = difference / std::max(vb[c], floor);
            if (relative > d.maximum_relative) {
                d.maximum_relative = relative;
                d.face = face, d.x = x, d.y = y;
            }
        }
    });
    return d;
}

}  // namespace

Difference compare(const EnvironmentMap& a, const EnvironmentMap& b, int level) {
    if (same_texels(a, b, level)) return compare_texels(a, level, b, level);
    const EnvironmentMap source{a.projection, a.axes, {a.levels[level]}};
    const EnvironmentMap resampled = resample(source, b.projection, b.width(level), b.axes);
    return compare_texels(resampled, 0, b, level);
}

}  // namespace mirrorball
