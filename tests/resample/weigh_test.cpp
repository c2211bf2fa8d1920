#include "resample/weigh.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace mirrorball::detail {
namespace {

constexpr int kWidth = 40, kHeight = 24;  // of a face, a multiple of four

// A face of random colours, with its columns' slopes and one float more.
struct Face {
    std::vector<float> texels = std::vector<float>(3 * kWidth * kHeight + 1), slopes = texels;

    Face() {
        std::mt19937 random(1);
        std::exponential_distribution<float> value;
        std::ranges::generate(texels, [&] { return value(random); });
        for (int y = 1; y < kHeight - 1; ++y)
            find_slopes(&texels[3 * kWidth * y], kWidth, &slopes[3 * kWidth * y]);
    }
};

// Boxes all over the face, of all kinds and sizes, the kinds in runs that no block of four fits.
std::vector<Box> boxes(int count) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> share(0, 1);
    std::vector<Box> all(count);
    for (int i = 0; i < count; ++i) {
        Box& box = all[i];
        box.s = static_cast<std::uint32_t>(share(random) * 0x1p32);
        box.t = static_cast<std::uint32_t>(share(random) * 0x1p32);
        const double largest = i % 3 == 0 ? kLargestBox : 2;
        box.width = static_cast<std::uint16_t>(1 + share(random) * largest / kBoxUnit);
        box.height = static_cast<std::uint16_t>(1 + share(random) * largest / kBoxUnit);
        box.kind = i % 7 == 0 ? BoxKind::none : i % 23 < 11 ? BoxKind::smooth : BoxKind::mean;
    }
    return all;
}

// A texel of the face as moved, wherever the move takes it from.
double moved_texel(const Face& face, const Move& move, int x, int y, int channel) {
    const int column =
                  (mirrored(move.flip_s, x, 1, kWidth) + move.quarters * (kWidth / 4)) % kWidth,
              row = mirrored(move.flip_t, y, 1, kHeight);
    return face.texels[3 * (kWidth * row + column) + channel];
}

double slope(double left, double right) {
    if (left * right <= 0) return 0;
    const double doubled = left + right;
    const double most = 6 * std::min(std::abs(left), std::abs(right));
    return std::clamp(doubled, -most, most);
}

double cubic(const double* v, double x) {
    const double rest = 1 - x, at_c = x * x * (3 - 2 * x);
    return v[1] * (1 - at_c) + v[2] * at_c + slope(v[1] - v[0], v[2] - v[1]) * x * rest * rest / 2 -
           slope(v[2] - v[1], v[3] - v[2]) * x * x * rest / 2;
}

// The mean of the tent of the texel at 0 over the box about x.
double tent_share(double x, double width) {
    const auto integral = [](double at) {
        const double inside = std::clamp(at, -1.0, 1.0);
        return inside - inside * std::abs(inside) / 2;
    };
    return (integral(x + width / 2) - integral(x - width / 2)) / width;
}

// What a box is worth by definition; not a number if it reaches over the face's edges.
double truth(const Face& face, const Box& box, const Move& move, int channel) {
    if (box.kind == BoxKind::none) return 0;
    const double u = box.s * 0x1p-32 * kWidth - 0.5, v = box.t * 0x1p-32 * kHeight - 0.5;
    const double w = box.width * kBoxUnit, h = box.height * kBoxUnit;
    const auto texel = [&](int x, int y) {
        if (x < 0 || y < 0 || x >= kWidth || y >= kHeight) return std::nan("");
        return moved_texel(face, move, x, y, channel);
    };
    if (box.kind == BoxKind::smooth) {
        const int x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
        double columns[4];
        for (int i = 0; i < 4; ++i) {
            double rows[4];
            for (int j = 0; j < 4; ++j) rows[j] = texel(x - 1 + i, y - 1 + j);
            columns[i] = cubic(rows, v - y);
        }
        return cubic(columns, u - x);
    }
    double sum = 0;
    for (int y = static_cast<int>(std::floor(v - h / 2)); y <= std::floor(v + h / 2) + 1; ++y)
        for (int x = static_cast<int>(std::floor(u - w / 2)); x <= std::floor(u + w / 2) + 1; ++x)
            sum += texel(x, y) * tent_share(x - u, w) * tent_share(y - v, h);
    return sum;
}

// By all ways to move a face, in either order, with slopes known and not. Single precision, and
// weights of up to 6 in a cubic's slopes: 1e-5 of values up to ten or so.
TEST(Weigh, StencilsAreWorthWhatTheirBoxesAre) {
    const Face face;
    const std::vector<Box> all = boxes(1000);
    int compared = 0;
    for (int way = 0; way < 64; ++way) {
        const bool reversed = (way & 1) != 0, by_slopes = (way & 2) != 0;
        MovedLevel level;
        level.faces[0] = face.texels.data();
        if (by_slopes) level.slopes[0] = face.slopes.data();
        level.width = kWidth, level.height = kHeight;
        level.moves[0] = {0, (way & 4) != 0, (way & 8) != 0, way / 16};
        for (std::size_t done = 0; done < all.size();) {
            Stencils stencils;
            int owners[kMostStencils], across[kMostStencils];
            const int more = append_stencils(&all[done], static_cast<int>(all.size() - done),
                                             kWidth, kHeight, stencils, owners);
            ASSERT_GT(more, 0);
            std::vector<float> values(3 * stencils.count);
            const int across_count = weigh(stencils, reversed, level, values.data(), across);
            std::vector<double> sums(3 * more);
            for (int k = 0; k < stencils.count; ++k)
                for (int c = 0; c < 3; ++c)
                    sums[3 * owners[k] + c] +=
                        values[3 * (reversed ? stencils.count - 1 - k : k) + c];
            for (int i = 0; i < across_count; ++i)
                for (int c = 0; c < 3; ++c) sums[3 * owners[across[i]] + c] = std::nan("");
            for (int i = 0; i < 3 * more; ++i) {
                if (std::isnan(sums[i])) continue;
                ++compared;
                ASSERT_NEAR(sums[i], truth(face, all[done + i / 3], level.moves[0], i % 3), 1e-5)
                    << "way " << way << " box " << done + i / 3;
            }
            done += more;
        }
    }
    EXPECT_GT(compared, 64 * 3 * 500);
}

// What reaches over an edge is left to the slow way, which has to hear of it.
TEST(Weigh, ReachingOverAnEdgeIsReported) {
    const Face face;
    MovedLevel level;
    level.faces[0] = face.texels.data();
    level.width = kWidth, level.height = kHeight;
    Box inside{0x80000000u, 0x80000000u, 8192, 8192, 0, BoxKind::mean};
    std::vector<Box> all(5, inside);
    all[1].s = 0, all[2].t = 0xffffffffu, all[4].at_rim = true;
    Stencils stencils;
    int owners[kMostStencils], across[kMostStencils];
    ASSERT_EQ(append_stencils(all.data(), 5, kWidth, kHeight, stencils, owners), 5);
    std::vector<float> values(3 * stencils.count);
    ASSERT_EQ(weigh(stencils, false, level, values.data(), across), 3);
    EXPECT_EQ(std::vector<int>(across, across + 3), (std::vector{1, 2, 4}));
}

}  // namespace
}  // namespace mirrorball::detail
