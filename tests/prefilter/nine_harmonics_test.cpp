#include <mirrorball/nine_harmonics.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace mirrorball {
namespace {

EnvironmentMap filled(Projection projection, int size,
                      const std::function<Vec3d(const Vec3d&)>& f) {
    EnvironmentMap map = make_environment_map(projection, size);
    visit(projection, [&](auto p) {
        for (int face = 0; face < p.face_count; ++face) {
            Image& image = map.levels[0].faces[face];
            for (int y = 0; y < image.height(); ++y) {
                for (int x = 0; x < image.width(); ++x) {
                    const FacePoint<double> centre{face, (x + 0.5) / image.width(),
                                                   (y + 0.5) / image.height()};
                    image.set_rgb(x, y, Vec3f(f(map.axes.to_world(p.direction(centre)))));
                }
            }
        }
    });
    return map;
}

std::vector<Vec3d> directions(int count) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    std::vector<Vec3d> result;
    for (int i = 0; i < count; ++i) {
        result.push_back(Vec3d(normal(random), normal(random), normal(random)).normalized());
    }
    return result;
}

// Midpoint sums: the error falls with the square of the texel, 90 / 64 degrees here.
TEST(NineHarmonics, BasisIsOrthonormalInEveryProjection) {
    for (std::size_t i = 0; i < kProjectionCount; ++i) {
        const auto projection = static_cast<Projection>(i);
        for (int k = 0; k < kNineHarmonics; ++k) {
            const auto map =
                filled(projection, projection == Projection::cube ? 64 : 256,
                       [k](const Vec3d& d) { return Vec3d(nine_harmonic_basis(d)[k]); });
            const NineHarmonics found = analyse_nine(map);
            for (int j = 0; j < kNineHarmonics; ++j) {
                EXPECT_NEAR(found.coefficients[j].x, j == k ? 1 : 0, 2e-3)
                    << name(projection) << " " << k << " " << j;
            }
        }
    }
}

TEST(NineHarmonics, UniformLightHasOneCoefficient) {
    const NineHarmonics found =
        analyse_nine(filled(Projection::cube, 16, [](const Vec3d&) { return Vec3d(1, 2, 0.5); }));
    EXPECT_NEAR(found.coefficients[0].y, 2 * std::sqrt(4 * kPi), 1e-12);
    for (int i = 1; i < kNineHarmonics; ++i) EXPECT_NEAR(found.coefficients[i].y, 0, 1e-12);
    for (const Vec3d& n : directions(20)) {
        EXPECT_NEAR(evaluate(convolved_with_cosine(found), n).y, 2 * kPi, 1e-11);
    }
}

// Light that falls from above only, L = y: its irradiance is 2 pi / 3 y, by Funk and Hecke.
TEST(NineHarmonics, ConvolvesBandsByTheClampedCosine) {
    const NineHarmonics found =
        analyse_nine(filled(Projection::equirect, 256, [](const Vec3d& d) { return Vec3d(d.y); }));
    for (const Vec3d& n : directions(20)) {
        EXPECT_NEAR(evaluate(convolved_with_cosine(found), n).x, 2 * kPi / 3 * n.y, 1e-3);
    }
}

// Ramamoorthi and Hanrahan 2001, their published coefficients of Grace Cathedral (red) put into
// their Eq. 13: sign, order and scale are theirs. c1 .. c5 are printed with six digits.
TEST(NineHarmonics, IrradianceIsThePublishedPolynomial) {
    const double c1 = 0.429043, c2 = 0.511664, c3 = 0.743125, c4 = 0.886227, c5 = 0.247708;
    const double grace[] = {.79, .39, -.34, -.29, -.11, -.26, -.16, .56, .21};
    NineHarmonics radiance;
    for (int i = 0; i < kNineHarmonics; ++i) radiance.coefficients[i] = Vec3d(grace[i]);
    const auto& [l00, l1_1, l10, l11, l2_2, l2_1, l20, l21, l22] = grace;
    for (const Vec3d& n : directions(50)) {
        const double x = n.x, y = n.y, z = n.z;
        const double published = c1 * l22 * (x * x - y * y) + c3 * l20 * z * z + c4 * l00 -
                                 c5 * l20 + 2 * c1 * (l2_2 * x * y + l21 * x * z + l2_1 * y * z) +
                                 2 * c2 * (l11 * x + l1_1 * y + l10 * z);
        EXPECT_NEAR(evaluate(convolved_with_cosine(radiance), n).x, published, 5e-6);
    }
}

}  // namespace
}  // namespace mirrorball
