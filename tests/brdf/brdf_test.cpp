// Models against closed forms, published values and their laws.
#include <mirrorball/brdf.h>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <mirrorball/brdf_properties.h>
#include <mirrorball/error.h>
#include <mirrorball/light.h>

#include "brdf/brdf_support.h"
#include "brdf/microfacets.h"

namespace mirrorball {
namespace {

const Vec3d kNormal(0, 0, 1);

double albedo(const char* text, const Vec3d& wi, int point_count = 1 << 14) {
    return directional_albedo(parse_brdf(text), wi, point_count).value.x;
}

// Closed forms; the tolerance is the quadrature's, whose own estimate is a few 1e-6 here.
TEST(Brdf, AlbedosInClosedForm) {
    for (const double angle : {0.0, 40.0, 89.0})
        EXPECT_NEAR(albedo("lambert:0.7", direction(angle, 1)), 0.7, 1e-12);
    EXPECT_NEAR(albedo("phong:50,reflectance=0.9", kNormal), 0.9, 1e-5);
    EXPECT_NEAR(albedo("phong-plain:50", kNormal), 2 * kPi / 52, 1e-5);
    EXPECT_NEAR(albedo("phong-plain:2", kNormal), kPi / 2, 1e-5);  // more than arrives
    EXPECT_NEAR(albedo("blinn-phong:50", kNormal), 1, 2e-5);
    EXPECT_NEAR(albedo("blinn-phong:0", direction(50, 2)), 1, 2e-4);  // Lambert's
    EXPECT_NEAR(albedo("lafortune:7", kNormal), 1, 1e-5);
    // light from (sin 60, 0, cos 60) is the same to fibres along x as from the normal, if turned
    // about them
    for (const double angle : {0.0, 30.0, 60.0, 85.0})
        EXPECT_NEAR(albedo("banks:30", direction(angle, kPi / 2)), 1, 1e-5) << angle;
    // a constant slope distribution: A of the paper's Eq. 30
    const double s2 = std::pow(30 * kPi / 180, 2);
    EXPECT_NEAR(albedo("oren-nayar:30", kNormal), 1 - 0.5 * s2 / (s2 + 0.33), 1e-12);
    EXPECT_NEAR(albedo("oren-nayar:0", direction(70, 0)), 1, 1e-12);
    EXPECT_NEAR(albedo("mirror:index=1.5", kNormal), 0.04, 1e-15);
    EXPECT_NEAR(albedo("ggx:0,index=1.5", kNormal), 0.04, 1e-15);
}

// Lewis's form reflects uniform light whole, but not the light of each direction.
TEST(Brdf, LewisFormInBothDirections) {
    const Brdf lewis = parse_brdf("phong-lewis:50");
    EXPECT_NEAR(furnace_radiance(lewis, kNormal).value.x, 1, 1e-6);
    EXPECT_NEAR(directional_albedo(lewis, kNormal).value.x, 51.0 / 52, 1e-5);
    EXPECT_GT(directional_albedo(lewis, direction(85, 0)).value.x, 1.2);
    // f wi.z is the lobe that prefiltering uses, (N+1)/(2 pi) (r.l)^N
    const Vec3d wo = direction(40, 0), wi = direction(50, 3);
    const double cosine = Vec3d(-wo.x, -wo.y, wo.z).dot(wi);
    EXPECT_NEAR(lewis.evaluate(wi, wo).x * wi.z, 51 / (2 * kPi) * std::pow(cosine, 50), 1e-12);
}

TEST(Brdf, ValuesByHand) {
    const Vec3d wo = direction(30, 0), wi = direction(30, kPi);  // mirror directions
    EXPECT_NEAR(parse_brdf("phong:8").evaluate(wi, wo).x, 10 / (2 * kPi), 1e-12);
    EXPECT_NEAR(parse_brdf("phong-plain:8").evaluate(wi, wo).x, 1, 1e-12);
    // Ward: h is the normal
    const double cosine = std::cos(kPi / 6), alpha = 0.25;
    EXPECT_NEAR(parse_brdf("ward-original:0.5").evaluate(wi, wo).x,
                1 / (4 * kPi * alpha * alpha * cosine), 1e-12);
    EXPECT_NEAR(parse_brdf("ward:0.5").evaluate(wi, wo).x,
                1 / (kPi * alpha * alpha * 4 * cosine * cosine), 1e-12);
    // all at the normal the two agree
    EXPECT_NEAR(parse_brdf("ward:0.5").evaluate(kNormal, kNormal).x,
                parse_brdf("ward-original:0.5").evaluate(kNormal, kNormal).x, 1e-12);
    // and away from there, as printed: e |s|^2 / (pi ax ay s.z^4), e / (4 pi ax ay sqrt(z z'))
    const Vec3d a = direction(20, 1), b = direction(50, 3), s = a + b;
    const double ax = 0.36, ay = 0.49;
    const double e = std::exp(-(std::pow(s.x / s.z / ax, 2) + std::pow(s.y / s.z / ay, 2)));
    EXPECT_NEAR(parse_brdf("ward:roughness-x=0.6,roughness-y=0.7").evaluate(a, b).x,
                e * s.dot(s) / (kPi * ax * ay * std::pow(s.z, 4)), 1e-12);
    EXPECT_NEAR(parse_brdf("ward-original:roughness-x=0.6,roughness-y=0.7").evaluate(a, b).x,
                e / (4 * kPi * ax * ay * std::sqrt(a.z * b.z)), 1e-12);
    // Banks: fibres along x, mirrored across them, and across the cone
    EXPECT_NEAR(parse_brdf("banks:7").evaluate(wi, wo).x,
                parse_brdf("banks:7").evaluate(kNormal, kNormal).x, 1e-12);
    EXPECT_NEAR(parse_brdf("banks:7").evaluate(kNormal, wo).x /
                    parse_brdf("banks:7").evaluate(kNormal, kNormal).x,
                std::pow(cosine, 7), 1e-12);
    // Oren and Nayar, retro-reflection at 60 degrees: A + B sin(60) tan(60)
    const double s2 = std::pow(20 * kPi / 180, 2);
    EXPECT_NEAR(parse_brdf("oren-nayar:20").evaluate(direction(60, 1), direction(60, 1)).x,
                (1 - 0.5 * s2 / (s2 + 0.33) + 0.45 * s2 / (s2 + 0.09) * 1.5) / kPi, 1e-12);
    // Lafortune with Phong's axes is Phong
    EXPECT_NEAR(parse_brdf("lafortune:9,kx=-2,ky=-2,kz=2").evaluate(direction(20, 1), wo).x,
                parse_brdf("phong:9").evaluate(direction(20, 1), wo).x, 1e-12);
}

TEST(Brdf, NothingBelowTheSurface) {
    for (const char* text : kReciprocalModels) {
        const Brdf brdf = parse_brdf(text);
        EXPECT_EQ(brdf.evaluate({0.6, 0, -0.8}, kNormal), Vec3d(0)) << text;
        EXPECT_EQ(brdf.evaluate(kNormal, {0.6, 0, -0.8}), Vec3d(0)) << text;
        EXPECT_EQ(brdf.evaluate(kNormal, {1, 0, 0}), Vec3d(0)) << text;
        EXPECT_EQ(brdf.density(kNormal, {0.6, 0, -0.8}), 0) << text;
        EXPECT_EQ(brdf.sample({0.6, 0, -0.8}, Vec3d(0.5)).weight, Vec3d(0)) << text;
        EXPECT_EQ(brdf.mirror_reflectance({0.6, 0, -0.8}), Vec3d(0)) << text;
    }
}

// Grazing, opposite, equal and normal directions; smooth and rough models; the ends of [0,1).
TEST(Brdf, FiniteEverywhere) {
    std::vector<std::string> models(std::begin(kReciprocalModels), std::end(kReciprocalModels));
    for (const char* text : {kLewis, "phong:1e6", "phong-lewis:1e6", "blinn-phong:1e6", "banks:1e6",
                             "lafortune:1e6", "ward:0.01", "ward-original:0.01", "beckmann:0.01",
                             "ggx:0.01", "ggx:roughness-x=0,roughness-y=1", "charlie:0.01",
                             "plastic:1,roughness=0.01", "ggx:0.5,n=0.1,k=10"})
        models.emplace_back(text);
    std::vector<Vec3d> directions;
    for (const double z : {1e-150, 1e-18, 1e-9, 1e-4, 0.5, 1.0}) {
        for (const double azimuth : {0.0, kPi / 2, kPi, 4.0}) {
            const double s = std::sqrt(1 - z * z);
            directions.emplace_back(s * std::cos(azimuth), s * std::sin(azimuth), z);
        }
    }
    const double ends[] = {0, 0.3, std::nextafter(1.0, 0.0)};
    for (const std::string& text : models) {
        const Brdf brdf = parse_brdf(text);
        for (const Vec3d& wo : directions) {
            for (const Vec3d& wi : directions) {
                const Vec3d f = brdf.evaluate(wi, wo);
                const double density = brdf.density(wi, wo);
                EXPECT_FALSE(std::isnan(f.x) || f.x < 0) << text << wi << wo << f;
                EXPECT_FALSE(std::isnan(density) || density < 0) << text << wi << wo;
            }
            for (const double x : ends) {
                for (const double y : ends) {
                    for (const double z : ends) {
                        const Brdf::Sample sample = brdf.sample(wo, {x, y, z});
                        EXPECT_TRUE(std::isfinite(sample.weight.x) && sample.weight.x >= 0)
                            << text << wo << sample.weight;
                        EXPECT_NEAR(sample.direction.length(), 1, 1e-9) << text << wo;
                    }
                }
            }
        }
    }
}

// D integrates to 1 over projected normals, and shadowing leaves just what is seen: the visible
// normals' projections add up to the surface's, integral of G1 D <v.h> dh = v.z. That fixes Smith's
// Lambda.
template <class Normals>
void expect_smith(const Normals& normals) {
    const double d =
        integrate_hemisphere([&](const Vec3d& h) { return normals.distribution(h) * h.z; }, 1e-6);
    EXPECT_NEAR(d, 1, 1e-4);
    for (const double angle : {0.0, 30.0, 60.0, 85.0}) {
        const Vec3d v = direction(angle, 0.6);
        const double seen = integrate_hemisphere(
            [&](const Vec3d& h) { return normals.distribution(h) * std::max(0.0, v.dot(h)); },
            1e-6);
        EXPECT_NEAR(seen * v.z / (v.z + normals.lambda_z(v)), v.z, 1e-4) << angle;
    }
}

TEST(Brdf, SmithShadowingByIntegration) {
    expect_smith(detail::Ggx{{0.25, 0.25}});
    expect_smith(detail::Ggx{{0.2, 0.7}});
    expect_smith(detail::Ggx{{1, 1}});
    expect_smith(detail::Beckmann{{0.3, 0.3}});
    expect_smith(detail::Beckmann{{0.2, 0.7}});
    expect_smith(detail::Beckmann{{1, 1}});
    // Walter 2007, Eq. 34: G1 = 2 / (1 + sqrt(1 + alpha^2 tan^2)), at 60 degrees
    EXPECT_NEAR(0.5 / (0.5 + detail::Ggx{{0.5, 0.5}}.lambda_z(direction(60, 0))),
                2 / (1 + std::sqrt(1 + 0.25 * 3)), 1e-12);
}

// Scale and bias of the split sum, with which the albedo under Schlick's term is F0 A + B: the
// midpoint rule over the hemisphere of wi, its points closer together towards the horizon, the
// normal and the mirror's azimuth. From formulas as printed, not from our code.
struct SplitSum {
    double a, b;
};

SplitSum ggx_split_sum(double roughness, double cosine) {
    constexpr int kCount = 600;
    const double alpha2 = std::pow(roughness, 4), sine = std::sqrt(1 - cosine * cosine);
    const auto lambda = [&](double z) {
        return (std::sqrt(1 + alpha2 * (1 - z * z) / (z * z)) - 1) / 2;
    };
    SplitSum sum{0, 0};
    for (int i = 0; i < kCount; ++i) {
        const double q = (i + 0.5) / kCount, z = q * q * (3 - 2 * q), s = std::sqrt(1 - z * z);
        const double shadowing = 1 / (1 + lambda(cosine) + lambda(z));
        for (int j = 0; j < kCount; ++j) {
            const double p = (j + 0.5) / kCount, azimuth = kPi * p * p * p;
            const Vec3d wi(-s * std::cos(azimuth), s * std::sin(azimuth), z);
            const Vec3d h = (wi + Vec3d(sine, 0, cosine)).normalized();
            const double d = alpha2 / (kPi * std::pow((alpha2 - 1) * h.z * h.z + 1, 2));
            const double weight = 2 * d * shadowing / (4 * cosine) * 6 * q * (1 - q) * 3 * kPi * p *
                                  p / (kCount * kCount);
            const double schlick = std::pow(1 - wi.dot(h), 5);
            sum.a += weight * (1 - schlick);
            sum.b += weight * schlick;
        }
    }
    return sum;
}

TEST(Brdf, GgxAlbedosByQuadrature) {
    for (const double roughness : {0.25, 0.5, 0.75, 1.0}) {
        for (const double cosine : {0.1, 0.5, 1.0}) {
            const auto [a, b] = ggx_split_sum(roughness, cosine);
            // the three channels are three values of F0
            const Brdf brdf(Microfacet{.roughness_x = roughness,
                                       .roughness_y = roughness,
                                       .fresnel = Fresnel::schlick({0, 0.5, 1})});
            const Vec3d wo(std::sqrt(1 - cosine * cosine), 0, cosine);
            const Integral albedo = furnace_radiance(brdf, wo, 1 << 16);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(albedo.value[c], 0.5 * c * a + b, 1e-4 + 4 * albedo.error)
                    << roughness << " " << cosine;
            EXPECT_LT(albedo.error, 2e-4);
        }
    }
    // and as it is quoted elsewhere
    EXPECT_NEAR(ggx_split_sum(0.5, 0.5).a, 0.8349, 1e-4);
    EXPECT_NEAR(ggx_split_sum(0.5, 0.5).b, 0.0224, 1e-4);
    EXPECT_NEAR(ggx_split_sum(1, 1).a, 0.3069, 1e-4);
}

TEST(Brdf, CharlieAlbedosAsPublished) {
    const double cosines[] = {0.25, 0.5, 0.9};
    const double half[] = {0.4314, 0.2296, 0.0575}, one[] = {0.3939, 0.2873, 0.1674};
    for (int i = 0; i < 3; ++i) {
        const Vec3d wo(std::sqrt(1 - cosines[i] * cosines[i]), 0, cosines[i]);
        EXPECT_NEAR(albedo("charlie:0.5", wo), half[i], 1e-4);
        EXPECT_NEAR(albedo("charlie:1", wo), one[i], 1e-4);
    }
}

// Below the least roughness it is a mirror; just above, one to the eye.
TEST(Brdf, SmoothMicrofacetsAreAMirror) {
    const Vec3d wo = direction(60, 1);
    const Brdf mirror = parse_brdf("ggx:0,index=1.5"), nearly = parse_brdf("ggx:0.01,index=1.5");
    const Vec3d f = Fresnel::dielectric(1.5)(wo.z);
    EXPECT_EQ(mirror.mirror_reflectance(wo), f);
    EXPECT_EQ(nearly.mirror_reflectance(wo), Vec3d(0));
    EXPECT_NEAR(furnace_radiance(nearly, wo).value.x, f.x, 1e-6);
    const Brdf::Sample sample = mirror.sample(wo, Vec3d(0.5));
    EXPECT_TRUE(sample.is_delta);
    EXPECT_EQ(sample.weight, f);
    EXPECT_EQ(sample.direction, Vec3d(-wo.x, -wo.y, wo.z));
}

TEST(Brdf, SumsAddUp) {
    const Brdf a(Lambert{{0.5, 0.4, 0.3}}), b(Phong{.exponent = 20}), m(Mirror{});
    const Brdf sum = 0.3 * a + Vec3d(0.2, 0.1, 0) * b + 0.25 * m;
    const Vec3d wo = direction(30, 0), wi = direction(40, 3);
    const Vec3d expected = 0.3 * a.evaluate(wi, wo) + Vec3d(0.2, 0.1, 0) * b.evaluate(wi, wo);
    EXPECT_LT((sum.evaluate(wi, wo) - expected).length(), 1e-15);
    EXPECT_EQ(sum.mirror_reflectance(wo), Vec3d(0.25));
    EXPECT_EQ(0.5 * (a + b), 0.5 * a + 0.5 * b);
    EXPECT_EQ(to_string(1.0 * a), to_string(a));
    EXPECT_EQ(Brdf().evaluate(wi, wo), Vec3d(0));
    EXPECT_THROW(-1.0 * a, Error);
    EXPECT_THROW(std::numeric_limits<double>::quiet_NaN() * a, Error);
}

// White under any layer is white: what the layer lets through comes out again.
TEST(Brdf, PlasticOverWhiteKeepsAllLight) {
    for (const char* text :
         {"plastic:1,roughness=0", "plastic:1,roughness=0.1", "plastic:1,roughness=0.5",
          "plastic:1,roughness=1", "plastic:1,roughness=0.3,f0=0.3/0.6/0.9"}) {
        const Brdf brdf = parse_brdf(text);
        for (const double angle : {0.0, 50.0, 80.0, 88.0}) {
            const Integral albedo = directional_albedo(brdf, direction(angle, 0), 1 << 15);
            // 2e-3: straight lines between 97 albedos, each of 2048 points
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(albedo.value[c], 1, 2e-3 + 4 * albedo.error) << text << " " << angle;
        }
    }
}

TEST(Brdf, LightsOfEquation15) {
    const Brdf white(Lambert{});
    const Vec3d wo = direction(20, 0);
    // 1 W/m^2 on white paper is 1/pi W m^-2 sr^-1
    EXPECT_NEAR(reflected_radiance(white, wo, DirectionalLight{}).x, 1 / kPi, 1e-15);
    // 12 W/sr at 2 m, 60 degrees off the normal: 12 / 4 / 2 W/m^2
    const PointLight lamp{2.0 * direction(60, 1), {12, 6, 3}};
    EXPECT_LT((irradiance(lamp) - Vec3d(1.5, 0.75, 0.375)).length(), 1e-12);
    EXPECT_NEAR(reflected_radiance(white, wo, lamp).y, 0.75 / kPi, 1e-12);
    // far away it is a directional one
    const Brdf gold = parse_brdf("gold");
    const PointLight far{1e6 * direction(40, 3), Vec3d(1e12)};
    const DirectionalLight sun{direction(40, 3), Vec3d(1)};
    EXPECT_NEAR(reflected_radiance(gold, wo, far).x, reflected_radiance(gold, wo, sun).x, 1e-9);
    // below the surface, and on a mirror, there is nothing
    EXPECT_EQ(reflected_radiance(white, wo, PointLight{{1, 0, -1}, Vec3d(1)}), Vec3d(0));
    EXPECT_EQ(reflected_radiance(white, wo, DirectionalLight{{0, 0, -1}, Vec3d(1)}), Vec3d(0));
    EXPECT_EQ(reflected_radiance(Brdf(Mirror{}), kNormal, DirectionalLight{}), Vec3d(0));
}

TEST(Brdf, LawsKeptAndBroken) {
    const BrdfCheckOptions quick{.pair_count = 4096, .point_count = 2048};
    for (const char* text : kReciprocalModels) {
        const BrdfProperties p = measure_brdf(parse_brdf(text), quick);
        EXPECT_TRUE(p.is_reciprocal()) << text << " " << p.reciprocity.largest;
        EXPECT_TRUE(p.is_positive()) << text;
        const std::string name(text);
        EXPECT_EQ(p.conserves_energy(), !name.starts_with("ward-original"))
            << text << " " << p.brightest().albedo.value.x;
        const bool anisotropic = name.find("banks") != std::string::npos ||
                                 name.find("ky=-0.6") != std::string::npos ||
                                 name.find("roughness-x") != std::string::npos;
        EXPECT_EQ(p.is_isotropic(), !anisotropic) << text << " " << p.isotropy.largest;
        for (const AlbedoPoint& point : p.albedo)
            EXPECT_NEAR(point.albedo.value.x, point.furnace.value.x,
                        4 * (point.albedo.error + point.furnace.error) + 1e-6)
                << text;
    }
    const BrdfProperties lewis = measure_brdf(parse_brdf(kLewis), quick);
    EXPECT_GT(lewis.reciprocity.largest, 0.5);
    EXPECT_FALSE(lewis.is_reciprocal());
    EXPECT_FALSE(lewis.conserves_energy());
    EXPECT_NEAR(lewis.brightest().theta, 89.999 * kPi / 180, 1e-12);
    EXPECT_FALSE(measure_brdf(parse_brdf("phong-plain:2"), quick).conserves_energy());
    EXPECT_TRUE(measure_brdf(parse_brdf("phong-plain:5"), quick).conserves_energy());
    EXPECT_FALSE(measure_brdf(parse_brdf("charlie:0.1"), quick).conserves_energy());
    // the error is that of the mean: 2/3 from a lobe that is cut off at the horizon
    const Integral mean = mean_albedo(parse_brdf("phong:1e6"), 1 << 16);
    EXPECT_NEAR(mean.value.x, 2.0 / 3, 4 * mean.error + 1e-5);
    EXPECT_LT(mean.error, 1e-3);
    EXPECT_THROW((void)measure_brdf(Brdf(), {.pair_count = 1, .point_count = 4096}), Error);
    EXPECT_THROW((void)measure_brdf(Brdf(), {.pair_count = 4096, .point_count = 0}), Error);
}

}  // namespace
}  // namespace mirrorball
