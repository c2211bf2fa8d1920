// A summer noon: a high sun over grassland and hills, small clouds in clear air.
//
// The ground is lit by sun and sky and seen through the air before it, so it fades toward the
// horizon; so do the ranges of hills, each a silhouette by azimuth with a bumpy slope below it.
#include <array>
#include <cmath>

#include "atmosphere.h"
#include "clouds.h"
#include "environment.h"
#include "noise.h"
#include "shading.h"

namespace mirrorball::detail {
namespace {

constexpr double kDetail = 0.28 * kPi / 180;

const AtmosphereSettings kAir{.sun_elevation = 56 * kPi / 180,
                              .sun_azimuth = -38 * kPi / 180,
                              .haze = 3,
                              .ground_albedo = {0.07, 0.09, 0.04},
                              .exposure = 1.25};

const std::array kSheets{
    CloudSheet{.height = 1700,
               .scale = {2300, 2000},
               .wind = heading(radians(35)),
               .warp = 0.15,
               .low = 0.2,
               .high = 1.05,
               .patches = 0.45,
               .depth = 5,
               .relief = 0.35,
               .darkest = 0.45,
               .pattern = {7, 0.55, 401}},
    CloudSheet{.height = 9500,
               .scale = {24000, 4500},
               .wind = heading(radians(70)),
               .warp = 0.4,
               .low = 0.0,
               .high = 1.4,
               .patches = 0.55,
               .depth = 0.4,
               .relief = 0.1,
               .darkest = 0.5,
               .pattern = {7, 0.58, 471}},
};

// The land
// ------------------------------------------------------------------------------------------

constexpr double kEyeHeight = 4;  // metres
const Vec3d kGrass{0.070, 0.112, 0.030}, kDryGrass{0.205, 0.178, 0.078}, kSoil{0.135, 0.105, 0.066};

struct Range {
    double distance;         // metres
    double base, amplitude;  // elevation of its crest, radians: mean and swing
    double frequency;        // bumps around the horizon, about
    double gain;             // of the finer octaves: high for woods, low for far ridges
    Vec3d albedo;
};
const std::array kRanges{
    // from the nearest
    Range{1400, radians(0.35), radians(0.55), 3.1, 0.50, {0.030, 0.055, 0.014}},
    Range{4500, radians(1.00), radians(1.00), 2.3, 0.46, {0.045, 0.066, 0.024}},
    Range{12000, radians(1.9), radians(1.5), 1.9, 0.46, {0.055, 0.062, 0.036}},
    Range{30000, radians(2.9), radians(2.1), 1.5, 0.50, {0.075, 0.072, 0.062}},
};

class Noon final : public Environment {
  public:
    Noon() : air_(kAir), clouds_(air_, kSheets, kDetail) {}

    [[nodiscard]] Vec3d radiance(const Vec3d& direction) const override {
        if (direction.y < 0) return plain(direction);
        for (std::size_t i = 0; i < kRanges.size(); ++i) {
            if (direction.y > kHighestRange) break;
            const double below = crest(i, direction) - std::asin(direction.y);
            if (below > 0) return slope(i, direction, below);
        }
        return clouds_.over(air_.sky(direction), direction);
    }
    [[nodiscard]] double detail() const override { return kDetail; }
    [[nodiscard]] std::optional<Disc> disc() const override { return air_.sun(); }
    [[nodiscard]] Vec3d disc_radiance(const Vec3d& direction) const override {
        return air_.sun_radiance(direction) * clouds_.transmittance(direction);
    }

  private:
    static constexpr double kHighestRange = 0.16;  // sine of an elevation that no crest reaches

    // A point on a circle, which noise goes round without a seam.
    static Vec2 around(const Vec3d& direction, double radius) {
        const double scale = radius / std::hypot(direction.x, direction.z);
        return {direction.x * scale, direction.z * scale};
    }

    [[nodiscard]] static double crest(std::size_t i, const Vec3d& direction) {
        const Range& range = kRanges[i];
        const Fractal profile{8, range.gain, 500 + 20 * static_cast<std::uint32_t>(i)};
        const double height =
            profile(around(direction, range.frequency), kDetail * range.frequency).value;
        return range.base + range.amplitude * height;
    }

    // A hillside, `below` radians under its crest.
    [[nodiscard]] Vec3d slope(std::size_t i, const Vec3d& direction, double below) const {
        const Range& range = kRanges[i];
        // Ridges and gullies run down from the crest: bumps along it, drawn out downward.
        const Vec2 p = around(direction, range.frequency * 5);
        const Fractal bumps{5, 0.6, 700 + 20 * static_cast<std::uint32_t>(i)};
        const double down = below / range.amplitude;
        const NoiseSample n =
            bumps({p.x + 0.6 * down, p.y - 0.8 * down}, kDetail * range.frequency * 5);

        const Vec3d outward = Vec3d(direction.x, 0, direction.z).normalized();
        const Vec3d along = outward.cross(Vec3d(0, 1, 0));
        const Vec3d normal =
            (Vec3d(0, 1, 0) - outward * 0.55 + along * (0.55 * n.dx) - outward * (0.3 * n.dy))
                .normalized();
        const Vec3d albedo = range.albedo * (1 + 0.35 * n.value);
        return air_.through_air(lit(albedo, normal), direction, range.distance, 0);
    }

    [[nodiscard]] Vec3d plain(const Vec3d& direction) const {
        const double distance =
            std::min(kEyeHeight / std::max(-direction.y, 1e-9), kRanges.front().distance);
        const double x = direction.x * distance, z = direction.z * distance;
        // A sample's footprint is stretched along the ray by the grazing angle.
        const double footprint = kDetail * distance / std::max(-direction.y, 0.01);

        // Fields and hollows, then tussocks; dry grass on what is higher.
        constexpr double kFields = 130, kTussocks = 4;
        const double fields =
            Fractal{4, 0.55, 900}({x / kFields, z / kFields}, footprint / kFields).value;
        const NoiseSample tussocks =
            Fractal{6, 0.6, 930}({x / kTussocks, z / kTussocks}, footprint / kTussocks);
        const double dry = smoothstep(-0.7, 0.9, fields + 0.35 * tussocks.value);
        const double bare = 0.8 * smoothstep(0.7, 1.6, tussocks.value - 0.5 * fields);
        const Vec3d albedo = mix(mix(kGrass, kDryGrass, dry), kSoil, bare);

        const Vec3d normal = Vec3d(-0.045 * tussocks.dx, 1, -0.045 * tussocks.dy).normalized();
        // Grass is brighter with the sun behind the viewer, whose side hides its own shadows.
        const double behind = std::max(0.0, -direction.dot(air_.sun().direction));
        const Vec3d light = lit(albedo, normal) * (0.85 + 0.35 * behind * behind);
        return air_.through_air(light, direction, distance, 0);
    }

    // A dull surface in sun and sky.
    [[nodiscard]] Vec3d lit(const Vec3d& albedo, const Vec3d& normal) const {
        const double facing = std::max(0.0, normal.dot(air_.sun().direction));
        const Vec3d irradiance =
            air_.sun_irradiance() * facing + air_.sky_irradiance() * (0.5 + 0.5 * normal.y);
        return albedo * irradiance / kPi;
    }

    Atmosphere air_;
    Clouds clouds_;
};

}  // namespace

std::unique_ptr<Environment> make_noon() {
    return std::make_unique<Noon>();
}

}  // namespace mirrorball::detail
