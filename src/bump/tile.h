// What the sources of bump share: a tile and what its texels can show.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include <mirrorball/bump.h>

#include "core/parallel.h"

namespace mirrorball::detail {

/// Points of a tile are (u, v), both from 0 to 1; u to the right, v up.
struct Tile {
    double width, height;  ///< metres
    int columns, rows;     ///< texels
    double time;           ///< seconds

    /// What patterns take their measures from: the shorter side, metres.
    [[nodiscard]] double side() const { return std::min(width, height); }
    /// How many of something fit across and down if there are `per_side` on the shorter side.
    [[nodiscard]] int across(double per_side) const { return count(per_side * width / side()); }
    [[nodiscard]] int down(double per_side) const { return count(per_side * height / side()); }

    /// How much of a wave is shown that has so many cycles in the tile: all of it from 4 texels a
    /// cycle up, nothing below 2, so that it never aliases.
    [[nodiscard]] double visible(double cycles_across, double cycles_down) const {
        const double per_texel = std::max(cycles_across / columns, cycles_down / rows);
        return std::clamp(2 - 4 * per_texel, 0.0, 1.0);
    }

  private:
    static int count(double number) {
        constexpr double kMost = 1 << 20;  // leaves room for octaves in 32 bits
        return static_cast<int>(std::clamp(std::round(number), 1.0, kMost));
    }
};

/// Heights at the texels' centres.
template <class Height>
Image draw(const Tile& tile, const Height& height) {
    Image image(tile.columns, tile.rows, 1);
    parallel_for(tile.rows, [&](std::int64_t y) {
        const double v = 1 - (static_cast<double>(y) + 0.5) / tile.rows;
        for (int x = 0; x < tile.columns; ++x)
            *image.at(x, static_cast<int>(y)) =
                static_cast<float>(height((x + 0.5) / tile.columns, v));
    });
    return image;
}

// The sources, in metres.
[[nodiscard]] Image draw_flat(const Tile& tile);
[[nodiscard]] Image draw_ripples(const Tile& tile);
[[nodiscard]] Image draw_waves(const Tile& tile);
[[nodiscard]] Image draw_brushed(const Tile& tile);
[[nodiscard]] Image draw_hammered(const Tile& tile);
[[nodiscard]] Image draw_bark(const Tile& tile);
[[nodiscard]] Image draw_scratches(const Tile& tile);
[[nodiscard]] Image draw_noise(const Tile& tile);

/// Of deep water: omega = sqrt(g k), radians per second for radians per metre.
[[nodiscard]] inline double water_omega(double k) {
    constexpr double kGravity = 9.80665;  // m/s^2, the standard
    return std::sqrt(kGravity * k);
}

}  // namespace mirrorball::detail
