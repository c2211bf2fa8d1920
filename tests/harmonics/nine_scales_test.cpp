// Nine coefficients from many, and in the scales of programs, whose formulas are evaluated here as
// they are written there.
#include <gtest/gtest.h>

#include <mirrorball/error.h>
#include <mirrorball/nine_harmonics.h>

#include "brute_force.h"

namespace mirrorball {
namespace {

// Published constants have six digits.
constexpr double kSixDigits = 2e-5;

NineHarmonics light() {
    return nine_harmonics(noise_harmonics(3));
}

TEST(NineScales, ManyBandsBecomeNine) {
    for (const int band_count : {1, 2, 3, 5}) {
        const Harmonics all = noise_harmonics(band_count);
        const Harmonics three = with_bands(all, 3);
        for (const Vec3d& d : random_directions(20)) {
            const Vec3d difference = evaluate(nine_harmonics(all), d) - evaluate(three, d);
            EXPECT_LT(difference.length(), 1e-13) << band_count;
        }
    }
}

TEST(NineScales, AnalysesAgree) {
    const EnvironmentMap map = noise_map({Projection::equirect, 64, rotated(Axes{}, 1, 0, 0)});
    const NineHarmonics exact = analyse_nine(map), found = nine_harmonics(analyse(map, 3));
    double size = 0;
    for (const Vec3d& c : exact.coefficients) size = std::max(size, c.length());
    for (int i = 0; i < kNineHarmonics; ++i)
        EXPECT_LT((exact.coefficients[i] - found.coefficients[i]).length(), 1e-6 * size) << i;
}

TEST(NineScales, IrradianceIsRamamoorthisPolynomial) {
    const NineHarmonics radiance = light();
    const auto& l = radiance.coefficients;
    const double c1 = 0.429043, c2 = 0.511664, c3 = 0.743125, c4 = 0.886227, c5 = 0.247708;
    for (const Vec3d& n : random_directions(20)) {
        const Vec3d e = l[8] * (c1 * (n.x * n.x - n.y * n.y)) + l[6] * (c3 * n.z * n.z) +
                        l[0] * c4 - l[6] * c5 +
                        (l[4] * (n.x * n.y) + l[7] * (n.x * n.z) + l[5] * (n.y * n.z)) * (2 * c1) +
                        (l[3] * n.x + l[1] * n.y + l[2] * n.z) * (2 * c2);
        EXPECT_LT((evaluate(scaled(radiance, HarmonicScale::irradiance), n) - e).length(),
                  kSixDigits);
        EXPECT_LT((evaluate(scaled(radiance, HarmonicScale::outgoing), n) - e / kPi).length(),
                  kSixDigits);
    }
}

TEST(NineScales, FilamentsShaderGivesIrradianceOverPi) {
    const NineHarmonics radiance = light();
    const auto sh = scaled(radiance, HarmonicScale::filament).coefficients;
    for (const Vec3d& n : random_directions(20)) {
        const Vec3d shown = sh[0] + sh[1] * n.y + sh[2] * n.z + sh[3] * n.x + sh[4] * (n.y * n.x) +
                            sh[5] * (n.y * n.z) + sh[6] * (3 * n.z * n.z - 1) +
                            sh[7] * (n.z * n.x) + sh[8] * (n.x * n.x - n.y * n.y);
        const Vec3d expected = evaluate(convolved_with_cosine(radiance), n) / kPi;
        EXPECT_LT((shown - expected).length(), 1e-12);
    }
    // the documented factors of L_lm, of which only the size is left
    const double documented[] = {0.282095, 0.325735, 0.325735, 0.325735, 0.273137,
                                 0.273137, 0.078848, 0.273137, 0.136569};
    for (int i = 0; i < kNineHarmonics; ++i)
        EXPECT_NEAR(sh[i].x / radiance.coefficients[i].x, documented[i], 1e-6);
}

TEST(NineScales, ThreeJsGivesIrradiance) {
    const NineHarmonics radiance = light();
    const auto sh = scaled(radiance, HarmonicScale::three_js).coefficients;
    for (const Vec3d& n : random_directions(20)) {
        const Vec3d shown =
            sh[0] * 0.886227 + sh[1] * (2 * 0.511664 * n.y) + sh[2] * (2 * 0.511664 * n.z) +
            sh[3] * (2 * 0.511664 * n.x) + sh[4] * (2 * 0.429043 * n.x * n.y) +
            sh[5] * (2 * 0.429043 * n.y * n.z) + sh[6] * (0.743125 * n.z * n.z - 0.247708) +
            sh[7] * (2 * 0.429043 * n.x * n.z) + sh[8] * (0.429043 * (n.x * n.x - n.y * n.y));
        const Vec3d expected = evaluate(convolved_with_cosine(radiance), n);
        EXPECT_LT((shown - expected).length(), kSixDigits);
    }
}

// As packed for the shaders: SHA = (3, 1, 2, 0 - 6), SHB = (4, 5, 3 * 6, 7), SHC = 8, with
// dot(SHA, (x, y, z, 1)) + dot(SHB, (xy, yz, zz, zx)) + SHC (xx - yy), z pointing ahead.
TEST(NineScales, UnitysShaderGivesIrradianceOverPi) {
    const NineHarmonics radiance = light();
    const auto sh = scaled(radiance, HarmonicScale::unity).coefficients;
    for (const Vec3d& ours : random_directions(20)) {
        const double x = ours.x, y = ours.y, z = -ours.z;
        const Vec3d shown = sh[3] * x + sh[1] * y + sh[2] * z + (sh[0] - sh[6]) + sh[4] * (x * y) +
                            sh[5] * (y * z) + sh[6] * (3 * z * z) + sh[7] * (z * x) +
                            sh[8] * (x * x - y * y);
        const Vec3d expected = evaluate(convolved_with_cosine(radiance), ours) / kPi;
        EXPECT_LT((shown - expected).length(), 1e-12);
    }
}

TEST(NineScales, HaveNames) {
    for (const HarmonicScale scale : harmonic_scales())
        EXPECT_EQ(parse_harmonic_scale(name(scale)), scale);
    EXPECT_THROW((void)parse_harmonic_scale("blender"), Error);
}

}  // namespace
}  // namespace mirrorball
