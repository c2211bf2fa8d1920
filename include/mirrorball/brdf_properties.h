// The laws that a BRDF should keep, measured: reciprocity, energy, isotropy, positivity.
//
// Integrals go over the model's own samples, evenly spread: kept apart in eight sets, whose scatter
// tells the error. Nothing is random; any number of threads gives the same figures.
#pragma once

#include <vector>

#include <mirrorball/brdf.h>
#include <mirrorball/progress.h>
#include <mirrorball/vector.h>

namespace mirrorball {

/// A colour by quadrature.
struct Integral {
    Vec3d value{0};
    double error = 0;  ///< standard error of the worst channel
};

/// The share of the light from wi that is reflected, in all directions: the survey's Eq. 11, which
/// must not exceed 1. Mirrors included. \pre 256 <= point_count <= 2^24, wi.z > 0
[[nodiscard]] Integral directional_albedo(const Brdf& brdf, const Vec3d& wi,
                                          int point_count = 16384);

/// The radiance towards wo in uniform light of radiance 1, the "white furnace": what a prefiltered
/// white environment holds. The same as the albedo if the BRDF is reciprocal. \pre as above
[[nodiscard]] Integral furnace_radiance(const Brdf& brdf, const Vec3d& wo, int point_count = 16384);

/// The albedo in uniform light, over all directions: 2 * integral of the albedo c dc.
[[nodiscard]] Integral mean_albedo(const Brdf& brdf, int point_count = 16384);

/// The largest of a law's violations over many pairs of directions.
struct Violation {
    double largest = 0;
    Vec3d wi{0, 0, 1}, wo{0, 0, 1};  ///< where it is
    double error = 0;                ///< by how much the second half of the pairs raised it
};

/// The albedo along an angle of incidence.
struct AlbedoPoint {
    double theta = 0;          ///< of wi to the normal, radians
    Integral albedo, furnace;  ///< the worst azimuth of four
};

struct BrdfProperties {
    /// |f(a,b) - f(b,a)| over the larger. 1e-12 is rounding.
    Violation reciprocity;
    /// |f(Ra,Rb) - f(a,b)| over the larger, R a turn about the normal.
    Violation isotropy;
    /// The smallest value of any channel, and how many values were not finite numbers.
    double smallest = 0;
    int not_finite_count = 0;
    /// From the normal to 89.999 degrees.
    std::vector<AlbedoPoint> albedo;
    Integral mean_albedo;

    // What they say, given their errors (three of them).
    [[nodiscard]] bool is_reciprocal() const { return reciprocity.largest < 1e-6; }
    [[nodiscard]] bool is_isotropic() const { return isotropy.largest < 1e-6; }
    [[nodiscard]] bool is_positive() const { return smallest >= 0 && not_finite_count == 0; }
    [[nodiscard]] bool conserves_energy() const;
    /// The point of the largest albedo in any channel.
    [[nodiscard]] const AlbedoPoint& brightest() const;
};

struct BrdfCheckOptions {
    int pair_count = 65536;   ///< of directions; half spread evenly, half by the model's sampling
    int point_count = 16384;  ///< per integral
};

/// All of them. Takes 0.1 to 1 s on two threads with the usual options.
/// \throws Error(Errc::usage) unless 256 <= counts <= 2^24; Error(Errc::cancelled)
[[nodiscard]] BrdfProperties measure_brdf(const Brdf& brdf, const BrdfCheckOptions& options = {},
                                          const Progress& progress = {});

}  // namespace mirrorball
