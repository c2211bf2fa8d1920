// Lobes: zonal kernels, the weight that a surface gives to light by its angle to the lobe's axis.
//
// A lobe is a value: a shape and its parameter. It is applied about the direction that indexes the
// prefiltered map: the normal n for `diffuse`, the reflection vector r for all others.
#pragma once

#include <string>
#include <string_view>

namespace mirrorball {

/// With t = cos(theta), theta the angle to the axis, and t+ = max(t, 0):
///
///     mirror             a delta
///     diffuse            t+                                      irradiance: integrates to pi
///     phong:N            (N+1)/(2 pi) t+^N                       Lewis 1993; the survey's Eq. 18
///     blinn-phong:N      c cos(theta/2)^N t+                     half-vector form with v = n = r
///     ggx:R              c D(theta/2) t+, alpha = R^2            Walter 2007; v = n = r (Karis
///     2013)
///
///     D(h) = alpha^2 / (pi ((alpha^2 - 1) cos^2 h + 1)^2),  c such that the lobe integrates to 1
struct Lobe {
    enum class Kind { mirror, diffuse, phong, blinn_phong, ggx };

    Kind kind = Kind::mirror;
    /// The exponent N >= 0, or the perceptual roughness R in [0, 1]; unused by mirror and diffuse.
    double parameter = 0;

    /// The weight at t = cos(theta), per steradian, normalised as above. At a parameter where the
    /// lobe is a delta (mirror, ggx:0) it is infinite at t = 1 and 0 elsewhere.
    [[nodiscard]] double value(double cos_theta) const;

    /// The integral over the sphere: pi for diffuse, 1 for all others.
    [[nodiscard]] double integral() const;

    /// The angle about the axis, in radians, that holds `share` of the lobe's integral.
    [[nodiscard]] double angle_holding(double share) const;

    [[nodiscard]] bool is_delta() const;

    bool operator==(const Lobe&) const = default;
};

/// "mirror", "diffuse", "phong:100", "blinn-phong:400", "ggx:0.5"; parse(to_string(l)) == l.
[[nodiscard]] std::string to_string(const Lobe& lobe);
/// \throws Error(Errc::usage) saying which lobes there are, or the parameter, its value and range
[[nodiscard]] Lobe parse_lobe(std::string_view text);

}  // namespace mirrorball
