// Fresnel: how much of the light that meets a smooth surface is mirrored, by the angle at which it
// does. Section 6 of the survey; formulas and derivations in docs/theory/brdf.md.
//
// cos_theta is the cosine between the normal and the light (or, being equal, the view).
// Reflectances are shares of power, 0 to 1, of unpolarised light; a Vec3d holds one for each of R,
// G and B.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <mirrorball/image.h>
#include <mirrorball/vector.h>

namespace mirrorball {

/// Between two transparent media, the survey's Eq. 19. With n the index of refraction behind the
/// surface over that in front of it, c = cos_theta and g^2 = n^2 + c^2 - 1:
///
///     F = 1/2 (g-c)^2/(g+c)^2 [1 + (c(g+c) - 1)^2 / (c(g-c) + 1)^2],   1 where g^2 < 0
///
/// n < 1 is light that leaves the denser medium; beyond asin(n) it is reflected totally. A negative
/// cosine is light that meets the surface from behind: as if the index were 1/n.
/// At c = 1 it is ((n-1)/(n+1))^2, 0.04 for n = 1.5; at c = 0 it is 1.
/// \pre  -1 <= cos_theta <= 1, index > 0
[[nodiscard]] double fresnel_dielectric(double cos_theta, double index);

/// A metal, of complex index n + i k relative to what is in front of it; k = 0 is a dielectric.
/// At c = 1 it is ((n-1)^2 + k^2)/((n+1)^2 + k^2). Born and Wolf 1999, "Principles of
/// Optics", 14.2. \pre  0 <= cos_theta <= 1, index > 0, extinction >= 0
[[nodiscard]] double fresnel_conductor(double cos_theta, double index, double extinction);

/// f0 + (f90 - f0)(1 - c)^5. Schlick 1994, "An Inexpensive BRDF Model for Physically-based
/// Rendering".
[[nodiscard]] double fresnel_schlick(double cos_theta, double f0, double f90 = 1);

/// A clear coating of index `coat` on a metal or dielectric of index n + i k, both relative to what
/// is in front of the coating. With R1 and R2 the reflectances of the coating's upper and lower
/// face along the ray that is refracted into it, light goes to and fro between them:
///
///     R = R1 + (1-R1)^2 R2 / (1 - R1 R2),      for each polarisation, then their mean
///
/// Powers are added, not amplitudes: right for coatings of many wavelengths (lacquer, water), which
/// show no interference colours. coat = 1 is the bare base. Born and Wolf 1999, 7.6, averaged over
/// the phase.
/// \pre  0 <= cos_theta <= 1, coat >= 1, index > 0, extinction >= 0
[[nodiscard]] double fresnel_coated(double cos_theta, double coat, double index, double extinction);

/// A metal's complex index n + i k at 650, 550 and 450 nm, which stand for R, G and B.
struct Metal {
    std::string_view name;
    Vec3d index, extinction;
    std::string_view source;
};
/// Gold, silver, copper, aluminium, iron, titanium, chromium, nickel; measured at room temperature.
[[nodiscard]] std::span<const Metal> metals();
/// \throws Error(Errc::usage) naming the metals there are
[[nodiscard]] const Metal& metal(std::string_view name);

/// A surface's reflectance by angle, as a value.
class Fresnel {
  public:
    /// 1 at every angle: a perfect mirror.
    Fresnel() = default;

    /// \param index  relative to what is in front; 0.01 to 100
    [[nodiscard]] static Fresnel dielectric(double index);
    /// \param index       n per channel, 0.01 to 100
    /// \param extinction  k per channel, 0 to 100
    [[nodiscard]] static Fresnel conductor(const Vec3d& index, const Vec3d& extinction);
    /// \param metal  a name of metals()
    [[nodiscard]] static Fresnel conductor(std::string_view metal);
    /// \param f0, f90  at normal and at grazing incidence, 0 to 1 per channel
    [[nodiscard]] static Fresnel schlick(const Vec3d& f0, const Vec3d& f90 = Vec3d(1));
    /// The same under a clear coating, 1 to 3; see fresnel_coated(). A dielectric or a conductor
    /// only. All of these throw Error(Errc::usage) naming the parameter, its value and range.
    [[nodiscard]] Fresnel coated(double coat) const;

    /// For cosines from 0 to 1; outside, as at the end of that range.
    [[nodiscard]] Vec3d operator()(double cos_theta) const;

    /// The mean over the hemisphere by flux, 2 * integral of F(c) c dc, to 1e-9: the reflectance in
    /// uniform light. For n = 1.5 it is 0.0918.
    [[nodiscard]] Vec3d average() const;

    /// What it was made of, each 0 where it does not apply.
    enum class Kind { ideal, dielectric, conductor, schlick };
    [[nodiscard]] Kind kind() const { return kind_; }
    [[nodiscard]] const Vec3d& index() const { return first_; }        ///< dielectric: all alike
    [[nodiscard]] const Vec3d& extinction() const { return second_; }  ///< of a conductor
    [[nodiscard]] const Vec3d& f0() const { return first_; }           ///< of Schlick's
    [[nodiscard]] const Vec3d& f90() const { return second_; }         ///< of Schlick's
    [[nodiscard]] double coat() const { return coat_; }                ///< 1: none

    bool operator==(const Fresnel&) const = default;

  private:
    Fresnel(Kind kind, const Vec3d& first, const Vec3d& second)
        : kind_(kind),
          first_(first),
          second_(second) {}
    [[nodiscard]] double channel(double cos_theta, int channel) const;

    Kind kind_ = Kind::ideal;
    Vec3d first_{0}, second_{0};  // index and extinction, or f0 and f90
    double coat_ = 1;
};

/// Parameters in the spelling of parse_brdf(): "", "index=1.5", "metal=gold",
/// "n=0.2/0.9/1.1,k=3.9", "f0=0.04", "f0=0.04,f90=0.5", and after the first three of these
/// ",coat=1.5".
[[nodiscard]] std::string to_string(const Fresnel& fresnel);
/// parse_fresnel(to_string(f)) == f. \throws Error(Errc::usage)
[[nodiscard]] Fresnel parse_fresnel(std::string_view text);

/// The survey's 1-D Fresnel map: F by the cosine, for a renderer's texture.
///
/// Sample i of n is F at cos_theta = i / (n - 1), straight lines between them. As a texture with
/// linear filtering and texels at their centres: coordinate (cos_theta (n - 1) + 1/2) / n.
class FresnelMap {
  public:
    /// \throws Error(Errc::usage) unless 2 <= sample_count <= 65536
    FresnelMap(const Fresnel& fresnel, int sample_count);

    [[nodiscard]] Vec3d operator()(double cos_theta) const;
    [[nodiscard]] std::span<const Vec3f> samples() const { return samples_; }
    /// n x 1 texels of three channels.
    [[nodiscard]] Image image() const;

    /// Against the curve that it was made of, over cosines from 0 to 1 and all channels. It falls
    /// with the square of the sample count, until float32 (6e-8) is the limit.
    struct InterpolationError {
        double largest = 0;    ///< absolute
        double at_cosine = 0;  ///< where that is
        double rms = 0;        ///< uniform in the cosine
    };
    [[nodiscard]] InterpolationError interpolation_error() const;

  private:
    Fresnel exact_;
    std::vector<Vec3f> samples_;
};

/// How a mirror-like layer and the diffuse surface under it share the light.
enum class Coating {
    off,  ///< Eq. 20, L = F L_mirror + L_diffuse: more light than arrives where both are white
    transparent  ///< Eq. 21, L = F L_mirror + (1-F) L_diffuse: in uniform light, as much at most
};
/// What the mirrored and the diffuse light are multiplied by.
struct LayerWeights {
    Vec3d mirror, diffuse;
};
[[nodiscard]] LayerWeights layer_weights(Coating coating, const Fresnel& fresnel, double n_dot_v);

/// The coupling that is reciprocal as well, of two directions and not one: the factor on a diffuse
/// BRDF albedo/pi under a layer of directional albedo E and mean albedo <E> = 2 integral E(c) c dc,
///
///     (1 - E(n.l)) (1 - E(n.v)) / (1 - <E>)
///
/// With a white diffuse surface the two together reflect all light, from every direction. E of a
/// smooth layer is F itself; summed over uniform light the factor is then 1 - F(n.v), Eq. 21's.
/// Kelemen and Szirmay-Kalos 2001, "A Microfacet Based Coupled Specular-Matte BRDF Model with
/// Importance Sampling"; Ashikhmin and Shirley 2000 couple Schlick's F by the same thought.
[[nodiscard]] Vec3d diffuse_coupling(const Vec3d& albedo_light, const Vec3d& albedo_view,
                                     const Vec3d& mean_albedo);

}  // namespace mirrorball
