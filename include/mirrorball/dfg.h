// DFG tables: the half of the "split sum" that no environment changes. What a surface reflects of a
// prefiltered environment is L = L_D (F0 A + F90 B); this gives A and B. Derivations, errors and
// shader code: docs/theory/dfg.md.
//
// n_dot_v is the cosine between normal and view, roughness the perceptual one, alpha = roughness^2.
#pragma once

#include <mirrorball/image.h>
#include <mirrorball/progress.h>
#include <mirrorball/vector.h>

namespace mirrorball {

/// A GGX surface in uniform light of radiance 1, with Schlick's F and height-correlated Smith G:
///
///     integral of D G F / (4 n.l n.v) n.l dl = F0 A + F90 B,    F = F0 + (F90 - F0)(1 - v.h)^5
///
/// Karis 2013, "Real Shading in Unreal Engine 4", calls them scale and bias.
struct Dfg {
    double scale = 0;  ///< A
    double bias = 0;   ///< B

    /// E, the directional albedo of F0 = F90 = 1: what is missing from 1 is light that hits more
    /// than one microfacet.
    [[nodiscard]] double albedo() const { return scale + bias; }
    [[nodiscard]] Vec3d reflectance(const Vec3d& f0, double f90 = 1) const {
        return f0 * scale + Vec3d(f90 * bias);
    }
};

/// Within 2e-6, by a fixed quadrature of 768 points, in 10 us. Roughness 0 is a mirror: A
/// and B add up to 1, as they do at n_dot_v = 0 for every roughness. At roughness 0.5 and n_dot_v
/// 0.5 they are 0.8349 and 0.0224.
/// \pre  0 <= n_dot_v <= 1, 0 <= roughness <= 1
[[nodiscard]] Dfg ggx_dfg(double n_dot_v, double roughness);

/// The mean of E over the hemisphere, 2 * integral E(c) c dc: 1 for a mirror, 0.41 at roughness 1.
[[nodiscard]] double ggx_mean_albedo(double roughness);

/// The directional albedo of Charlie sheen (Sheen in brdf.h) of reflectance 1, within
/// 1e-6 of itself. Roughness below 0.01 counts as 0.01. Above 1 at grazing angles if roughness <
/// 0.42. 0.2296 at roughness 0.5, n_dot_v 0.5.
[[nodiscard]] double charlie_albedo(double n_dot_v, double roughness);

// Multiple scattering
// ------------------------------------------------------------------------------------------
//
// One bounce loses up to 69 % of the light at roughness 1. Two ways to give it back, which both
// reflect all light if F0 = 1.

/// The factor on the prefiltered reflection, 1 + F0 (1/E - 1). Turquin 2019, "Practical Multiple
/// Scattering Compensation for Microfacet Models"; Filament's. \pre  albedo > 0
[[nodiscard]] Vec3d energy_compensation(const Vec3d& f0, double albedo);

/// The share of the light that leaves after several bounces, which is as diffuse as that which the
/// base under the layer reflects:
///
///     L = (F0 A + B) L_D + (multiple + diffuse albedo) irradiance / pi
///
/// Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting".
struct MultipleScattering {
    Vec3d single;    ///< F0 A + B
    Vec3d multiple;  ///< F_ms E_ms
    Vec3d diffuse;   ///< what is left for the base: 1 - single - multiple; metals have no base
};
[[nodiscard]] MultipleScattering multiple_scattering(const Dfg& dfg, const Vec3d& f0);

// Table
// --------------------------------------------------------------------------------------------------

/// A, B and Charlie's albedo, tabulated.
///
/// Columns are n_dot_v, rows are roughness, both growing with the index; texel (x, y) is at its
/// centre, n_dot_v (x + 1/2) / width, roughness (y + 1/2) / height. So a shader looks up the
/// texture coordinate (n_dot_v, roughness), bilinear, clamped to the edge, if row 0 is at t = 0.
class DfgTable {
  public:
    /// 128 x 128 take 0.3 s on two threads. The same bits at any number of them.
    /// \throws Error(Errc::usage) unless 2 <= width, height <= 4096; Error(Errc::cancelled)
    DfgTable(int width, int height, const Progress& progress = {});

    /// Three channels: A, B, Charlie.
    [[nodiscard]] const Image& image() const { return image_; }

    /// As a graphics card filters it. \pre  as of ggx_dfg()
    [[nodiscard]] Dfg ggx(double n_dot_v, double roughness) const;
    [[nodiscard]] double charlie(double n_dot_v, double roughness) const;

  private:
    [[nodiscard]] Vec3f look_up(double n_dot_v, double roughness) const;

    Image image_;
};

}  // namespace mirrorball
