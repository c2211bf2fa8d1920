// Fresnel's equations against closed forms, the laws behind them, and sources.
#include <mirrorball/fresnel.h>

#include <cmath>
#include <complex>
#include <functional>
#include <limits>

#include <gtest/gtest.h>
#include <mirrorball/error.h>

namespace mirrorball {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Fresnel, DielectricAtTheAnglesThatAreKnown) {
    EXPECT_NEAR(fresnel_dielectric(1, 1.5), 0.04, 1e-15);
    EXPECT_NEAR(fresnel_dielectric(1, 2.42), std::pow(1.42 / 3.42, 2), 1e-15);
    EXPECT_EQ(fresnel_dielectric(0, 1.5), 1);
    EXPECT_NEAR(fresnel_dielectric(1e-9, 1.5), 1, 1e-8);
    for (const double c : {0.0, 0.3, 1.0})
        EXPECT_NEAR(fresnel_dielectric(c, 1), c > 0 ? 0 : 1, 1e-15);
    // Brewster's angle, tan = n: p is not reflected, s is by (cos^2 - sin^2)^2 of it
    for (const double n : {1.33, 1.5, 2.4, 0.7}) {
        const double c = 1 / std::sqrt(1 + n * n), s = (1 - n * n) / (1 + n * n);
        EXPECT_NEAR(fresnel_dielectric(c, n), s * s / 2, 1e-14) << n;
    }
}

TEST(Fresnel, TotalReflectionBeyondTheCriticalAngle) {
    const double critical = std::sqrt(1 - 1 / (1.5 * 1.5));  // its cosine, from inside
    EXPECT_EQ(fresnel_dielectric(critical - 1e-6, 1 / 1.5), 1);
    EXPECT_EQ(fresnel_dielectric(0.1, 1 / 1.5), 1);
    EXPECT_LT(fresnel_dielectric(critical + 1e-6, 1 / 1.5), 1);
    EXPECT_EQ(fresnel_dielectric(-0.1, 1.5), 1);
    EXPECT_NEAR(fresnel_conductor(0.1, 1 / 1.5, 0), 1, 1e-15);
}

// The same ray, forward and backward, is reflected alike on both sides (Stokes).
TEST(Fresnel, BothSidesAgree) {
    for (const double n : {1.2, 1.5, 3.0}) {
        for (const double c : {0.05, 0.3, 0.7, 1.0}) {
            const double inside = std::sqrt(1 - (1 - c * c) / (n * n));
            EXPECT_NEAR(fresnel_dielectric(c, n), fresnel_dielectric(inside, 1 / n), 1e-13);
            EXPECT_NEAR(fresnel_dielectric(c, n), fresnel_dielectric(-inside, n), 1e-13);
        }
    }
}

TEST(Fresnel, ConductorWithoutExtinctionIsADielectric) {
    for (const double n : {0.5, 1.33, 1.5, 4.0}) {
        for (double c = 0; c <= 1; c += 0.05)
            EXPECT_NEAR(fresnel_conductor(c, n, 0), fresnel_dielectric(c, n), 1e-13)
                << n << " " << c;
    }
}

TEST(Fresnel, ConductorAtNormalAndGrazing) {
    const double n = 0.2, k = 3.4;
    EXPECT_NEAR(fresnel_conductor(1, n, k),
                ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k), 1e-15);
    EXPECT_NEAR(fresnel_conductor(0, n, k), 1, 1e-15);
    // real arithmetic instead of complex: a^2 and b^2 of Born and Wolf, 14.2
    const double c = 0.4, s2 = 1 - c * c, q = n * n - k * k - s2;
    const double both = std::sqrt(q * q + 4 * n * n * k * k), a = std::sqrt((both + q) / 2);
    const double s = (both - 2 * a * c + c * c) / (both + 2 * a * c + c * c);
    const double p =
        s * (c * c * both - 2 * a * c * s2 + s2 * s2) / (c * c * both + 2 * a * c * s2 + s2 * s2);
    EXPECT_NEAR(fresnel_conductor(c, n, k), (s + p) / 2, 1e-14);
}

TEST(Fresnel, Schlick) {
    EXPECT_EQ(fresnel_schlick(1, 0.04), 0.04);
    EXPECT_EQ(fresnel_schlick(0, 0.04), 1);
    EXPECT_NEAR(fresnel_schlick(0.5, 0.04, 0.5), 0.04 + 0.46 / 32, 1e-15);
}

TEST(Fresnel, Coating) {
    for (double c = 0; c <= 1; c += 0.1) {
        // no coating; a coating of the base's own glass; a coating on nothing, which has two faces
        EXPECT_NEAR(fresnel_coated(c, 1, 0.2, 3.4), fresnel_conductor(c, 0.2, 3.4), 1e-13);
        EXPECT_NEAR(fresnel_coated(c, 1.5, 1.5, 0), fresnel_dielectric(c, 1.5), 1e-13);
    }
    const double r = 0.04;
    EXPECT_NEAR(fresnel_coated(1, 1.5, 1, 0), 2 * r / (1 + r), 1e-14);
    // by hand, at the normal: lacquer of 1.5 on n = 0.2, k = 3.4
    const std::complex<double> m(0.2, 3.4);
    const double lower = std::norm((m - 1.5) / (m + 1.5));
    EXPECT_NEAR(fresnel_coated(1, 1.5, 0.2, 3.4), r + 0.96 * 0.96 * lower / (1 - r * lower), 1e-14);
    // lacquer darkens metal a little and never adds light
    for (double c = 0; c <= 1; c += 0.1) {
        const double coated = fresnel_coated(c, 1.5, 0.2, 3.4);
        EXPECT_TRUE(coated > 0 && coated <= 1) << c;
    }
    EXPECT_EQ(fresnel_coated(0, 1.5, 0.2, 3.4), 1);
}

// Read off the sources' tables again: the points on either side of 550 nm.
TEST(Fresnel, MetalsAsPublished) {
    const auto between = [](double a, double b, double share) { return a + (b - a) * share; };
    const double noble = (0.55 - 0.5486) / (0.5821 - 0.5486);
    EXPECT_NEAR(metal("gold").index.y, between(0.43, 0.29, noble), 5e-4);
    EXPECT_NEAR(metal("gold").extinction.y, between(2.455, 2.863, noble), 5e-4);
    EXPECT_NEAR(metal("silver").extinction.y, between(3.586, 3.858, noble), 6e-4);
    EXPECT_NEAR(metal("copper").index.y, between(1.02, 0.70, noble), 5e-4);
    EXPECT_NEAR(metal("aluminium").extinction.y,
                between(6.2418, 6.7839, (0.55 - 0.5166) / (0.56357 - 0.5166)), 6e-4);
    const double transition = (0.55 - 0.549) / (0.582 - 0.549);
    EXPECT_NEAR(metal("iron").index.y, between(2.95, 2.94, transition), 5e-4);
    EXPECT_NEAR(metal("nickel").extinction.y, between(3.61, 3.80, transition), 6e-4);
    for (const Metal& m : metals()) {
        const Fresnel fresnel = Fresnel::conductor(m.name);
        EXPECT_FALSE(m.source.empty());
        for (int c = 0; c < 3; ++c) {
            EXPECT_GT(fresnel(1)[c], 0.4) << m.name;
            EXPECT_LT(fresnel(1)[c], 1) << m.name;
        }
    }
    // gold is yellow, copper red
    EXPECT_GT(Fresnel::conductor("gold")(1).y, 1.8 * Fresnel::conductor("gold")(1).z);
    EXPECT_GT(Fresnel::conductor("copper")(1).x, 1.4 * Fresnel::conductor("copper")(1).y);
}

// 2 * integral F(c) c dc by a fine midpoint rule in c^2.
double average_by_sum(const Fresnel& fresnel, int channel) {
    constexpr int kCount = 200000;
    double sum = 0;
    for (int i = 0; i < kCount; ++i) sum += fresnel(std::sqrt((i + 0.5) / kCount))[channel];
    return sum / kCount;
}

TEST(Fresnel, Average) {
    // closed form for Schlick: f0 + (1 - f0) / 21
    EXPECT_NEAR(Fresnel::schlick(Vec3d(0.04)).average().x, 0.04 + 0.96 / 21, 1e-12);
    EXPECT_EQ(Fresnel().average(), Vec3d(1));
    // n = 1.5 by the closed form (Walsh 1926): 0.0918
    EXPECT_NEAR(Fresnel::dielectric(1.5).average().x, 0.09178, 1e-5);
    for (const Fresnel& f :
         {Fresnel::dielectric(1.01), Fresnel::dielectric(1.5), Fresnel::dielectric(1 / 1.5),
          Fresnel::conductor("gold"), Fresnel::conductor("copper").coated(1.5),
          Fresnel::conductor(Vec3d(0.6), Vec3d(0)), Fresnel::schlick(Vec3d(0.1), Vec3d(0.4))})
        EXPECT_NEAR(f.average().z, average_by_sum(f, 2), 1e-6) << to_string(f);
    // from inside, n^2 times as much of the light is shut in: 1 - F_in = (1 - F_out) / n^2
    EXPECT_NEAR(1 - Fresnel::dielectric(1 / 1.5).average().x,
                (1 - Fresnel::dielectric(1.5).average().x) / 2.25, 1e-9);
}

TEST(Fresnel, MapIsTheCurveAtItsSamples) {
    const Fresnel gold = Fresnel::conductor("gold");
    const FresnelMap map(gold, 33);
    ASSERT_EQ(map.samples().size(), 33u);
    for (int i = 0; i < 33; ++i) {
        const double c = i / 32.0;
        EXPECT_LT((map(c) - gold(c)).length(), 1e-7);
        EXPECT_EQ(map.image().rgb(i, 0), map.samples()[i]);
    }
    EXPECT_LT((map(0.5 / 32) - (gold(0) + gold(1 / 32.0)) * 0.5).length(), 1e-7);
    EXPECT_EQ(map(-1), map(0));
    EXPECT_EQ(map(2), map(1));
    EXPECT_EQ(map.image().height(), 1);
}

// Of Schlick's curve the second derivative is 20 (1-f0) (1-c)^3, largest at grazing, and the error
// of a line over a step h at most h^2/8 of it.
TEST(Fresnel, MapStatesItsError) {
    const Fresnel schlick = Fresnel::schlick(Vec3d(0.04));
    const auto coarse = FresnelMap(schlick, 65).interpolation_error();
    const auto fine = FresnelMap(schlick, 129).interpolation_error();
    const double h = 1.0 / 64, bound = h * h / 8 * 20 * 0.96;
    EXPECT_LE(coarse.largest, bound);
    EXPECT_GT(coarse.largest, 0.9 * bound);
    EXPECT_LT(coarse.at_cosine, h);
    EXPECT_LT(coarse.rms, coarse.largest);
    EXPECT_NEAR(coarse.largest / fine.largest, 4, 0.2);
    EXPECT_NEAR(coarse.rms / fine.rms, 4, 0.1);
    // rms of a parabola's error over a step is f'' h^2 / sqrt(120): integrate its square
    EXPECT_NEAR(coarse.rms, h * h / std::sqrt(120.0) * 20 * 0.96 * std::sqrt(1 / 7.0),
                0.05 * coarse.rms);
    // a straight line is met to rounding
    EXPECT_LT(FresnelMap(Fresnel::schlick(Vec3d(0.5), Vec3d(0.5)), 2).interpolation_error().largest,
              1e-7);
}

TEST(Fresnel, LayersOfEquations20And21) {
    const Fresnel glass = Fresnel::dielectric(1.5);
    const LayerWeights off = layer_weights(Coating::off, glass, 0.5),
                       clear = layer_weights(Coating::transparent, glass, 0.5);
    EXPECT_EQ(off.mirror, glass(0.5));
    EXPECT_EQ(off.diffuse, Vec3d(1));
    EXPECT_EQ(clear.mirror, glass(0.5));
    EXPECT_LT((clear.mirror + clear.diffuse - Vec3d(1)).length(), 1e-15);
}

// The coupling is reciprocal, and over uniform light it is Eq. 21's 1 - F.
TEST(Fresnel, CouplingKeepsWhatTheLayerLetsThrough) {
    const Fresnel glass = Fresnel::dielectric(1.5);
    const Vec3d mean = glass.average();
    EXPECT_EQ(diffuse_coupling(glass(0.3), glass(0.8), mean),
              diffuse_coupling(glass(0.8), glass(0.3), mean));
    constexpr int kCount = 100000;
    double sum = 0;
    for (int i = 0; i < kCount; ++i)
        sum += diffuse_coupling(glass(std::sqrt((i + 0.5) / kCount)), glass(0.3), mean).x / kCount;
    EXPECT_NEAR(sum, 1 - glass(0.3).x, 1e-5);
    EXPECT_EQ(diffuse_coupling(Vec3d(1), Vec3d(1), Vec3d(1)), Vec3d(0));
}

TEST(Fresnel, TextRoundTrip) {
    for (const Fresnel& f :
         {Fresnel(), Fresnel::dielectric(1.5), Fresnel::dielectric(1.0 / 3),
          Fresnel::conductor("silver"), Fresnel::conductor("gold").coated(1.5),
          Fresnel::conductor({1, 2, 3}, Vec3d(4)), Fresnel::dielectric(1.3).coated(1.7),
          Fresnel::schlick(Vec3d(0.04)), Fresnel::schlick({0.1, 0.2, 0.3}, Vec3d(0.5))})
        EXPECT_EQ(parse_fresnel(to_string(f)), f) << to_string(f);
    EXPECT_EQ(to_string(Fresnel::conductor("gold")), "metal=gold");
}

void expect_usage(const std::function<void()>& f, const std::string& message) {
    try {
        f();
        FAIL() << "accepted: " << message;
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::usage);
        EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
}

TEST(Fresnel, BadParametersAreNamed) {
    expect_usage([] { (void)Fresnel::dielectric(0); },
                 "index is 0; expected a number from 0.01 to 100");
    expect_usage([] { (void)Fresnel::dielectric(-1.5); }, "index is -1.5");
    expect_usage([] { (void)Fresnel::dielectric(kNan); }, "index is nan");
    expect_usage([] { (void)Fresnel::conductor({1, 0, 1}, Vec3d(1)); }, "n is 0");
    expect_usage([] { (void)Fresnel::conductor(Vec3d(1), {1, 1, -1}); }, "k is -1");
    expect_usage([] { (void)Fresnel::conductor("unobtainium"); }, "there are gold, silver, copper");
    expect_usage([] { (void)Fresnel::schlick(Vec3d(1.1)); },
                 "f0 is 1.1; expected a number from 0 to 1");
    expect_usage([] { (void)Fresnel::schlick(Vec3d(0.5), Vec3d(kNan)); }, "f90 is nan");
    expect_usage([] { (void)Fresnel::dielectric(1.5).coated(0.9); }, "coat is 0.9");
    expect_usage([] { (void)Fresnel::schlick(Vec3d(0.5)).coated(1.5); }, "coat needs");
    expect_usage([] { (void)FresnelMap(Fresnel(), 1); }, "1 samples; expected 2 to 65536");
    expect_usage([] { (void)FresnelMap(Fresnel(), 65537); }, "65537");
    expect_usage([] { (void)parse_fresnel("index=1.5,metal=gold"); }, "several");
    expect_usage([] { (void)parse_fresnel("n=1.5"); }, "n and k go together");
    expect_usage([] { (void)parse_fresnel("f90=1"); }, "f90 needs f0");
    expect_usage([] { (void)parse_fresnel("index=glass"); },
                 "index is \"glass\"; expected a number");
    expect_usage([] { (void)parse_fresnel("colour=1"); }, "no parameter \"colour\"");
}

}  // namespace
}  // namespace mirrorball
