// Coefficients without maps: values, arithmetic, rotation.
#include <gtest/gtest.h>

#include <mirrorball/zonal.h>

#include "brute_force.h"
#include "harmonics/legendre_column.h"

namespace mirrorball {
namespace {

const Axes kTilted = rotated(Axes{}, 0.7, 0.4, -0.2);

TEST(Harmonics, AreEvaluatedAsDefined) {
    for (const int band_count : {0, 1, 2, 3, 18}) {
        const Harmonics light = noise_harmonics(band_count);
        std::vector<Vec3d> directions = random_directions(20);
        directions.insert(directions.end(),
                          {{0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, -1}});
        for (const Vec3d& d : directions) {
            EXPECT_LT((evaluate(light, d) - evaluated_by_sums(light, d)).length(),
                      1e-11 * (1 + light_rms(light)))
                << band_count << " " << d;
        }
    }
}

// Legendre's polynomial, by its own recurrence.
double legendre(int degree, double x) {
    double before = 0, now = 1;
    for (int l = 0; l < degree; ++l) {
        const double next = ((2 * l + 1) * x * now - l * before) / (l + 1);
        before = now, now = next;
    }
    return now;
}

// The addition theorem: sum over m of Y_lm(a) Y_lm(b) = (2l+1)/(4 pi) P_l(a.b). Next to a pole
// functions of high orders are far below the least double.
TEST(Harmonics, OfThousandsOfBandsObeyTheAdditionTheorem) {
    const double gap = 0.001;  // of longitude
    for (const int degree : {3, 1023, 3000}) {
        for (const double theta : {1e-9, 0.003, 0.2, 1.5, 3.1}) {
            const double cosine = std::cos(theta), sine = std::sin(theta);
            detail::FirstLegendre first;
            double sum = 0;
            for (int m = 0; m <= degree; ++m, first.advance()) {
                detail::LegendreColumn p(m, first.log(), cosine, sine);
                for (int l = m; l < degree; ++l) p.advance();
                sum += p.value() * p.value() * std::cos(m * gap);
            }
            const double between = 1 - sine * sine * (1 - std::cos(gap));
            const double expected = (2 * degree + 1) / (4 * kPi) * legendre(degree, between);
            EXPECT_NEAR(sum, expected, 1e-9 * degree) << degree << " " << theta;
        }
    }
}

TEST(Harmonics, AddScaleAndChangeBands) {
    const Harmonics a = noise_harmonics(7, 1), b = noise_harmonics(7, 2);
    const Vec3f sum = (a + b * 2).coefficient(5, -3);
    const Vec3f expected = a.coefficient(5, -3) + b.coefficient(5, -3) * 2.0f;
    for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(sum[c], expected[c]);
    const Harmonics cut = with_bands(a, 4), back = with_bands(cut, 7);
    for (int l = 0; l < 7; ++l) {
        for (int m = -l; m <= l; ++m) {
            EXPECT_EQ(back.coefficient(l, m), l < 4 ? a.coefficient(l, m) : Vec3f(0, 0, 0));
            if (l < 4) {
                EXPECT_EQ(cut.coefficient(l, m), a.coefficient(l, m));
            }
        }
    }
}

TEST(Harmonics, AreFilteredDegreeByDegree) {
    const Harmonics light = noise_harmonics(6);
    const Harmonics found = convolved(light, parse_lobe("diffuse"));
    const std::vector<double> lambda = zonal_coefficients(parse_lobe("diffuse"), 6);
    for (int l = 0; l < 6; ++l) {
        for (int m = -l; m <= l; ++m) {
            EXPECT_FLOAT_EQ(found.coefficient(l, m).y,
                            light.coefficient(l, m).y * static_cast<float>(lambda[l]));
        }
    }
    EXPECT_EQ(convolved(light, parse_lobe("mirror")).coefficient(5, 2), light.coefficient(5, 2));
    EXPECT_EQ(convolved(light, std::vector<double>{1, 1}).coefficient(2, 1), Vec3f(0, 0, 0));
}

TEST(Harmonics, PowerIsPerDegree) {
    Harmonics light(4);
    light.set_coefficient(2, -1, {1, 2, 0});
    light.set_coefficient(2, 2, {0, 0, 3});
    light.set_coefficient(3, 0, {0.5, 0, 0});
    EXPECT_EQ(power_spectrum(light), (std::vector<double>{0, 0, 14, 0.25}));
}

// Rotation ---------------------------------------------------------------------------------------

std::vector<Axes> frames() {
    return {Axes{},
            kTilted,
            rotated(Axes{}, 2.9, -1.2, 0.8),
            mirrored(kTilted),
            mirrored(Axes{}),
            rotated(Axes{}, 0.3, 0, 0),
            rotated(Axes{}, 0, kPi, 0),
            rotated(Axes{}, 0.4, kPi, 0),
            rotated(Axes{}, 0.4, 1e-9, 0.2),
            rotated(Axes{}, 0.4, kPi - 1e-9, 0.2),
            rotated(Axes{}, 0, kPi / 2, 0),
            Axes{{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
            Axes{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}};
}

TEST(Rotation, CommutesWithEvaluation) {
    for (const int band_count : {1, 2, 3, 40}) {
        const Harmonics light = noise_harmonics(band_count);
        for (const Axes& axes : frames()) {
            const Harmonics turned = rotated(light, axes);
            for (const Vec3d& d : random_directions(6)) {
                const Vec3d difference = evaluate(turned, axes.to_world(d)) - evaluate(light, d);
                EXPECT_LT(difference.length(), 1e-6 * light_rms(light))
                    << band_count << " bands, " << to_string(axes);
            }
        }
    }
}

TEST(Rotation, KeepsEachDegreesPower) {
    const Harmonics light = noise_harmonics(200);
    const std::vector<double> before = power_spectrum(light);
    const std::vector<double> after = power_spectrum(rotated(light, kTilted));
    for (std::size_t l = 0; l < before.size(); ++l) EXPECT_NEAR(after[l] / before[l], 1, 1e-6) << l;
}

TEST(Rotation, ByNothingIsNothingAndComposes) {
    const Harmonics light = noise_harmonics(30);
    EXPECT_LT(relative_difference(rotated(light, Axes{}), light), 1e-7);
    for (const Axes& a : frames()) {
        const Axes b = mirrored(rotated(Axes{}, -0.5, 1.0, 0.1));
        const Axes both{b.to_world(a.x), b.to_world(a.y), b.to_world(a.z)};
        EXPECT_LT(relative_difference(rotated(rotated(light, a), b), rotated(light, both)), 1e-6)
            << to_string(a);
        const Axes back{a.to_map({1, 0, 0}), a.to_map({0, 1, 0}), a.to_map({0, 0, 1})};
        EXPECT_LT(relative_difference(rotated(rotated(light, a), back), light), 1e-6);
    }
}

TEST(Rotation, OfAMapsAxesIsThatOfItsCoefficients) {
    for (const auto projection : {Projection::equirect, Projection::cube, Projection::octahedral}) {
        const EnvironmentMap map = noise_map({projection, 48, Axes{}});
        const Harmonics light = analyse(map, 24);
        for (const Axes& axes : frames()) {
            EnvironmentMap turned = map;
            turned.axes = axes;
            EXPECT_LT(relative_difference(analyse(turned, 24), rotated(light, axes)), 2e-5)
                << name(projection) << " " << to_string(axes);
        }
    }
}

TEST(Rotation, OfManyBandsIsExact) {
    for (const int band_count : {1100}) {  // from 1022 on some begin below the least double
        // only some degrees and a few orders, so that evaluation tells them apart
        Harmonics light(band_count);
        for (const int l : {3, 600, band_count - 2, band_count - 1}) {
            for (const int m : {0, 1, -2, l / 2, -l / 2, l, -l}) {
                if (std::abs(m) <= l) light.set_coefficient(l, m, Vec3f(1, 2, 3));
            }
        }
        const Harmonics turned = rotated(light, kTilted);
        for (const Vec3d& d : random_directions(5)) {
            const Vec3d difference = evaluate(turned, kTilted.to_world(d)) - evaluate(light, d);
            EXPECT_LT(difference.length(), 1e-6 * light_rms(light)) << band_count;
        }
        EXPECT_NEAR(magnitude(turned) / magnitude(light), 1, 1e-6);
    }
}

}  // namespace
}  // namespace mirrorball
