#include "atmosphere.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "shading.h"

namespace mirrorball::detail {
namespace {

constexpr double kGroundRadius = 6'360'000, kTopRadius = 6'460'000;  // metres
constexpr double kEyeHeight = 10;

// Scattering and absorption at sea level, per metre, and how fast they fall off with height.
const Vec3d kRayleigh{5.802e-6, 13.558e-6, 33.1e-6};
constexpr double kRayleighHeight = 8000;
// Haze dims short wavelengths more, as wavelength^-1.3 (Angstrom's law for continental air).
const Vec3d kMieScattering{3.03e-6, 3.996e-6, 5.34e-6};
constexpr double kMieAlbedo = 0.9;
constexpr double kMieHeight = 1200;
constexpr double kMieAsymmetry = 0.8;
// Ozone lies in a layer about 25 km up, which a tent of 15 km to each side describes.
const Vec3d kOzoneAbsorption{0.650e-6, 1.881e-6, 0.085e-6};
constexpr double kOzoneCentre = 25'000, kOzoneHalfWidth = 15'000;

// The sun: 0.53 degrees across; darker toward its limb, the more the shorter the wavelength
// (L = L0 (1 - u (1 - mu)), whose mean over the disc is 1 - u/3).
constexpr double kSunRadius = 0.265 * kPi / 180;
const Vec3d kLimbDarkening{0.48, 0.62, 0.76};

constexpr int kTransmittanceWidth = 128, kTransmittanceHeight = 48;
constexpr int kMultipleWidth = 24, kMultipleHeight = 16;
constexpr int kSkyWidth = 48, kSkyHeight = 160;

double rayleigh_phase(double cosine) {
    return 3 / (16 * kPi) * (1 + cosine * cosine);
}

// Cornette and Shanks 1992: Henyey-Greenstein's forward peak with Rayleigh's symmetry.
double mie_phase(double cosine) {
    constexpr double g = kMieAsymmetry;
    const double base = 1 + g * g - 2 * g * cosine;
    return 3 / (8 * kPi) * (1 - g * g) * (1 + cosine * cosine) /
           ((2 + g * g) * base * std::sqrt(base));
}

double distance_to_top(double radius, double mu) {
    const double root = radius * radius * (mu * mu - 1) + kTopRadius * kTopRadius;
    return std::max(0.0, -radius * mu + std::sqrt(std::max(root, 0.0)));
}

// Negative where the ray misses the ground.
double distance_to_ground(double radius, double mu) {
    const double root = radius * radius * (mu * mu - 1) + kGroundRadius * kGroundRadius;
    return mu >= 0 || root < 0 ? -1 : -radius * mu - std::sqrt(root);
}

// Height, and cosine of the angle to the vertical of another direction, after a way along a ray.
struct RayPoint {
    double height, sun_mu;
};
RayPoint walk(double radius, double mu, double sun_mu, double cos_to_sun, double distance) {
    const double r = std::sqrt(radius * radius + distance * distance + 2 * radius * mu * distance);
    return {r - kGroundRadius, (radius * sun_mu + distance * cos_to_sun) / r};
}

// Steps that grow with the square of their number: short where the air is dense.
struct Step {
    double middle, length;
};
Step step(int i, int count, double distance) {
    const double a = static_cast<double>(i) / count, b = static_cast<double>(i + 1) / count;
    return {distance * 0.5 * (a * a + b * b), distance * (b * b - a * a)};
}

struct Bilinear {
    int x0, x1, y0, y1;
    double u, v;

    // x and y in [0, 1], the ends on the first and last entries.
    Bilinear(double x, double y, int width, int height) {
        const double sx = std::clamp(x, 0.0, 1.0) * (width - 1);
        const double sy = std::clamp(y, 0.0, 1.0) * (height - 1);
        x0 = std::min(static_cast<int>(sx), width - 2),
        y0 = std::min(static_cast<int>(sy), height - 2);
        x1 = x0 + 1, y1 = y0 + 1;
        u = sx - x0, v = sy - y0;
    }
    template <class Get>
    Vec3d operator()(Get get) const {
        return (get(x0, y0) * (1 - u) + get(x1, y0) * u) * (1 - v) +
               (get(x0, y1) * (1 - u) + get(x1, y1) * u) * v;
    }
};

}  // namespace

Atmosphere::Atmosphere(const AtmosphereSettings& settings)
    : settings_(settings),
      sun_{direction_at(settings.sun_elevation, settings.sun_azimuth), kSunRadius},
      solar_irradiance_(Vec3d(kPi) * settings.exposure) {
    fill_tables();
}

Atmosphere::Medium Atmosphere::medium(double height) const {
    const Vec3d rayleigh = kRayleigh * std::exp(-height / kRayleighHeight);
    const double aerosol = settings_.haze * std::exp(-height / kMieHeight);
    const double ozone = std::max(0.0, 1 - std::abs(height - kOzoneCentre) / kOzoneHalfWidth);
    const Vec3d mie = kMieScattering * aerosol;
    return {rayleigh, mie, rayleigh + mie / kMieAlbedo + kOzoneAbsorption * ozone};
}

// Transmittance
// ------------------------------------------------------------------------------------
//
// From a height to the top of the air along a ray that does not meet the ground. The table's axes
// are Bruneton's: the ray's length, and the distance to the horizon, each scaled to its range.

Vec3d Atmosphere::integrate_transmittance(double height, double mu) const {
    constexpr int kSteps = 64;
    const double radius = kGroundRadius + height;
    const double distance = distance_to_top(radius, mu);
    Vec3d depth(0);
    for (int i = 0; i < kSteps; ++i) {
        const Step s = step(i, kSteps, distance);
        depth += medium(walk(radius, mu, 0, 0, s.middle).height).extinction * s.length;
    }
    return exp(-depth);
}

Vec3d Atmosphere::transmittance(double height, double mu) const {
    const double radius = kGroundRadius + std::max(height, 0.0);
    const double to_horizon =
        std::sqrt(std::max(0.0, radius * radius - kGroundRadius * kGroundRadius));
    const double top_to_horizon =
        std::sqrt(kTopRadius * kTopRadius - kGroundRadius * kGroundRadius);
    const double shortest = kTopRadius - radius, longest = to_horizon + top_to_horizon;
    const double x = (distance_to_top(radius, mu) - shortest) / (longest - shortest);
    return Bilinear(x, to_horizon / top_to_horizon, kTransmittanceWidth, kTransmittanceHeight)(
        [&](int i, int j) { return transmittance_[j * kTransmittanceWidth + i]; });
}

// Light scattered more than once
// -------------------------------------------------------------------
//
// The mean radiance at a height, for a sun of irradiance 1: the second order is integrated, and all
// further ones are taken to come down from it by the same factor each (Hillaire's equation 10).

Vec3d Atmosphere::integrate_multiple(double height, double sun_mu) const {
    constexpr int kCosines = 8, kAzimuths = 4, kSteps = 20;
    const double radius = kGroundRadius + height;
    const double sun_sine = std::sqrt(1 - sun_mu * sun_mu);
    Vec3d second(0), factor(0);
    for (int direction = 0; direction < kCosines * kAzimuths; ++direction) {
        const double mu = 2 * (direction / kAzimuths + 0.5) / kCosines - 1;
        const double azimuth = kPi * (direction % kAzimuths + 0.5) / kAzimuths;
        const double cos_to_sun =
            mu * sun_mu + std::sqrt(1 - mu * mu) * sun_sine * std::cos(azimuth);
        const double to_ground = distance_to_ground(radius, mu);
        const double distance = to_ground >= 0 ? to_ground : distance_to_top(radius, mu);

        Vec3d through(1);
        for (int i = 0; i < kSteps; ++i) {
            const Step s = step(i, kSteps, distance);
            const RayPoint p = walk(radius, mu, sun_mu, cos_to_sun, s.middle);
            const Medium m = medium(p.height);
            const Vec3d scattering = m.rayleigh + m.mie_scattering;
            const bool lit = distance_to_ground(kGroundRadius + p.height, p.sun_mu) < 0;
            const Vec3d here = through * scattering * s.length;
            factor += here;
            if (lit) second += here * transmittance(p.height, p.sun_mu) / (4 * kPi);
            through *= exp(-m.extinction * s.length);
        }
        if (to_ground >= 0) {
            const double ground_mu = walk(radius, mu, sun_mu, cos_to_sun, to_ground).sun_mu;
            if (ground_mu > 0)
                second += through * settings_.ground_albedo * transmittance(0, ground_mu) *
                          (ground_mu / kPi);
        }
    }
    constexpr double kShare = 1.0 / (kCosines * kAzimuths);
    return second * kShare / (Vec3d(1) - factor * kShare);
}

Vec3d Atmosphere::multiple(double height, double sun_mu) const {
    const double x = 0.5 + 0.5 * sun_mu;
    const double y = std::sqrt(std::max(height, 0.0) / (kTopRadius - kGroundRadius));
    return Bilinear(x, y, kMultipleWidth, kMultipleHeight)(
        [&](int i, int j) { return multiple_[j * kMultipleWidth + i]; });
}

// The sky
// ------------------------------------------------------------------------------------------
//
// One table by sqrt(y), which is dense at the horizon, and by the cosine of the azimuth to the sun,
// in which the sky is smooth. Haze's narrow phase function is left out of it and put on at look-up.

Atmosphere::Scattered Atmosphere::integrate_sky(const Vec3d& direction) const {
    constexpr int kSteps = 48;
    const double radius = kGroundRadius + kEyeHeight;
    const double mu = direction.y, sun_mu = sun_.direction.y;
    const double cos_to_sun = direction.dot(sun_.direction);
    const double phase = rayleigh_phase(cos_to_sun);
    const double distance = distance_to_top(radius, mu);

    Vec3d through(1), rayleigh(0), mie(0);
    for (int i = 0; i < kSteps; ++i) {
        const Step s = step(i, kSteps, distance);
        const RayPoint p = walk(radius, mu, sun_mu, cos_to_sun, s.middle);
        const Medium m = medium(p.height);
        const bool lit = distance_to_ground(kGroundRadius + p.height, p.sun_mu) < 0;
        const Vec3d sunlight = lit ? transmittance(p.height, p.sun_mu) : Vec3d(0);
        const Vec3d step_through = exp(-m.extinction * s.length);
        // The step's own light, dimmed on its way through the step: (1 - e^-x) / x
        const Vec3d length = (Vec3d(1) - step_through) / m.extinction;
        rayleigh += through * length *
                    (sunlight * m.rayleigh * phase +
                     multiple(p.height, p.sun_mu) * (m.rayleigh + m.mie_scattering));
        mie += through * length * sunlight * m.mie_scattering;
        through *= step_through;
    }
    return {rayleigh * solar_irradiance_, mie * solar_irradiance_};
}

Vec3d Atmosphere::sky(const Vec3d& direction) const {
    const double y = std::max(direction.y, 0.0);
    const double across = std::hypot(direction.x, direction.z);
    const double sun_across = std::hypot(sun_.direction.x, sun_.direction.z);
    const double cosine = across > 0
                              ? (direction.x * sun_.direction.x + direction.z * sun_.direction.z) /
                                    (across * sun_across)
                              : 1;
    const Bilinear table(0.5 - 0.5 * cosine, std::sqrt(y), kSkyWidth, kSkyHeight);
    const auto entry = [&](int i, int j) -> const Scattered& { return sky_[j * kSkyWidth + i]; };
    const Vec3d rayleigh = table([&](int i, int j) { return entry(i, j).rayleigh_and_multiple; });
    const Vec3d mie = table([&](int i, int j) { return entry(i, j).mie; });
    return rayleigh + mie * mie_phase(std::min(direction.dot(sun_.direction), 1.0));
}

Vec3d Atmosphere::transmittance(const Vec3d& direction) const {
    return transmittance(kEyeHeight, std::max(direction.y, 0.0));
}

// Along a level ray through even air, the light scattered into it grows as 1 - transmittance, up to
// the whole sky's.
Vec3d Atmosphere::through_air(const Vec3d& radiance, const Vec3d& direction, double distance,
                              double height) const {
    const Vec3d through = exp(medium(height).extinction * -distance);
    const Vec3d air = (Vec3d(1) - through) / (Vec3d(1) - transmittance(direction));
    return radiance * through +
           sky(direction) * Vec3d(std::min(air.x, 1.0), std::min(air.y, 1.0), std::min(air.z, 1.0));
}

// The same along a slanted ray, where most of the air and nearly all haze is low.
Vec3d Atmosphere::through_air_below(const Vec3d& radiance, const Vec3d& clear_sky,
                                    const Vec3d& transmittance, double height) {
    constexpr double kMeanHeight = 5000;  // between air's and haze's
    const double share = 1 - std::exp(-height / kMeanHeight);
    const Vec3d through{std::pow(transmittance.x, share), std::pow(transmittance.y, share),
                        std::pow(transmittance.z, share)};
    return radiance * through + clear_sky * ((Vec3d(1) - through) / (Vec3d(1) - transmittance));
}

Vec3d Atmosphere::sun_radiance(const Vec3d& direction) const {
    // From the angle to the centre to the cosine at the sun's surface.
    const double sine = direction.cross(sun_.direction).length() / std::sin(sun_.radius);
    const double mu = std::sqrt(std::max(0.0, 1 - sine * sine));
    const Vec3d centre =
        solar_irradiance_ / (sun_.solid_angle() * (Vec3d(1) - kLimbDarkening / 3.0));
    return centre * (Vec3d(1) - kLimbDarkening * (1 - mu)) * transmittance(direction);
}

Vec3d Atmosphere::sun_irradiance(double height) const {
    return solar_irradiance_ * transmittance(height, sun_.direction.y);
}

void Atmosphere::fill_tables() {
    transmittance_.resize(kTransmittanceWidth * kTransmittanceHeight);
    parallel_for(kTransmittanceHeight, [&](std::int64_t j) {
        const double top_to_horizon =
            std::sqrt(kTopRadius * kTopRadius - kGroundRadius * kGroundRadius);
        const double to_horizon =
            top_to_horizon * static_cast<double>(j) / (kTransmittanceHeight - 1);
        const double radius = std::hypot(to_horizon, kGroundRadius);
        const double shortest = kTopRadius - radius, longest = to_horizon + top_to_horizon;
        for (int i = 0; i < kTransmittanceWidth; ++i) {
            const double d = mix(shortest, longest, i / (kTransmittanceWidth - 1.0));
            const double mu =
                d > 0 ? (kTopRadius * kTopRadius - radius * radius - d * d) / (2 * radius * d) : 1;
            transmittance_[j * kTransmittanceWidth + i] =
                integrate_transmittance(radius - kGroundRadius, std::clamp(mu, -1.0, 1.0));
        }
    });

    multiple_.resize(kMultipleWidth * kMultipleHeight);
    parallel_for(kMultipleHeight, [&](std::int64_t j) {
        const double y = static_cast<double>(j) / (kMultipleHeight - 1);
        const double height = y * y * (kTopRadius - kGroundRadius);
        for (int i = 0; i < kMultipleWidth; ++i)
            multiple_[j * kMultipleWidth + i] =
                integrate_multiple(height, 2 * i / (kMultipleWidth - 1.0) - 1);
    });

    sky_.resize(kSkyWidth * kSkyHeight);
    parallel_for(kSkyHeight, [&](std::int64_t j) {
        const double y = std::pow(static_cast<double>(j) / (kSkyHeight - 1), 2);
        for (int i = 0; i < kSkyWidth; ++i) {
            const double azimuth = std::acos(1 - 2 * i / (kSkyWidth - 1.0));
            sky_[j * kSkyWidth + i] =
                integrate_sky(direction_at(std::asin(y), settings_.sun_azimuth + azimuth));
        }
    });

    // Level ground: equal shares of the projected hemisphere.
    constexpr int kRings = 32, kSpokes = 64;
    for (int i = 0; i < kRings * kSpokes; ++i) {
        const double y = std::sqrt(1 - (i / kSpokes + 0.5) / kRings);
        const double azimuth = 2 * kPi * (i % kSpokes + 0.5) / kSpokes;
        sky_irradiance_ += sky(direction_at(std::asin(y), azimuth)) * (kPi / (kRings * kSpokes));
    }
}

}  // namespace mirrorball::detail
