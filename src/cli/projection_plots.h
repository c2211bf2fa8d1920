// Projections in cross section, as SVG: how directions land on a map.
#pragma once

#include <string>

#include <mirrorball/projection.h>

namespace mirrorball::cli {

/// A drawing for a slide: the surface that the projection is the picture of, a row of texels, and
/// the direction that each of them holds, coloured by it; its facts below.
[[nodiscard]] std::string projection_plot(Projection projection, const ProjectionFacts& facts);

}  // namespace mirrorball::cli
