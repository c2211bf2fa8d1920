#include "prefilter/near_pass.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"

namespace mirrorball::detail {
namespace {

constexpr int kLongestEdge = 16;  // of a tile, in texels

// Tiles small enough to be out of reach of most lights, and large enough to fill vectors.
int tile_edge(int size) {
    return size <= 32 ? 4 : size <= 64 ? 8 : kLongestEdge;
}

struct Block {
    int face, x0, x1, y0, y1;
};

// Directions and sums of a tile's texels, one array per component.
struct TileBuffer {
    static constexpr std::size_t kCount = kLongestEdge * kLongestEdge;
    std::array<float, kCount> x, y, z, r, g, b, weight;
    std::size_t count = 0;

    NearTile tile(bool weighted) {
        const auto part = [this](std::array<float, kCount>& a) {
            return std::span<float>(a).first(count);
        };
        return {part(x),
                part(y),
                part(z),
                part(r),
                part(g),
                part(b),
                weighted ? part(weight) : std::span<float>()};
    }
};

template <class P>
Vec3f direction_of(P, const EnvironmentMap& map, int face, double x, double y) {
    return Vec3f(map.axes.to_world(
        P::direction(FacePoint<double>{face, x / map.width(), y / map.height()})));
}

// Might a light reach into a tile of a cube? Its corners are farthest from its middle.
template <class P>
bool reaches(P p, const NearField& field, const NearKernel& near, const EnvironmentMap& map,
             const Block& block) {
    const Vec3f centre =
        direction_of(p, map, block.face, (block.x0 + block.x1) / 2.0, (block.y0 + block.y1) / 2.0);
    float radius = 0;
    for (const int x : {block.x0, block.x1}) {
        for (const int y : {block.y0, block.y1})
            radius = std::max(radius, (direction_of(p, map, block.face, x, y) - centre).length());
    }
    return field.reaches(near, centre, radius);
}

struct Clamp {
    Vec3f lowest, highest;

    [[nodiscard]] Vec3f operator()(const Vec3f& v) const {
        return {std::clamp(v.x, lowest.x, highest.x), std::clamp(v.y, lowest.y, highest.y),
                std::clamp(v.z, lowest.z, highest.z)};
    }
};

void clamp_block(const Block& block, const Clamp& clamp, Image& image) {
    for (int y = block.y0; y < block.y1; ++y) {
        for (int x = block.x0; x < block.x1; ++x) image.set_rgb(x, y, clamp(image.rgb(x, y)));
    }
}

template <class P>
void fill(P p, const EnvironmentMap& map, const Block& block, const EnvironmentMap* far_weights,
          TileBuffer& buffer) {
    std::size_t i = 0;
    for (int y = block.y0; y < block.y1; ++y) {
        for (int x = block.x0; x < block.x1; ++x, ++i) {
            const Vec3f d = direction_of(p, map, block.face, x + 0.5, y + 0.5);
            const Vec3f rgb = map.levels[0].faces[block.face].rgb(x, y);
            buffer.x[i] = d.x, buffer.y[i] = d.y, buffer.z[i] = d.z;
            buffer.r[i] = rgb.x, buffer.g[i] = rgb.y, buffer.b[i] = rgb.z;
            buffer.weight[i] =
                far_weights != nullptr ? far_weights->levels[0].faces[block.face].at(x, y)[0] : 1;
        }
    }
    buffer.count = i;
}

void add(const NearField& field, const NearKernel& near, const EnvironmentMap* far_weights,
         float integral, const Clamp& clamp, EnvironmentMap& map, const Progress& progress) {
    const int width = map.width(), height = map.height();
    const int edge = tile_edge(height);
    const int across = (width + edge - 1) / edge, down = (height + edge - 1) / edge;
    visit(map.projection, [&](auto p) {
        using P = decltype(p);
        const std::vector<double> solid_angles =
            P::fills_square ? std::vector<double>()
                            : solid_angle_table(map.projection, width, height);
        parallel_for(
            std::int64_t{P::face_count} * down * across,
            [&](std::int64_t i) {
                const int face = static_cast<int>(i / (across * down));
                const int x = static_cast<int>(i % across) * edge;
                const int y = static_cast<int>(i / across % down) * edge;
                const Block block{face, x, std::min(x + edge, width), y,
                                  std::min(y + edge, height)};
                Image& image = map.levels[0].faces[face];
                constexpr bool is_cube = std::is_same_v<P, Cube>;
                if (is_cube && far_weights == nullptr && !reaches(p, field, near, map, block))
                    return clamp_block(block, clamp, image);
                TileBuffer buffer;
                fill(p, map, block, far_weights, buffer);
                field.add(near, buffer.tile(far_weights != nullptr));
                std::size_t k = 0;
                for (int row = block.y0; row < block.y1; ++row) {
                    for (int column = block.x0; column < block.x1; ++column, ++k) {
                        if (!P::fills_square &&
                            solid_angles[static_cast<std::size_t>(row) * width + column] == 0)
                            continue;
                        Vec3f rgb(buffer.r[k], buffer.g[k], buffer.b[k]);
                        if (far_weights != nullptr) rgb *= integral / buffer.weight[k];
                        image.set_rgb(column, row, clamp(rgb));
                    }
                }
            },
            progress);
    });
}

}  // namespace

void add_near(const NearField& field, const NearKernel& near, const Vec3f& lowest,
              const Vec3f& highest, EnvironmentMap& map, const Progress& progress) {
    add(field, near, nullptr, 1, {lowest, highest}, map, progress);
}

void add_near_normalised(const NearField& field, const NearKernel& near,
                         const EnvironmentMap& far_weights, double integral, const Vec3f& lowest,
                         const Vec3f& highest, EnvironmentMap& map, const Progress& progress) {
    add(field, near, &far_weights, static_cast<float>(integral), {lowest, highest}, map, progress);
}

}  // namespace mirrorball::detail
