#include <mirrorball/nine_harmonics.h>

#include <cmath>
#include <vector>

#include "core/parallel.h"

namespace mirrorball {
namespace {

void add(NineHarmonics& sum, const NineHarmonics& more) {
    for (int i = 0; i < kNineHarmonics; ++i) sum.coefficients[i] += more.coefficients[i];
}

template <class P>
NineHarmonics analyse_row(P, const EnvironmentMap& map, const Image& image, int face, int y,
                          const std::vector<double>& solid_angles) {
    NineHarmonics sum;
    const int width = image.width();
    for (int x = 0; x < width; ++x) {
        const double solid_angle = solid_angles[static_cast<std::size_t>(y) * width + x];
        if (solid_angle == 0) continue;
        const FacePoint<double> centre{face, (x + 0.5) / width, (y + 0.5) / image.height()};
        const auto basis = nine_harmonic_basis(map.axes.to_world(P::direction(centre)));
        const Vec3d power = Vec3d(image.rgb(x, y)) * solid_angle;
        for (int i = 0; i < kNineHarmonics; ++i) sum.coefficients[i] += power * basis[i];
    }
    return sum;
}

}  // namespace

std::array<double, kNineHarmonics> nine_harmonic_basis(const Vec3d& d) {
    static const double k0 = std::sqrt(1 / (4 * kPi)), k1 = std::sqrt(3 / (4 * kPi)),
                        k2 = std::sqrt(15 / (4 * kPi)), k20 = std::sqrt(5 / (16 * kPi)),
                        k22 = std::sqrt(15 / (16 * kPi));
    return {k0,
            k1 * d.y,
            k1 * d.z,
            k1 * d.x,
            k2 * d.x * d.y,
            k2 * d.y * d.z,
            k20 * (3 * d.z * d.z - 1),
            k2 * d.x * d.z,
            k22 * (d.x * d.x - d.y * d.y)};
}

// Each row has its own sum, and the rows are added in order: the same bits for any thread count.
NineHarmonics analyse_nine(const EnvironmentMap& map, int level) {
    const Level& source = map.levels[level];
    const int height = source.height();
    const auto solid_angles = solid_angle_table(map.projection, source.width(), height);
    std::vector<NineHarmonics> rows(source.faces.size() * static_cast<std::size_t>(height));
    visit(map.projection, [&](auto projection) {
        detail::parallel_for(static_cast<std::int64_t>(rows.size()), [&](std::int64_t i) {
            const int face = static_cast<int>(i / height), y = static_cast<int>(i % height);
            rows[i] = analyse_row(projection, map, source.faces[face], face, y, solid_angles);
        });
    });
    NineHarmonics sum;
    for (const NineHarmonics& row : rows) add(sum, row);
    return sum;
}

NineHarmonics convolved_with_cosine(const NineHarmonics& radiance) {
    NineHarmonics irradiance = radiance;
    for (int i = 0; i < kNineHarmonics; ++i) {
        irradiance.coefficients[i] *= i == 0 ? kPi : i < 4 ? 2 * kPi / 3 : kPi / 4;
    }
    return irradiance;
}

Vec3d evaluate(const NineHarmonics& harmonics, const Vec3d& direction) {
    const auto basis = nine_harmonic_basis(direction);
    Vec3d sum(0, 0, 0);
    for (int i = 0; i < kNineHarmonics; ++i) sum += harmonics.coefficients[i] * basis[i];
    return sum;
}

}  // namespace mirrorball
