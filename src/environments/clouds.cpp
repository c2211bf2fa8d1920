#include "clouds.h"

#include <cmath>
#include <optional>

#include "shading.h"

namespace mirrorball::detail {
namespace {

constexpr double kEarthRadius = 6'360'000;

// Droplets and ice throw most light forward, some of it everywhere: two of Henyey and Greenstein's
// functions (1941, "Diffuse Radiation in the Galaxy").
double phase(double cosine) {
    const auto henyey_greenstein = [&](double g) {
        const double base = 1 + g * g - 2 * g * cosine;
        return (1 - g * g) / (4 * kPi * base * std::sqrt(base));
    };
    return 0.55 * henyey_greenstein(0.72) + 0.45 * henyey_greenstein(0.1);
}

}  // namespace

Clouds::Clouds(const Atmosphere& air, std::span<const CloudSheet> sheets, double detail)
    : air_(air),
      sheets_(sheets),
      detail_(detail) {
    for (const CloudSheet& sheet : sheets) sunlight_.push_back(air.sun_irradiance(sheet.height));
}

Clouds::Sample Clouds::sample(const CloudSheet& sheet, const Vec3d& direction) const {
    // Where the ray meets the shell, and how steeply.
    const double across = kEarthRadius * direction.y;
    const double distance =
        -across + std::sqrt(across * across + sheet.height * (2 * kEarthRadius + sheet.height));
    const double steepness = (across + distance) / (kEarthRadius + sheet.height);

    const double c = sheet.wind.x, s = sheet.wind.y;
    const double x = direction.x * distance, z = direction.z * distance;
    const Vec2 p{(c * x + s * z) / sheet.scale.x, (c * z - s * x) / sheet.scale.y};
    const double footprint = detail_ * distance / (steepness * sheet.scale.y);

    const std::uint32_t seed = sheet.pattern.seed;
    const double patches = noise({p.x * 0.13 + 3.7, p.y * 0.21}, seed + 57).value;
    const NoiseSample drag = Fractal{2, 0.5, seed + 31}({p.x * 0.35, p.y * 0.35}, 0);
    const NoiseSample n =
        sheet.pattern({p.x + sheet.warp * drag.value, p.y + sheet.warp * drag.dx * 0.5}, footprint);
    const double amount = smoothstep(sheet.low, sheet.high, n.value + sheet.patches * patches);

    if (amount == 0) return {0, 0};

    // The side of a billow that faces the sun is the brighter one.
    const Vec3d& sun = air_.sun().direction;
    const double toward = (c * sun.x + s * sun.z) * n.dx + (c * sun.z - s * sun.x) * n.dy;
    // A sheet on edge is thicker, but not without end: it is made of billows with gaps.
    const double slant = 1 / std::max(steepness, 0.35);
    return {sheet.depth * amount * slant, std::tanh(-0.5 * toward)};
}

Vec3d Clouds::over(const Vec3d& clear, const Vec3d& direction) const {
    std::optional<Vec3d> air;
    const Vec3d ambient = air_.sky_irradiance() * (0.9 / kPi);
    const double forward = phase(direction.dot(air_.sun().direction));
    Vec3d light = clear;
    // The highest first: what is nearer lies over it.
    for (std::size_t i = sheets_.size(); i-- > 0;) {
        const CloudSheet& sheet = sheets_[i];
        const Sample cloud = sample(sheet, direction);
        if (cloud.depth == 0) continue;
        if (!air) air = air_.transmittance(direction);
        const double lit = (1 + sheet.relief * cloud.relief) *
                           mix(sheet.darkest, 1.0, std::exp(-0.35 * cloud.depth));
        // Light that is scattered more than once comes out of thick cloud evenly.
        const double even = 0.8 / kPi * air_.sun().direction.y * (1 - std::exp(-0.5 * cloud.depth));
        const Vec3d own = sunlight_[i] * ((forward + even) * lit) + ambient;
        light = mix(light, Atmosphere::through_air_below(own, clear, *air, sheet.height),
                    1 - std::exp(-cloud.depth));
    }
    return light;
}

double Clouds::transmittance(const Vec3d& direction) const {
    double depth = 0;
    for (const CloudSheet& sheet : sheets_) depth += sample(sheet, direction).depth;
    return std::exp(-depth);
}

}  // namespace mirrorball::detail
