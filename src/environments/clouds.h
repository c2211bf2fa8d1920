// Thin sheets of cloud on shells around the earth.
//
// A sheet is fractal noise, dragged about by slower noise and gathered into patches. It scatters
// the sun's light once, mostly forward, and dims it where it is thick; it lies behind its share of
// the air. So low suns set it aglow, and it fades into the horizon as real clouds do.
#pragma once

#include <span>

#include "atmosphere.h"
#include "noise.h"

namespace mirrorball::detail {

struct CloudSheet {
    double height;     // metres
    Vec2 scale;        // metres per unit of noise, along and across the wind
    Vec2 wind;         // where it blows to, of length 1
    double warp;       // how far slower noise drags the pattern, in units of noise
    double low, high;  // noise values of clear sky and of the thickest cloud
    double patches;    // how strongly it gathers
    double depth;      // optical depth of the thickest
    double relief;     // how much a slope toward the sun brightens and one away darkens
    double darkest;    // share of the light that the thickest parts keep
    Fractal pattern;
};

class Clouds {
  public:
    /// Sheets from the lowest to the highest; `detail` as in Environment. All are kept by
    /// reference.
    Clouds(const Atmosphere& air, std::span<const CloudSheet> sheets, double detail);

    /// The clear sky in a direction with the clouds before it.
    [[nodiscard]] Vec3d over(const Vec3d& clear, const Vec3d& direction) const;

    /// What is left of light that comes through all sheets.
    [[nodiscard]] double transmittance(const Vec3d& direction) const;

  private:
    struct Sample {
        double depth, relief;
    };
    [[nodiscard]] Sample sample(const CloudSheet& sheet, const Vec3d& direction) const;

    const Atmosphere& air_;
    std::span<const CloudSheet> sheets_;
    double detail_;
    std::vector<Vec3d> sunlight_;  // by sheet
};

}  // namespace mirrorball::detail
