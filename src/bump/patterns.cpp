// Sources that do not move: metal, bark, scratches, noise. Each is defined on a lattice of whole
// cells per tile, so that it repeats with it. Heights are in shares of the tile's shorter side.
#include "../environments/noise.h"
#include "tile.h"

namespace mirrorball::detail {
namespace {

// Octaves of noise on a tile, each of half the size and `gain` times the height of the one before;
// those too fine for the texels fade. About -1 to 1 for the first.
class TilingFractal {
  public:
    TilingFractal(const Tile& tile, double cells_across, double cells_down, int octaves,
                  double gain, std::uint32_t seed) {
        double weight = 1;
        for (int i = 0; i < octaves; ++i, weight *= gain) {
            const int across = tile.across(cells_across * (1 << i));
            const int down = tile.down(cells_down * (1 << i));
            const double shown = weight * tile.visible(across, down);
            if (shown > 0)
                octaves_.push_back({across, down, shown, seed + static_cast<std::uint32_t>(i)});
        }
    }

    [[nodiscard]] double operator()(double u, double v) const {
        double sum = 0;
        for (const Octave& octave : octaves_) sum += octave.weight * value(octave, u, v);
        return sum;
    }

    // Of the octaves' sizes, with a rounded valley wherever one of them crosses zero.
    [[nodiscard]] double furrows(double u, double v) const {
        constexpr double kRound = 0.02;
        double sum = 0;
        for (const Octave& octave : octaves_) {
            const double n = value(octave, u, v);
            sum += octave.weight * std::sqrt(n * n + kRound);
        }
        return sum;
    }

  private:
    struct Octave {
        int across, down;
        double weight;
        std::uint32_t seed;
    };
    static double value(const Octave& octave, double u, double v) {
        return tiling_noise({u * octave.across, v * octave.down}, octave.across, octave.down,
                            octave.seed)
            .value;
    }
    std::vector<Octave> octaves_;
};

}  // namespace

Image draw_flat(const Tile& tile) {
    return {tile.columns, tile.rows, 1};
}

Image draw_noise(const Tile& tile) {
    const TilingFractal noise(tile, 4, 4, 8, 0.5, 100);
    return draw(tile, [&, height = 0.02 * tile.side()](double u, double v) {
        return height * noise(u, v);
    });
}

Image draw_brushed(const Tile& tile) {
    const TilingFractal lines(tile, 3, 64, 4, 0.6, 200);
    return draw(tile, [&, height = 0.0004 * tile.side()](double u, double v) {
        return height * lines(u, v);
    });
}

Image draw_bark(const Tile& tile) {
    const TilingFractal sway(tile, 3, 2, 2, 0.5, 300), ridges(tile, 9, 2, 4, 0.5, 310);
    const TilingFractal grain(tile, 32, 16, 3, 0.5, 320);
    return draw(tile, [&, height = 0.03 * tile.side()](double u, double v) {
        const double swayed = u + 0.04 * sway(u, v) * tile.side() / tile.width;
        return height * (ridges.furrows(swayed, v) + 0.05 * grain(u, v));
    });
}

// Each cell of the lattice has the bottom of a dent somewhere in it; the surface is the lowest of
// the paraboloids over them, its creases rounded by a soft minimum.
Image draw_hammered(const Tile& tile) {
    constexpr double kDents = 8, kDepth = 0.02, kSoft = 0.05, kJitter = 0.7;
    constexpr std::uint32_t kSeed = 400;
    const int across = tile.across(kDents), down = tile.down(kDents);
    const double height = kDepth * tile.side() * tile.visible(across, down);
    const auto within = [](int i, int count) { return (i % count + count) % count; };
    return draw(tile, [&](double u, double v) {
        const double x = u * across, y = v * down;
        const int cell_x = static_cast<int>(std::floor(x)),
                  cell_y = static_cast<int>(std::floor(y));
        double sum = 0;
        // Two cells away: nothing that is left out would add e^-10 of the nearest.
        for (int j = cell_y - 2; j <= cell_y + 2; ++j)
            for (int i = cell_x - 2; i <= cell_x + 2; ++i) {
                const int a = within(i, across), b = within(j, down);
                const double dx = i + 0.5 + kJitter * (lattice_number(a, b, kSeed) - 0.5) - x;
                const double dy = j + 0.5 + kJitter * (lattice_number(a, b, kSeed + 1) - 0.5) - y;
                sum += std::exp(-(dx * dx + dy * dy) / kSoft);
            }
        return -height * kSoft * std::log(sum);
    });
}

namespace {

// A straight scratch from (x0, y0), metres, with a Gaussian profile.
struct Scratch {
    double x0, y0, dx, dy, depth;

    // Squared distance from the segment.
    [[nodiscard]] double distance_squared(double x, double y) const {
        const double along =
            std::clamp(((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
        const double off_x = x - x0 - along * dx, off_y = y - y0 - along * dy;
        return off_x * off_x + off_y * off_y;
    }
};

std::vector<Scratch> scratches_of(const Tile& tile, double depth) {
    constexpr double kPerSquare = 160;
    constexpr std::uint32_t kSeed = 500;
    constexpr int kMost = 20000;
    const double side = tile.side();
    const int count = static_cast<int>(
        std::min<double>(kPerSquare * (tile.width / side) * (tile.height / side), kMost));
    std::vector<Scratch> scratches;
    for (int i = 0; i < count; ++i) {
        const auto number = [&](int which) { return lattice_number(i, which, kSeed); };
        const double angle = kPi * number(0);
        const double length = side * (0.06 + 0.6 * number(1) * number(1));  // most are short
        const Vec2 begin = even_point(i);
        scratches.push_back({tile.width * begin.x, tile.height * begin.y, length * std::cos(angle),
                             length * std::sin(angle), depth * (0.3 + 0.7 * number(2))});
    }
    return scratches;
}

}  // namespace

Image draw_scratches(const Tile& tile) {
    // A scratch narrower than texels can show is as much wider as it is shallower: the same volume.
    constexpr double kWidth = 0.0012, kDepth = 0.0006;
    const double texel = std::max(tile.width / tile.columns, tile.height / tile.rows);
    const double side = tile.side(), sigma = std::max(kWidth * side, 0.8 * texel);
    const double reach = 4.5 * sigma;  // the profile is 4e-5 there
    const std::vector<Scratch> scratches =
        scratches_of(tile, kDepth * side * kWidth * side / sigma);

    Image image(tile.columns, tile.rows, 1);
    parallel_for(tile.rows, [&](std::int64_t row) {
        std::vector<double> heights(tile.columns);
        const double v = 1 - (static_cast<double>(row) + 0.5) / tile.rows;
        for (const Scratch& scratch : scratches) {
            // The repetitions of this row that the scratch comes near; it goes up only.
            const double low = scratch.y0 - reach, high = scratch.y0 + scratch.dy + reach;
            for (double turn = std::ceil(low / tile.height - v); (v + turn) * tile.height <= high;
                 ++turn) {
                const double y = (v + turn) * tile.height;
                const double left = std::min(scratch.x0, scratch.x0 + scratch.dx) - reach;
                const double right = std::max(scratch.x0, scratch.x0 + scratch.dx) + reach;
                const double step = tile.width / tile.columns;
                const auto first = static_cast<std::int64_t>(std::ceil(left / step - 0.5));
                const auto last = static_cast<std::int64_t>(std::floor(right / step - 0.5));
                for (std::int64_t i = first; i <= last; ++i) {
                    const double distance =
                        scratch.distance_squared((static_cast<double>(i) + 0.5) * step, y);
                    if (distance > reach * reach) continue;
                    const std::int64_t x = (i % tile.columns + tile.columns) % tile.columns;
                    heights[x] -= scratch.depth * std::exp(-distance / (2 * sigma * sigma));
                }
            }
        }
        std::copy(heights.begin(), heights.end(), image.row(static_cast<int>(row)).begin());
    });
    return image;
}

}  // namespace mirrorball::detail
