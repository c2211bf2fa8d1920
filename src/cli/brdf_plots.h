// Plots of BRDFs, good enough for a slide.
#pragma once

#include <string>
#include <vector>

#include <mirrorball/brdf_properties.h>
#include <mirrorball/fresnel.h>

namespace mirrorball::cli {

/// f in the plane of incidence, by the angle of view: a panel per angle of incidence (degrees),
/// each to its own scale.
[[nodiscard]] std::string polar_plot(const Brdf& brdf, const std::string& title,
                                     const std::vector<double>& angles);

/// f over the hemisphere as a body: as far from the centre as it is bright.
[[nodiscard]] std::string hemisphere_plot(const Brdf& brdf, const std::string& title,
                                          const std::vector<double>& angles);

/// Albedo by the angle of incidence, and the furnace where it is not the same.
[[nodiscard]] std::string albedo_plot(const Brdf& brdf, const std::string& title);

/// Reflectance by angle.
[[nodiscard]] std::string fresnel_plot(const Fresnel& fresnel, const std::string& title);

}  // namespace mirrorball::cli
