// The sun 2.4 degrees above a calm sea, with ice clouds high up and a broken sheet lower down.
//
// The sea is a rough mirror: waves that samples can resolve turn its normal, the others widen its
// lobe. Their slopes follow Cox and Munk 1954, "Measurement of the Roughness of the
// Sea Surface"; the sun's glitter is a microfacet reflection with Smith's masking (Walter et al.
// 2007, "Microfacet Models for Refraction through Rough Surfaces"), and the sky's reflection a
// table of means over the waves' slopes.
#include <array>
#include <cmath>
#include <vector>

#include "atmosphere.h"
#include "clouds.h"
#include "core/parallel.h"
#include "environment.h"
#include "noise.h"
#include "shading.h"

namespace mirrorball::detail {
namespace {

constexpr double kDetail = 0.25 * kPi / 180;

const AtmosphereSettings kAir{.sun_elevation = 2.4 * kPi / 180,
                              .sun_azimuth = 24 * kPi / 180,
                              .haze = 4.5,
                              .ground_albedo = Vec3d(0.06),
                              .exposure = 5};

// Clouds
// -------------------------------------------------------------------------------------------

const std::array kSheets{
    CloudSheet{.height = 4200,
               .scale = {3400, 1900},
               .wind = heading(radians(-38)),
               .warp = 0.18,
               .low = 0.12,
               .high = 1.0,
               .patches = 0.55,
               .depth = 1.5,
               .relief = 0.7,
               .darkest = 0.35,
               .pattern = {7, 0.6, 11}},
    CloudSheet{.height = 9500,
               .scale = {30000, 4200},
               .wind = heading(radians(-62)),
               .warp = 0.35,
               .low = -0.2,
               .high = 1.25,
               .patches = 0.55,
               .depth = 0.5,
               .relief = 0.2,
               .darkest = 0.35,
               .pattern = {7, 0.58, 71}},
};

// The sea
// ------------------------------------------------------------------------------------------

constexpr double kEyeHeight = 7;           // metres
constexpr double kSlopeVariance = 0.0135;  // Cox and Munk's, both directions, a wind of 2 m/s
constexpr double kWaveLength = 9;          // the longest, metres
constexpr int kWaveOctaves = 6;
// Crests lie across the wind, which blows from the sun's left; each octave veers a little.
const std::array<Vec2, kWaveOctaves> kWaveHeadings{heading(0.9),   heading(1.05), heading(1.2),
                                                   heading(-0.15), heading(0.0),  heading(0.15)};
const Vec3d kUpwelling{0.008, 0.034, 0.046};  // share of the irradiance that comes back out, per sr

// Schlick's approximation for water, n = 1.333.
double fresnel(double cosine) {
    return 0.0204 + 0.9796 * std::pow(1 - cosine, 5);
}

Vec3d reflect(const Vec3d& view, const Vec3d& normal) {
    return normal * (2 * normal.dot(view)) - view;
}

class Sunset final : public Environment {
  public:
    Sunset() : air_(kAir), clouds_(air_, kSheets, kDetail) { fill_reflection(); }

    [[nodiscard]] Vec3d radiance(const Vec3d& direction) const override {
        return direction.y >= 0 ? sky(direction) : sea(direction);
    }
    [[nodiscard]] double detail() const override { return kDetail; }
    [[nodiscard]] std::optional<Disc> disc() const override { return air_.sun(); }
    [[nodiscard]] Vec3d disc_radiance(const Vec3d& direction) const override {
        return air_.sun_radiance(direction) * clouds_.transmittance(direction);
    }

  private:
    [[nodiscard]] Vec3d sky(const Vec3d& direction) const {
        return clouds_.over(air_.sky(direction), direction);
    }

    // Normal of the waves that are wider than samples, and the slope variance of all others.
    struct WaveSample {
        Vec3d normal;
        double variance;
    };
    [[nodiscard]] WaveSample waves(const Vec3d& direction, double distance) const {
        const double x = direction.x * distance, z = direction.z * distance;
        double slope_x = 0, slope_z = 0, resolved = 0;
        double length = kWaveLength;
        for (std::uint32_t i = 0; i < kWaveOctaves; ++i, length *= 0.5) {
            // Along the ray a sample's footprint is stretched by the grazing angle.
            const double footprint = kDetail * distance / -direction.y;
            const double fade = std::clamp(1.5 - 3 * footprint / length, 0.0, 1.0);
            if (fade == 0) break;
            const auto [c, s] = kWaveHeadings[i];
            const NoiseSample n =
                noise({(c * x + s * z) / length, 0.45 * (c * z - s * x) / length}, 200 + i);
            // Each octave has its share of the variance; a unit of noise has a mean square
            // slope of about 1.
            const double strength = fade * std::sqrt(kSlopeVariance / kWaveOctaves);
            slope_x += strength * (c * n.dx - 0.45 * s * n.dy);
            slope_z += strength * (s * n.dx + 0.45 * c * n.dy);
            resolved += fade * fade / kWaveOctaves;
        }
        return {Vec3d(-slope_x, 1, -slope_z).normalized(),
                kSlopeVariance * std::max(1 - resolved, 0.12)};
    }

    [[nodiscard]] Vec3d sea(const Vec3d& direction) const {
        const double steepness = -direction.y;
        const double distance = std::min(kEyeHeight / std::max(steepness, 1e-9), 9000.0);
        const WaveSample wave = waves(direction, distance);
        const Vec3d view = -direction;
        const double cosine = std::max(view.dot(wave.normal), 1e-4);

        // Fresnel over a rough sea (Bruneton, Neyret and Holzschuch 2010, "Real-time Realistic
        // Ocean Lighting Using Seamless Transitions from Geometry to BRDF"): waves lower the mirror
        // at grazing angles, since those that are seen there face the eye.
        const double sigma = std::sqrt(wave.variance);
        const double mirror = 0.0204 + 0.9796 * std::pow(1 - cosine, 5 * std::exp(-2.69 * sigma)) /
                                           (1 + 22.7 * std::pow(sigma, 1.5));
        const Vec3d water =
            (air_.sky_irradiance() + air_.sun_irradiance() * air_.sun().direction.y) * kUpwelling;
        const Vec3d light = reflected_sky(reflect(view, wave.normal)) * mirror +
                            water * (1 - mirror) + glitter(view, wave);
        return air_.through_air(light, direction, distance, 0);
    }

    // F D G2 / (4 n.v) times the sun's irradiance, with Beckmann's distribution of slopes.
    [[nodiscard]] Vec3d glitter(const Vec3d& view, const WaveSample& wave) const {
        const Vec3d& sun = air_.sun().direction;
        const Vec3d half = (view + sun).normalized();
        const double cos_half = half.dot(wave.normal);
        const double cos_view = std::max(view.dot(wave.normal), 1e-4);
        const double cos_sun = std::max(sun.dot(wave.normal), 1e-4);
        if (cos_half <= 0) return {0, 0, 0};
        const double tan2 = (1 - cos_half * cos_half) / (cos_half * cos_half);
        const double density =
            std::exp(-tan2 / wave.variance) / (kPi * wave.variance * std::pow(cos_half, 4));
        // Smith's Lambda in Walter's rational form
        const auto lambda = [&](double cosine) {
            const double a = cosine / std::sqrt(wave.variance * (1 - cosine * cosine));
            return a < 1.6 ? (1 - 1.259 * a + 0.396 * a * a) / (3.535 * a + 2.181 * a * a) : 0.0;
        };
        const double shadow = 1 / (1 + lambda(cos_view) + lambda(cos_sun));
        return air_.sun_irradiance() *
               (fresnel(half.dot(view)) * density * shadow / (4 * cos_view));
    }

    // The sky as level water mirrors it, a mean over the waves' slopes, by azimuth and sqrt(y).
    static constexpr int kReflectionWidth = 128, kReflectionHeight = 40;

    void fill_reflection() {
        constexpr int kSide = 7;
        reflection_.resize(kReflectionWidth * kReflectionHeight);
        parallel_for(kReflectionHeight, [&](std::int64_t j) {
            const double y = std::pow((static_cast<double>(j) + 0.5) / kReflectionHeight, 2);
            for (int i = 0; i < kReflectionWidth; ++i) {
                const Vec3d mirrored =
                    direction_at(std::asin(y), 2 * kPi * (i + 0.5) / kReflectionWidth);
                const Vec3d view(-mirrored.x, mirrored.y, -mirrored.z);
                Vec3d sum(0);
                double weights = 0;
                for (int k = 0; k < kSide * kSide; ++k) {
                    // Slopes out to two and a half standard deviations, by their Gaussian.
                    const double a = 2.5 * (2 * (k % kSide + 0.5) / kSide - 1);
                    const double b = 2.5 * (2 * (k / kSide + 0.5) / kSide - 1);
                    const double sigma = std::sqrt(kSlopeVariance / 2);
                    const Vec3d normal = Vec3d(-a * sigma, 1, -b * sigma).normalized();
                    const double seen = view.dot(normal);
                    Vec3d to = reflect(view, normal);
                    if (seen <= 0) continue;
                    to.y = std::abs(to.y);  // reflected once more, by the next wave
                    const double weight = std::exp(-0.5 * (a * a + b * b)) * seen;
                    sum += sky(to) * weight;
                    weights += weight;
                }
                reflection_[j * kReflectionWidth + i] = sum / weights;
            }
        });
    }

    [[nodiscard]] Vec3d reflected_sky(const Vec3d& direction) const {
        const double azimuth = std::atan2(direction.x, -direction.z);
        const double x = (azimuth / (2 * kPi) + 1) * kReflectionWidth - 0.5;
        const double y = std::clamp(std::sqrt(std::abs(direction.y)) * kReflectionHeight - 0.5, 0.0,
                                    kReflectionHeight - 1.001);
        const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
        const double u = x - x0, v = y - y0;
        const auto at = [&](int i, int j) {
            return reflection_[j * kReflectionWidth + i % kReflectionWidth];
        };
        return mix(mix(at(x0, y0), at(x0 + 1, y0), u), mix(at(x0, y0 + 1), at(x0 + 1, y0 + 1), u),
                   v);
    }

    Atmosphere air_;
    Clouds clouds_;
    std::vector<Vec3d> reflection_;
};

}  // namespace

std::unique_ptr<Environment> make_sunset() {
    return std::make_unique<Sunset>();
}

}  // namespace mirrorball::detail
