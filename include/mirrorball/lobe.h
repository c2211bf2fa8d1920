// Lobes: zonal kernels, the weight that a surface gives to light by its angle to the lobe's axis.
//
// A lobe is a value: a shape and its parameter, or a table of what was measured. It is applied
// about the direction that indexes the prefiltered map: the normal n for `diffuse`, the reflection
// vector r for all others.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace mirrorball {

/// A measured lobe: weights at angles to the axis, straight lines between them (in the angle), the
/// first weight before the first angle and nothing beyond the last.
struct LobeTable {
    std::string name;             ///< printable, without commas
    std::vector<double> angles;   ///< radians, 0 to pi, increasing
    std::vector<double> weights;  ///< per steradian, such that the lobe integrates to 1

    bool operator==(const LobeTable&) const = default;
};

/// With t = cos(theta), theta the angle to the axis, and t+ = max(t, 0):
///
///     mirror             a delta
///     diffuse            t+                             irradiance: integrates to pi
///     phong:N            (N+1)/(2 pi) t+^N              Lewis 1993; the survey's Eq. 18
///     blinn-phong:N      c cos(theta/2)^N t+            half-vector form with v = n = r
///     ggx:R              c D(theta/2) t+, alpha = R^2   Walter 2007; v = n = r (Karis 2013)
///     charlie:R          c C(theta/2) t+, alpha = R^2   sheen; Estevez and Kulla 2017; v = n = r
///     table:NAME         a LobeTable
///
///     D(h) = alpha^2 / (pi ((alpha^2 - 1) cos^2 h + 1)^2),  c such that the lobe integrates to 1
///     C(h) = (2 + 1/alpha) sin(h)^(1/alpha) / (2 pi)
///
/// Charlie's lobe is a ring: nothing at the axis, and the nearer to the horizon the smaller R.
struct Lobe {
    enum class Kind { mirror, diffuse, phong, blinn_phong, ggx, charlie, tabulated };

    Kind kind = Kind::mirror;
    /// The exponent N >= 0, or the perceptual roughness R in [0, 1], for charlie [0.01, 1]; unused
    /// by the others.
    double parameter = 0;
    /// Of a tabulated lobe, and no other. A lobe parsed from text knows its table by name only: it
    /// compares and prints, but has no values.
    std::shared_ptr<const LobeTable> table = nullptr;

    /// The weight at t = cos(theta), per steradian, normalised as above. Of a delta it is infinite
    /// at t = 1 and 0 elsewhere. \throws Error(Errc::usage) for a table known by name only
    [[nodiscard]] double value(double cos_theta) const;

    /// The integral over the sphere: pi for diffuse, 1 for all others.
    [[nodiscard]] double integral() const;

    /// The angle about the axis, in radians, that holds `share` of the lobe's integral.
    [[nodiscard]] double angle_holding(double share) const;

    /// Is it narrower than double precision can tell from its axis? So are mirror, ggx below 1e-4
    /// and exponents above 1e16.
    [[nodiscard]] bool is_delta() const;

    /// Tables are compared by what they hold.
    friend bool operator==(const Lobe& a, const Lobe& b) {
        return a.kind == b.kind && a.parameter == b.parameter &&
               (a.table == b.table || (a.table && b.table && *a.table == *b.table));
    }
};

/// The smallest roughness of charlie: below it the ring is thinner than 0.02 degrees.
inline constexpr double kLeastCharlieRoughness = 0.01;

/// "mirror", "diffuse", "phong:100", "blinn-phong:400", "ggx:0.5", "charlie:0.5", "table:NAME";
/// parse(to_string(l)) == l, but for a table's values.
[[nodiscard]] std::string to_string(const Lobe& lobe);
/// Opens no file. \throws Error(Errc::usage) saying which lobes there are, or the parameter, its
/// value and range
[[nodiscard]] Lobe parse_lobe(std::string_view text);

/// A lobe through points of angle (radians) and weight (in any unit; scaled to integrate to 1).
/// \throws Error(Errc::usage) unless there are 2 to 4096 points, angles increase within [0, pi],
/// and weights are finite, not negative and not all zero
[[nodiscard]] Lobe tabulated_lobe(std::string name, std::vector<double> angles,
                                  std::vector<double> weights);

/// A lobe from a text file: a line per point, its angle to the axis in degrees and its weight,
/// apart by blanks; `#` begins a comment. Its name is the file's, without folders. \throws
/// Error(Errc::cannot_read) naming the file, the line, what was found and what was expected
[[nodiscard]] Lobe read_lobe_table(const std::filesystem::path& path);

}  // namespace mirrorball
