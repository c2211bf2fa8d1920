#include <mirrorball/compare.h>

#include <cmath>

#include <mirrorball/resample.h>

namespace mirrorball {
namespace {

bool same_texels(const EnvironmentMap& a, const EnvironmentMap& b, int level) {
    return a.projection == b.projection && a.axes == b.axes && a.level_count() > level &&
           a.width(level) == b.width(level) && a.height(level) == b.height(level);
}

Difference compare_texels(const Level& a, const Level& b, Projection projection) {
    const int width = b.width(), height = b.height();
    const std::vector<double> solid_angles = solid_angle_table(projection, width, height);
    const auto for_each = [&](auto&& f) {
        for (int face = 0; face < static_cast<int>(b.faces.size()); ++face) {
            std::size_t i = 0;
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x, ++i)
                    if (solid_angles[i] > 0)
                        f(face, x, y, Vec3d(a.faces[face].rgb(x, y)),
                          Vec3d(b.faces[face].rgb(x, y)), solid_angles[i]);
        }
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
    for (int c = 0; c < 3; ++c) d.flux_ratio[c] = flux_a[c] == flux_b[c] ? 1 : flux_a[c] / flux_b[c];
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
    if (same_texels(a, b, level)) return compare_texels(a.levels[level], b.levels[level], b.projection);
    const EnvironmentMap source{a.projection, a.axes, {a.levels[level]}};
    const EnvironmentMap resampled = resample(source, b.projection, b.width(level), b.axes);
    return compare_texels(resampled.levels[0], b.levels[level], b.projection);
}

}  // namespace mirrorball
