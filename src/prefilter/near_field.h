// The near parts of lobes, added in space: what harmonics lack around bright texels.
#pragma once

#include <span>
#include <vector>

#include <mirrorball/vector.h>

#include "prefilter/near_kernel.h"

namespace mirrorball::detail {

struct Light {
    Vec3f direction;
    Vec3f power;  // radiance times solid angle
    float solid_angle;
};

/// Directions of neighbouring texels, and the sums that belong to them: one array per component.
struct NearTile {
    std::span<const float> x, y, z;
    std::span<float> r, g, b;
    std::span<float> weight = {};  // empty, or the sum of near times solid angle
};

/// Lights in cells of neighbours, cells in cells, so that a tile passes over all that do not reach
/// it. 44 bytes a light.
class NearField {
  public:
    explicit NearField(std::span<const Light> lights);

    /// r, g, b += sum over lights of near(|d - w|) power. The order of additions depends on the
    /// lights and the tile alone. About 1 ns per texel and light that its tile is in reach of.
    /// \pre all spans of a tile have one size
    void add(const NearKernel& near, const NearTile& tile) const;

    /// May any light reach into the ball, of directions, by that kernel?
    [[nodiscard]] bool reaches(const NearKernel& near, const Vec3f& centre, float radius) const;

  private:
    // A ball in space that holds the directions of its lights.
    struct Ball {
        Vec3f centre;
        float radius;
    };
    struct Walk;

    void visit(Walk& walk, std::size_t level, std::size_t index) const;
    [[nodiscard]] bool reached(const NearKernel& near, const Ball& ball, std::size_t level,
                               std::size_t index) const;

    std::vector<float> x_, y_, z_, r_, g_, b_, solid_angle_;  // in Morton order
    std::vector<std::vector<Ball>> levels_;  // [0] of kFan lights each, the next of kFan balls each
};

}  // namespace mirrorball::detail
