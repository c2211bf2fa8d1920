// Levels of bump maps as moments, and roughness from them.
//
// A level is averaged from the one before where both sides are even, since a texel is then exactly
// four of those; else from the first level by area, in which texels at a border have a share.
#include <algorithm>
#include <cmath>

#include <mirrorball/bump.h>

#include "bump/levels.h"
#include "core/parallel.h"

namespace mirrorball {
namespace {

BumpLevel first_level(const SlopeMap& map) {
    const Image& slopes = map.slopes;
    const int width = slopes.width(), height = slopes.height();
    BumpLevel level{slopes, Image(width, height, 3), normals(map).normals};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float du = slopes.at(x, y)[0], dv = slopes.at(x, y)[1];
            level.second.set_rgb(x, y, {du * du, dv * dv, du * dv});
        }
    return level;
}

// Texels first, first + 1, ... under one of the smaller level, and how much of each.
struct Share {
    int first = 0;
    std::vector<double> weights;  // they sum to 1
};

std::vector<Share> shares(int source_count, int count) {
    std::vector<Share> all(count);
    // In units of 1/count of a source texel everything is a whole number, and so exact.
    const std::int64_t size = source_count;
    for (std::int64_t i = 0; i < count; ++i) {
        const std::int64_t begin = i * size, end = begin + size;
        all[i].first = static_cast<int>(begin / count);
        for (std::int64_t j = begin / count; j * count < end; ++j) {
            const std::int64_t covered =
                std::min(end, (j + 1) * count) - std::max(begin, j * count);
            all[i].weights.push_back(static_cast<double>(covered) / static_cast<double>(size));
        }
    }
    return all;
}

Image averaged(const Image& source, const std::vector<Share>& columns,
               const std::vector<Share>& rows) {
    const int channels = source.channels();
    Image result(static_cast<int>(columns.size()), static_cast<int>(rows.size()), channels);
    detail::parallel_for(result.height(), [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < result.width(); ++x) {
            double sum[4] = {};
            for (std::size_t j = 0; j < rows[y].weights.size(); ++j)
                for (std::size_t i = 0; i < columns[x].weights.size(); ++i) {
                    const double weight = rows[y].weights[j] * columns[x].weights[i];
                    const float* texel = source.at(columns[x].first + static_cast<int>(i),
                                                   rows[y].first + static_cast<int>(j));
                    for (int c = 0; c < channels; ++c) sum[c] += weight * texel[c];
                }
            for (int c = 0; c < channels; ++c) result.at(x, y)[c] = static_cast<float>(sum[c]);
        }
    });
    return result;
}

// A moment less the product of means, where that is more than what rounding left of it.
double central(double second, double product, double scale) {
    constexpr double kRounding = 1.0 / (1 << 22);
    const double difference = second - product;
    return std::abs(difference) <= kRounding * scale ? 0 : difference;
}

}  // namespace

std::vector<Image> detail::area_levels(Image first) {
    int width = first.width(), height = first.height();
    std::vector<Image> levels;
    levels.push_back(std::move(first));
    while (width > 1 || height > 1) {
        const bool even = width % 2 == 0 && height % 2 == 0;
        const Image& source = even ? levels.back() : levels.front();
        width = std::max(1, width / 2);
        height = std::max(1, height / 2);
        levels.push_back(
            averaged(source, shares(source.width(), width), shares(source.height(), height)));
    }
    return levels;
}

std::vector<BumpLevel> bump_levels(const SlopeMap& map) {
    BumpLevel first = first_level(map);
    std::vector<Image> mean = detail::area_levels(std::move(first.mean)),
                       second = detail::area_levels(std::move(first.second)),
                       normal = detail::area_levels(std::move(first.normal));
    std::vector<BumpLevel> levels;
    for (std::size_t i = 0; i < mean.size(); ++i)
        levels.push_back({std::move(mean[i]), std::move(second[i]), std::move(normal[i])});
    return levels;
}

SlopeCovariance covariance(const BumpLevel& level, int x, int y) {
    const double du = level.mean.at(x, y)[0], dv = level.mean.at(x, y)[1];
    const float* second = level.second.at(x, y);
    SlopeCovariance result;
    result.du = std::max(0.0, central(second[0], du * du, second[0]));
    result.dv = std::max(0.0, central(second[1], dv * dv, second[1]));
    const double scale = std::sqrt(double{second[0]} * second[1]);
    const double largest = std::sqrt(result.du * result.dv);  // Cauchy and Schwarz
    result.both = std::clamp(central(second[2], du * dv, scale), -largest, largest);
    return result;
}

SlopeCovariance::Principal SlopeCovariance::principal() const {
    const double half_difference = (du - dv) / 2;
    const double radius = std::hypot(half_difference, both);
    return {mean() + radius, std::max(0.0, mean() - radius),
            radius > 0 ? std::atan2(both, half_difference) / 2 : 0};
}

double alpha_with_variance(double alpha, double variance) {
    return std::min(1.0, std::sqrt(alpha * alpha + 2 * std::max(0.0, variance)));
}

double alpha_with_mean_length(double alpha, double length) {
    length = std::clamp(length, 0.0, 1.0);
    // 1/N' = 1/N + (1 - length) / length, and alpha^2 = 2 / (N + 2): no division by an alpha of 0.
    const double square = alpha * alpha;
    const double inverse =
        length * square + (1 - length) * (2 - 2 * square);  // over N' = above / it
    const double above = length * (2 - 2 * square);
    const double denominator = above + 2 * inverse;
    return denominator > 0 ? std::min(1.0, std::sqrt(2 * inverse / denominator)) : 1;
}

}  // namespace mirrorball
