#include "lobe_taps.h"

#include <algorithm>
#include <cmath>

#include <mirrorball/vector.h>

namespace mirrorball::gl {
namespace {

// The standard deviation of what a lookup sees, in texels of its level: 1/4 of the square is from
// halving again and again with (1 3 3 1) / 8, 1/6 from bilinear filtering. Of level 0 the second.
constexpr double kSpotInTexels = 0.645, kFinestSpotInTexels = 0.41;

// Spots are not finer than the lobe's core is; not so wide that they need levels of few texels, on
// which a cube's corners show; and in between grow with the distance from the axis. All in radians,
// or next to the angle that holds a quarter of the lobe.
constexpr double kFinestSpotInCores = 0.4, kWidestSpot = 0.14, kSpotInRadii = 0.4;
constexpr double kWidestCore = 0.3, kLastRing = 1.5;
// How far apart, in spots.
constexpr double kInnerRing = 0.7, kFirstRing = 1.7, kBetweenRings = 1.3, kAlongRing = 1.8;
constexpr int kFewestTaps = 8;

// Spots all around the axis at one angle to it.
struct Ring {
    double angle, spot;
    int tap_count;
};

std::vector<Ring> rings_for(const Lobe& lobe, double finest_spot) {
    const double core = std::min(lobe.angle_holding(0.25), kWidestCore);
    const double finest = std::max(finest_spot, std::min(kFinestSpotInCores * core, kWidestSpot));
    const double last = std::min(kLastRing, lobe.angle_holding(0.999));
    // Four next to the axis instead of one on it: how a level's texels lie matters less.
    std::vector<Ring> rings = {{kInnerRing * finest, finest, 4}};
    double angle = kFirstRing * finest;
    while (angle < last) {
        const double spot = std::max(finest, std::min(kSpotInRadii * std::sin(angle), kWidestSpot));
        const double tap_count = std::ceil(2 * kPi * std::sin(angle) / (kAlongRing * spot));
        rings.push_back({angle, spot, std::max(kFewestTaps, static_cast<int>(tap_count))});
        angle += kBetweenRings * spot;
    }
    return rings;
}

// A ring's weight per steradian at an angle to the axis: of Gaussians on the sphere (von Mises and
// Fisher's), the mean around the ring.
double value(const Ring& ring, double angle) {
    const double sharpness = 1 / (ring.spot * ring.spot);
    const double scale = sharpness / (2 * kPi * (1 - std::exp(-2 * sharpness)));
    constexpr int kStepCount = 16;
    double sum = 0;
    for (int i = 0; i < kStepCount; ++i) {
        const double around = kPi * (i + 0.5) / kStepCount;
        const double cosine = std::cos(angle) * std::cos(ring.angle) +
                              std::sin(angle) * std::sin(ring.angle) * std::cos(around);
        sum += std::exp(sharpness * (cosine - 1));
    }
    return scale * sum / kStepCount;
}

// The least squares w >= 0 of |A w - b|, one unknown at a time until none moves.
std::vector<double> non_negative_least_squares(const std::vector<std::vector<double>>& a,
                                               const std::vector<double>& b) {
    const std::size_t count = a.front().size();
    std::vector<std::vector<double>> gram(count, std::vector<double>(count, 0));
    std::vector<double> right(count, 0), w(count, 0);
    for (std::size_t row = 0; row < a.size(); ++row) {
        for (std::size_t i = 0; i < count; ++i) {
            right[i] += a[row][i] * b[row];
            for (std::size_t j = 0; j < count; ++j) gram[i][j] += a[row][i] * a[row][j];
        }
    }
    constexpr int kSweepCount = 3000;
    for (int sweep = 0; sweep < kSweepCount; ++sweep) {
        for (std::size_t i = 0; i < count; ++i) {
            if (gram[i][i] == 0) continue;
            double rest = right[i];
            for (std::size_t j = 0; j < count; ++j) rest -= gram[i][j] * w[j];
            w[i] = std::max(0.0, w[i] + rest / gram[i][i]);
        }
    }
    return w;
}

// Pearson's chi-square, the integral of error^2 over the lobe itself: skirts of a highlight that
// hold much of its light matter as its middle does, until they are too faint to be seen.
std::vector<double> ring_weights(const Lobe& lobe, const std::vector<Ring>& rings) {
    constexpr int kAngleCount = 160;
    constexpr double kFaintest = 0.002;  // next to the brightest
    const double first = 0.2 * std::max(rings[0].spot, 1e-4);
    std::vector<double> angles, wanted;
    for (int i = 0; i < kAngleCount; ++i) {
        angles.push_back(first * std::pow(kPi / first, (i + 0.5) / kAngleCount));
        wanted.push_back(lobe.value(std::cos(angles.back())));
    }
    const double brightest = *std::max_element(wanted.begin(), wanted.end());
    std::vector<std::vector<double>> a;
    std::vector<double> b;
    for (std::size_t i = 0; i < angles.size(); ++i) {
        // angles are spaced evenly in their logarithm: dw = 2 pi angle sin(angle) d log(angle)
        const double importance =
            std::sqrt(angles[i] * std::sin(angles[i]) / (wanted[i] + kFaintest * brightest));
        std::vector<double> row;
        for (const Ring& ring : rings) row.push_back(importance * value(ring, angles[i]));
        a.push_back(std::move(row));
        b.push_back(importance * wanted[i]);
    }
    std::vector<double> weights = non_negative_least_squares(a, b);
    double sum = 0;
    for (const double weight : weights) sum += weight;
    for (double& weight : weights) weight *= lobe.integral() / sum;
    return weights;
}

}  // namespace

std::vector<Imath::V4f> lobe_taps(const Lobe& lobe, double source_texel) {
    const auto tap = [](double x, double y, double texel, double weight) {
        return Imath::V4f(Imath::V4d(x, y, std::log2(texel), weight));
    };
    if (lobe.is_delta() || lobe.angle_holding(0.75) < 0.25 * source_texel)
        return {tap(0, 0, source_texel, lobe.integral())};

    const std::vector<Ring> rings = rings_for(lobe, kFinestSpotInTexels * source_texel);
    const std::vector<double> weights = ring_weights(lobe, rings);
    std::vector<Imath::V4f> taps;
    for (std::size_t i = 0; i < rings.size(); ++i) {
        const Ring& ring = rings[i];
        if (weights[i] == 0) continue;
        const double texel = std::max(source_texel, ring.spot / kSpotInTexels);
        for (int j = 0; j < ring.tap_count; ++j) {
            // each ring's spots stand between those of the one inside it
            const double around = 2 * kPi * (j + 0.5 * static_cast<double>(i % 2)) / ring.tap_count;
            taps.push_back(tap(std::sin(ring.angle) * std::cos(around),
                               std::sin(ring.angle) * std::sin(around), texel,
                               weights[i] / ring.tap_count));
        }
    }
    return taps;
}

}  // namespace mirrorball::gl
