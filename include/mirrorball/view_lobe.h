// Prefiltering with a BRDF: the survey's equation 16, with five dimensions made two.
//
//     L(v; n, t) = integral over the hemisphere of f(wi, wo) L_i(wi) wi.z dwi
//
// wi and wo the light and the view in the frame of n and t. Seen from one direction, f wi.z is a
// kernel on the sphere; a zonal lobe about an axis of its own stands for it here, and a map
// prefiltered by that lobe, looked up along the axis, for the integral. A stack of such maps, one
// per elevation of the view, is the whole BRDF if it is isotropic; an anisotropic one has the
// view's azimuth to the tangent besides. Kautz and McCool 2000, "Approximation of Glossy Reflection
// with Prefiltered Environment Maps".
//
// Angles are in radians; frames are Axes{t, b, n} of the world.
#pragma once

#include <array>
#include <vector>

#include <mirrorball/axes.h>
#include <mirrorball/brdf.h>
#include <mirrorball/environment_map.h>
#include <mirrorball/lobe.h>
#include <mirrorball/progress.h>

namespace mirrorball {

/// What a BRDF makes of its surroundings for one view:
///
///     f(wi, wo) wi.z  ~  albedo * lobe.value(axis . wi)
///
/// Of all zonal functions about all axes the nearest in least squares over the sphere, R + G + B:
/// about a given axis that is the kernel's mean around it. Channels share the shape.
struct ViewLobe {
    Vec3d view{0, 0, 1};  ///< wo, in the surface's frame
    Vec3d axis{0, 0, 1};  ///< unit, in the same frame
    Lobe lobe;            ///< integrates to 1; `mirror` if nothing but a mirror is there
    Vec3d albedo{0};      ///< the radiance in uniform light of 1, without mirrors
    Vec3d mirror{0};      ///< what mirrors add, of the light from the mirrored view
    /// The rms over the sphere of what the lobe is off by, over the kernel's own rms.
    double fit_error = 0;
};

/// \pre wo.z > 0. Takes about 20 ms.
[[nodiscard]] ViewLobe fit_view_lobe(const Brdf& brdf, const Vec3d& wo);

/// ViewLobes for views all around a surface, and how to look between them.
class ViewStack {
  public:
    /// Fits elevation_count x azimuth_count lobes. One azimuth is enough for isotropic BRDFs: the
    /// view is then turned into the x-z plane.
    /// \throws Error(Errc::usage) unless 1 <= elevation_count <= 64, 1 <= azimuth_count <= 64;
    /// Error(Errc::cancelled)
    ViewStack(const Brdf& brdf, int elevation_count, int azimuth_count = 1,
              const Progress& progress = {});

    [[nodiscard]] int elevation_count() const { return elevation_count_; }
    [[nodiscard]] int azimuth_count() const { return azimuth_count_; }
    /// The view's angle to the normal: evenly from 0 to 85 degrees.
    [[nodiscard]] double elevation(int i) const;
    /// The view's azimuth to the tangent: evenly around, from 0 on.
    [[nodiscard]] double azimuth(int j) const;
    /// [elevation][azimuth], elevations slowest: the order of the maps of a stack.
    [[nodiscard]] const std::vector<ViewLobe>& lobes() const { return lobes_; }

    /// How to shade a view: the sum over four of weight * albedo * map along the axis.
    struct Lookup {
        Vec3d axis{0, 0, 1};  ///< in the surface's frame
        std::array<int, 4> layers{};
        std::array<double, 4> weights{};  ///< add up to 1
    };
    [[nodiscard]] Lookup look_up(const Vec3d& wo) const;

  private:
    int elevation_count_, azimuth_count_;
    std::vector<ViewLobe> lobes_;
};

/// Equation 16 itself, without mirrors: a sum in double over every texel of level 0.
/// \pre `view` is a unit vector of the world, towards the viewer
[[nodiscard]] Vec3d reflected_radiance(const EnvironmentMap& map, const Brdf& brdf,
                                       const Axes& frame, const Vec3d& view);

/// The same as a stack has it, with each lobe's sum made for the very axis: what is left next to
/// the above is the error of the fit.
[[nodiscard]] Vec3d reflected_radiance(const EnvironmentMap& map, const ViewStack& stack,
                                       const Axes& frame, const Vec3d& view);

/// The rms of the difference between the two over the rms of the first, over `count` surfaces and
/// views spread evenly, views to 85 degrees.
[[nodiscard]] double measure_fit(const EnvironmentMap& map, const Brdf& brdf,
                                 const ViewStack& stack, int count = 256,
                                 const Progress& progress = {});

}  // namespace mirrorball
