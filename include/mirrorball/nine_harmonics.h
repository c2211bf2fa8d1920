// Spherical harmonics: an environment in nine numbers per channel, enough for its irradiance.
//
// The basis is the real, orthonormal one of Ramamoorthi and Hanrahan 2001, "An Efficient
// Representation for Irradiance Environment Maps", without the Condon-Shortley sign, on our world's
// axes (right-handed, +Y up), with (x, y, z) the unit direction:
//
//     Y_0,0 = sqrt(1/4pi)
//     Y_1,-1 = sqrt(3/4pi) y        Y_1,0 = sqrt(3/4pi) z         Y_1,1 = sqrt(3/4pi) x
//     Y_2,-2 = sqrt(15/4pi) x y     Y_2,-1 = sqrt(15/4pi) y z     Y_2,0 = sqrt(5/16pi) (3 z^2 - 1)
//     Y_2,1 = sqrt(15/4pi) x z      Y_2,2 = sqrt(15/16pi) (x^2 - y^2)
//
// Coefficients are stored in this order: (l, m) at l^2 + l + m.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include <mirrorball/environment_map.h>
#include <mirrorball/harmonics.h>

namespace mirrorball {

inline constexpr int kNineHarmonics = 9;

struct NineHarmonics {
    std::array<Vec3d, kNineHarmonics> coefficients;

    NineHarmonics() { coefficients.fill(Vec3d(0, 0, 0)); }  // Imath's vectors begin undefined
};

/// The nine basis functions. \pre |direction| == 1
[[nodiscard]] std::array<double, kNineHarmonics> nine_harmonic_basis(const Vec3d& direction);

/// Radiance's coefficients, L_lm = integral of L Y_lm dw: a sum in double over every used texel, by
/// its exact solid angle. A uniform environment of radiance L has L_00 = sqrt(4 pi) L and no
/// others, to rounding and, for the others, to the square of the texels' size.
[[nodiscard]] NineHarmonics analyse_nine(const EnvironmentMap& map, int level = 0);

/// Irradiance's coefficients from radiance's: E_lm = A_l L_lm, A = pi, 2 pi / 3, pi / 4. What the
/// bands above carry is at most a few percent of a diffuse map, more where one small light is all.
[[nodiscard]] NineHarmonics convolved_with_cosine(const NineHarmonics& radiance);

/// The sum of coefficient times basis function. \pre |direction| == 1
[[nodiscard]] Vec3d evaluate(const NineHarmonics& harmonics, const Vec3d& direction);

/// The first three bands of harmonics about +Y (harmonics.h) in this basis, about +Z; bands that
/// are not there are zero.
[[nodiscard]] NineHarmonics nine_harmonics(const Harmonics& harmonics);

/// What nine numbers per channel stand for in a program. With A_l as above and Y_lm = k_lm p_lm,
/// p = 1, y, z, x, xy, yz, 3z^2 - 1, xz, x^2 - y^2 in our order:
///
///     radiance      L_lm                       summed with Y_lm: the light itself, blurred
///     irradiance    A_l L_lm                   summed with Y_lm: E(n), W m^-2
///     outgoing      A_l L_lm / pi              summed with Y_lm: what a white matte surface shows
///     polynomial    A_l L_lm k_lm / pi         the same, summed with p_lm: no constants in a
///     shader filament      polynomial                 IndirectLight::Builder::irradiance()
///     three.js      radiance                   LightProbe.sh; its shaders multiply by A_l
///     unity         polynomial, z negated      SphericalHarmonicsL2; its world is left-handed
///
/// Established from Filament's include/filament/IndirectLight.h (its table has the basis functions'
/// signs twice, in L_lm and in the factor, so that they cancel) and from three.js'
/// src/math/SphericalHarmonics3.js, getIrradianceAt(); Unity's is as its users describe it
/// (SHTools), with unity_SHA*, SHB* and SHC packed from it by the shaders' own rule.
enum class HarmonicScale { radiance, irradiance, outgoing, polynomial, filament, three_js, unity };

/// "radiance", ..., "three.js", "unity"
[[nodiscard]] std::string_view name(HarmonicScale scale);
[[nodiscard]] std::vector<HarmonicScale> harmonic_scales();
/// \throws Error(Errc::usage) naming the scales there are
[[nodiscard]] HarmonicScale parse_harmonic_scale(std::string_view text);

/// Radiance's coefficients as the scale has them.
[[nodiscard]] NineHarmonics scaled(const NineHarmonics& radiance, HarmonicScale scale);

}  // namespace mirrorball
