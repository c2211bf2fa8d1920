// What tests of BRDFs share: models with something to test in each, directions to test them at, and
// integrals over directions that know nothing of samplers.
#pragma once

#include <cmath>
#include <random>

#include <mirrorball/brdf.h>
#include <mirrorball/vector.h>

namespace mirrorball {

inline constexpr const char* kReciprocalModels[] = {
    "lambert:0.8/0.5/0.1",
    "oren-nayar:40",
    "phong:20",
    "phong:0",
    "phong-plain:5",
    "blinn-phong:50",
    "blinn-phong:0.5",
    "lafortune:12",
    "lafortune:8,kx=-1,ky=-0.6,kz=0.7",
    "lafortune:5,kx=1,ky=1,kz=1",
    "ward:0.4",
    "ward:roughness-x=0.3,roughness-y=0.7",
    "ward-original:0.5",
    "banks:20",
    "banks:0",
    "beckmann:0.5",
    "beckmann:0.9,metal=copper",
    "beckmann:roughness-x=0.3,roughness-y=0.8",
    "ggx:0.5,index=1.5",
    "ggx:1",
    "ggx:roughness-x=0.35,roughness-y=0.8,metal=gold",
    "ggx:0.4,f0=0.5/0.6/0.7,f90=0.9",
    "ggx:0.5,metal=iron,coat=1.4",
    "charlie:0.5",
    "charlie:1",
    "plastic:0.8,roughness=0.4",
    "0.4*lambert + 0.3*phong:20 + 0.2*ggx:0.5",
    "0.5*banks:10 + 0.5*plastic:0.5",
    "0.4*lambert + 0.3/0.2/0.1*mirror:index=1.5 + 0.2*phong:20",
};
inline constexpr const char* kLewis = "phong-lewis:30";

inline Vec3d direction(double degrees, double azimuth) {
    const double theta = degrees * kPi / 180;
    return {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth),
            std::cos(theta)};
}

/// A plain one, one in general position, one near grazing.
inline const Vec3d kViews[] = {direction(0, 0), direction(45, 0.7), direction(78, -2)};

/// The integral of f(w) over cosines z0 to z1 and azimuths a0 to a1: 3 x 3 Gauss points against
/// those of its quarters, halved until they agree.
template <class F>
double integrate_patch(F&& f, double z0, double z1, double a0, double a1, double tolerance,
                       int depth = 7) {
    const auto gauss = [&](double y0, double y1, double b0, double b1) {
        constexpr double kX[] = {-0.7745966692414834, 0, 0.7745966692414834};
        constexpr double kW[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
        double sum = 0;
        for (int i = 0; i < 3; ++i) {
            const double z = (y0 + y1) / 2 + (y1 - y0) / 2 * kX[i], s = std::sqrt(1 - z * z);
            for (int j = 0; j < 3; ++j) {
                const double a = (b0 + b1) / 2 + (b1 - b0) / 2 * kX[j];
                sum += kW[i] * kW[j] * f(Vec3d(s * std::cos(a), s * std::sin(a), z));
            }
        }
        return sum * (y1 - y0) * (b1 - b0);
    };
    const double z = (z0 + z1) / 2, a = (a0 + a1) / 2;
    const double whole = gauss(z0, z1, a0, a1);
    const double parts =
        gauss(z0, z, a0, a) + gauss(z0, z, a, a1) + gauss(z, z1, a0, a) + gauss(z, z1, a, a1);
    if (depth == 0 || std::abs(whole - parts) <= tolerance) return parts;
    return integrate_patch(f, z0, z, a0, a, tolerance / 4, depth - 1) +
           integrate_patch(f, z0, z, a, a1, tolerance / 4, depth - 1) +
           integrate_patch(f, z, z1, a0, a, tolerance / 4, depth - 1) +
           integrate_patch(f, z, z1, a, a1, tolerance / 4, depth - 1);
}

/// Over the upper hemisphere, in patches so that no narrow lobe is overlooked, the smaller the
/// nearer to the normal: bands of equal steps in the sine.
template <class F>
double integrate_hemisphere(F&& f, double tolerance = 1e-5) {
    constexpr int kBandCount = 12, kSectorCount = 24;
    const auto edge = [](int band) {
        const double sine = 1 - static_cast<double>(band) / kBandCount;
        return std::sqrt(1 - sine * sine);
    };
    double sum = 0;
    for (int band = 0; band < kBandCount; ++band) {
        for (int sector = 0; sector < kSectorCount; ++sector)
            sum += integrate_patch(f, edge(band), edge(band + 1), 2 * kPi * sector / kSectorCount,
                                   2 * kPi * (sector + 1) / kSectorCount,
                                   tolerance / (kBandCount * kSectorCount));
    }
    return sum;
}

/// Numbers in [0,1) that are the same with every standard library.
class Numbers {
  public:
    double next() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    Vec3d next3() {
        const double x = next(), y = next(), z = next();
        return {x, y, z};
    }

  private:
    std::mt19937_64 engine_{20240607};
};

}  // namespace mirrorball
