// A clear sky: sunlight scattered by air, haze and ozone over a round earth.
//
// Rayleigh and Mie scattering and ozone's absorption are integrated along rays through a spherical
// atmosphere (Nishita et al. 1993, "Display of the Earth Taking into Account Atmospheric
// Scattering"; Bruneton and Neyret 2008, "Precomputed Atmospheric Scattering"); light scattered
// more than once by the isotropic closed sum of Hillaire 2020, "A Scalable and Production Ready Sky
// and Atmosphere Rendering Technique". The coefficients are those papers', for 680, 550 and 440 nm,
// taken as the red, green and blue of Rec. 709. Light is not refracted.
//
// All of it is put into small tables by the constructor (about 50 ms); looking up is then quick.
//
// Unit: with `exposure` 1, a white sheet that faces the sun above the atmosphere has radiance 1
// (about 42 600 cd/m^2): the sun's irradiance there is pi in each channel. The sun's disc stays
// under the largest half float, 65504, as long as exposure times its transmittance is below 1.
#pragma once

#include <vector>

#include "environment.h"

namespace mirrorball::detail {

struct AtmosphereSettings {
    double sun_elevation, sun_azimuth;  ///< radians; azimuth to the right of -Z
    double haze = 1;                    ///< aerosol, as a multiple of very clear air's
    Vec3d ground_albedo{0.1, 0.1, 0.1};
    double exposure = 1;
};

class Atmosphere {
  public:
    explicit Atmosphere(const AtmosphereSettings& settings);

    /// The sky without the sun's disc, for directions above the horizon (y >= 0; below, the
    /// horizon's).
    [[nodiscard]] Vec3d sky(const Vec3d& direction) const;

    /// What is left of light that comes in this direction from above the atmosphere; y >= 0.
    [[nodiscard]] Vec3d transmittance(const Vec3d& direction) const;

    /// A thing of radiance `radiance`, `distance` metres away at the mean height `height` of the
    /// ray's way through the air, as it is seen through that air.
    [[nodiscard]] Vec3d through_air(const Vec3d& radiance, const Vec3d& direction, double distance,
                                    double height) const;
    /// A cloud of radiance `radiance` and height `height` as it is seen from below, in a direction
    /// in which the clear sky and its transmittance are those given.
    [[nodiscard]] static Vec3d through_air_below(const Vec3d& radiance, const Vec3d& clear_sky,
                                                 const Vec3d& transmittance, double height);

    [[nodiscard]] const Disc& sun() const { return sun_; }
    /// Radiance of the sun's disc, darkened toward its limb and by the air.
    [[nodiscard]] Vec3d sun_radiance(const Vec3d& direction) const;
    /// Irradiance by the sun on a surface that faces it, `height` metres above the ground.
    [[nodiscard]] Vec3d sun_irradiance(double height = 0) const;
    /// Irradiance by the sky alone on level ground.
    [[nodiscard]] const Vec3d& sky_irradiance() const { return sky_irradiance_; }

  private:
    struct Medium {
        Vec3d rayleigh, mie_scattering, extinction;  // per metre
    };
    struct Scattered {
        Vec3d rayleigh_and_multiple, mie;
    };

    [[nodiscard]] Medium medium(double height) const;
    [[nodiscard]] Vec3d integrate_transmittance(double height, double mu) const;
    [[nodiscard]] Vec3d transmittance(double height, double mu) const;
    [[nodiscard]] Vec3d integrate_multiple(double height, double sun_mu) const;
    [[nodiscard]] Vec3d multiple(double height, double sun_mu) const;
    [[nodiscard]] Scattered integrate_sky(const Vec3d& direction) const;

    void fill_tables();

    AtmosphereSettings settings_;
    Disc sun_;
    Vec3d solar_irradiance_;
    Vec3d sky_irradiance_{0, 0, 0};
    std::vector<Vec3d> transmittance_, multiple_;
    std::vector<Scattered> sky_;
};

}  // namespace mirrorball::detail
