#include "edge_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <mirrorball/projections/cube.h>

#include "core/parallel.h"

namespace mirrorball::detail {
namespace {

// Where the n samples of a side lie on [0, 1].
enum class Grid { centres, edges };

double coordinate(Grid grid, int index, int n) {
    return grid == Grid::centres ? (index + 0.5) / n : static_cast<double>(index) / (n - 1);
}

double position(Grid grid, double coordinate, int n) {
    return grid == Grid::centres ? coordinate * n - 0.5 : coordinate * (n - 1);
}

Grid other(Grid grid) {
    return grid == Grid::centres ? Grid::edges : Grid::centres;
}

// Up to four neighbouring samples and the weights by which the polynomial through them is
// evaluated.
struct Stencil {
    int first, count;
    std::array<double, 4> weights;
};

// Two samples on each side of the position, or the nearest four that the n samples have.
Stencil stencil(double at, int n) {
    Stencil s{};
    s.count = std::min(n, 4);
    s.first = std::clamp(static_cast<int>(std::floor(at)) - 1, 0, n - s.count);
    for (int i = 0; i < s.count; ++i) {
        s.weights[i] = 1;
        for (int j = 0; j < s.count; ++j)
            if (j != i) s.weights[i] *= (at - (s.first + j)) / (i - j);
    }
    return s;
}

void interpolate(const Image& image, const Stencil& across, const Stencil& down, float* out) {
    for (int c = 0; c < image.channels(); ++c) {
        double sum = 0;
        float least = image.at(across.first, down.first)[c], most = least;
        for (int j = 0; j < down.count; ++j)
            for (int i = 0; i < across.count; ++i) {
                const float value = image.at(across.first + i, down.first + j)[c];
                sum += down.weights[j] * across.weights[i] * value;
                least = std::min(least, value), most = std::max(most, value);
            }
        out[c] = std::clamp(static_cast<float>(sum), least, most);
    }
}

// The polynomials need two samples beyond an edge.
constexpr int kMargin = 2;

// From a picture with margins to the other grid.
Image change_grid(const Image& padded, Grid from) {
    const int width = padded.width() - 2 * kMargin, height = padded.height() - 2 * kMargin;
    const auto stencils = [&](int n, int padded_size) {
        std::vector<Stencil> all;
        for (int i = 0; i < n; ++i)
            all.push_back(
                stencil(position(from, coordinate(other(from), i, n), n) + kMargin, padded_size));
        return all;
    };
    const std::vector<Stencil> across = stencils(width, padded.width());
    const std::vector<Stencil> down = stencils(height, padded.height());
    Image result(width, height, padded.channels());
    parallel_for(height, [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < width; ++x) interpolate(padded, across[x], down[y], result.at(x, y));
    });
    return result;
}

// A cube face and what the neighbouring faces have around it, where its own plane goes on.
Image pad_face(const std::vector<Image>& faces, int face, Grid grid) {
    const Image& own = faces[face];
    const int n = own.width();
    Image padded(n + 2 * kMargin, n + 2 * kMargin, own.channels());
    for (int y = -kMargin; y < n + kMargin; ++y)
        for (int x = -kMargin; x < n + kMargin; ++x) {
            float* out = padded.at(x + kMargin, y + kMargin);
            if (x >= 0 && x < n && y >= 0 && y < n) {
                std::copy_n(own.at(x, y), own.channels(), out);
                continue;
            }
            const FacePoint<double> there = Cube::project(Cube::direction(
                FacePoint<double>{face, coordinate(grid, x, n), coordinate(grid, y, n)}));
            interpolate(faces[there.face], stencil(position(grid, there.s, n), n),
                        stencil(position(grid, there.t, n), n), out);
        }
    return padded;
}

std::vector<Image> change_cube_grid(const std::vector<Image>& faces, Grid from) {
    // One texel has its only sample in the middle on either grid.
    if (faces.front().width() == 1) return faces;
    std::vector<Image> result;
    for (int face = 0; face < 6; ++face)
        result.push_back(change_grid(pad_face(faces, face, from), from));
    return result;
}

// A value of one row at any longitude: the row goes round in `period` samples.
void interpolate_round(const Image& image, int y, double at, int period, float* out) {
    const int first = static_cast<int>(std::floor(at)) - 1;
    const Stencil s = stencil(at - first, 4);
    for (int c = 0; c < image.channels(); ++c) {
        double sum = 0;
        for (int i = 0; i < 4; ++i) {
            const int x = ((first + i) % period + period) % period;
            sum += s.weights[i] * image.at(x, y)[c];
        }
        out[c] = static_cast<float>(sum);
    }
}

// An equirect and what is around it: to the sides it goes round; beyond a pole it comes back on the
// opposite meridian.
Image pad_equirect(const Image& image, Grid grid) {
    const int width = image.width(), height = image.height();
    const int period = grid == Grid::edges ? width - 1 : width;
    const int pole = grid == Grid::edges ? 0 : -1;  // row j beyond it is row `pole - j`
    Image padded(width + 2 * kMargin, height + 2 * kMargin, image.channels());
    for (int y = -kMargin; y < height + kMargin; ++y) {
        int row = y;
        if (y < 0) row = pole - y;
        if (y >= height) row = 2 * (height - 1) - pole - y;
        const double turn = row == y ? 0 : period / 2.0;
        row = std::clamp(row, 0, height - 1);
        for (int x = -kMargin; x < width + kMargin; ++x) {
            float* out = padded.at(x + kMargin, y + kMargin);
            if (row == y && x >= 0 && x < width)
                std::copy_n(image.at(x, y), image.channels(), out);
            else
                interpolate_round(image, row, x + turn, period, out);
        }
    }
    return padded;
}

// On the grid of edges the first and last row are one direction each.
void make_pole_rows_even(Image& image) {
    for (const int y : {0, image.height() - 1})
        for (int c = 0; c < image.channels(); ++c) {
            double sum = 0;  // the last column is the first again
            for (int x = 0; x < image.width() - 1; ++x) sum += image.at(x, y)[c];
            for (int x = 0; x < image.width(); ++x)
                image.at(x, y)[c] = static_cast<float>(sum / (image.width() - 1));
        }
}

}  // namespace

std::vector<Image> cube_from_edge_grid(const std::vector<Image>& faces) {
    return change_cube_grid(faces, Grid::edges);
}

std::vector<Image> cube_to_edge_grid(const std::vector<Image>& faces) {
    return change_cube_grid(faces, Grid::centres);
}

Image equirect_from_edge_grid(const Image& image) {
    if (image.height() == 1) return image;
    return change_grid(pad_equirect(image, Grid::edges), Grid::edges);
}

Image equirect_to_edge_grid(const Image& image) {
    if (image.height() == 1) return image;
    Image result = change_grid(pad_equirect(image, Grid::centres), Grid::centres);
    make_pole_rows_even(result);
    return result;
}

}  // namespace mirrorball::detail
