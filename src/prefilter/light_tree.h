// The light of an environment as a tree over the six faces of a cube: each cell holds what arrives
// from its part of the sphere, and is the parent of the four under it. A lobe far from a cell, or
// wide against it, need not look at its children.
#pragma once

#include <vector>

#include <mirrorball/environment_map.h>

#include "prefilter/lobe_kernel.h"

namespace mirrorball::detail {

/// A lobe made ready for the tree.
struct TreeLobe {
    explicit TreeLobe(const Lobe& lobe);

    /// The weight of light that comes from a chord away, up to a factor.
    [[nodiscard]] double weight(double chord2) const {
        if (table.empty()) return kernel(1 - chord2 / 2);
        const double at = chord2 * table_scale;
        if (at >= kTableSteps) return 0;
        const int i = static_cast<int>(at);
        return table[i] + (table[i + 1] - table[i]) * (at - i);
    }

    LobeKernel kernel;
    double integral;
    double scale;  ///< the angle over which the lobe changes by about a factor of two at its axis
    double reach;  ///< the chord beyond which it is negligible
    bool power_tail;  ///< does it fall off as a power of the angle, ever more slowly?

  private:
    // Lobes whose evaluation is a power are read off a table up to their reach: straight lines over
    // steps of 1/2048 are within 1e-5 of a function that falls by e^16 on the way.
    static constexpr int kTableSteps = 2048;
    std::vector<float> table;
    double table_scale = 0;
};

class LightTree {
  public:
    /// From level 0 of any map. The finest cells are about as fine as the source's texels.
    explicit LightTree(const EnvironmentMap& source);

    /// The sum over the tree of weight times radiance, over the sum of the weights, for a lobe
    /// about `axis` (in the world, unit length).
    [[nodiscard]] Vec3d filtered(const TreeLobe& lobe, const Vec3d& axis) const;

  private:
    struct Cell {
        Vec3f direction{0.0f};  // in the world, unit length: where its light comes from, on average
        float radius = 0;       // the chord from there to its farthest corner
        Vec3f flux{0.0f};
        float solid_angle = 0;  // of the source texels in it; 0 if there is none
    };
    struct Walk;
    struct Nearest;

    void sort_in(const EnvironmentMap& source);
    void gather_children(int level);
    void finish(int level);
    void visit_cell(Walk& walk, std::size_t level, std::size_t index) const;
    void visit_nearest(Nearest& nearest, std::size_t level, std::size_t index) const;

    // [0] is one cell a face. The four under cell i of a level are 4 i to 4 i + 3 of the next: a
    // face's cells lie in Morton order, each beside its siblings.
    std::vector<std::vector<Cell>> levels_;
};

}  // namespace mirrorball::detail
