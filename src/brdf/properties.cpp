// Laws measured.
//
// An integral of f(wi, wo) wi.z over wi is the mean of the sampler's weights over the unit cube.
// The points are a lattice, moved in eight ways: each is a quadrature of its own, without bias over
// the moves, so their scatter is an honest error (randomised quasi-Monte Carlo; Owen 1997), here
// with moves that are fixed.
#include <mirrorball/brdf_properties.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <mirrorball/error.h>

#include "brdf/directions.h"
#include "brdf/lattice.h"
#include "core/parallel.h"

namespace mirrorball {
namespace {

using detail::lattice_point;
using detail::lattice_point6;
using detail::lattice_shift;
using detail::spherical;

constexpr int kSetCount = 8, kLeastCount = 256, kMostCount = 1 << 24;

// The mean of f over sets of points, each of `count`.
template <class F>
Integral mean_of_sets(int count, F&& f) {
    std::array<Vec3d, kSetCount> means;
    Vec3d mean(0);
    for (int set = 0; set < kSetCount; ++set) {
        Vec3d sum(0);
        for (int i = 0; i < count; ++i) sum += f(set, i);
        means[set] = sum / count;
        mean += means[set] / kSetCount;
    }
    Vec3d square(0);
    for (const Vec3d& m : means) square += (m - mean) * (m - mean);
    const double worst = std::max({square.x, square.y, square.z});
    return {mean, std::sqrt(worst / (kSetCount * (kSetCount - 1)))};
}

// The mean of f over the cube.
template <class F>
Integral integrate_cube(int point_count, F&& f) {
    const int count = std::max(1, point_count / kSetCount);
    return mean_of_sets(count, [&](int set, int i) {
        return f(lattice_point(
            i, count, {lattice_shift(set, 0), lattice_shift(set, 1), lattice_shift(set, 2)}));
    });
}

// The share of light from wi that goes along samples drawn as if wi were the view: of a reciprocal
// model their weights, of others f with its directions the right way round.
Vec3d scattered(const Brdf& brdf, const Vec3d& wi, const Vec3d& u) {
    const Brdf::Sample sample = brdf.sample(wi, u);
    if (sample.is_delta) return sample.weight;
    const Vec3d& wo = sample.direction;
    const double density = brdf.density(wo, wi);
    return wo.z > 0 && density > 0 ? brdf.evaluate(wi, wo) * (wo.z / density) : Vec3d(0);
}

double largest(const Vec3d& colour) {
    return std::max({colour.x, colour.y, colour.z});
}

void check_count(const char* name, int count) {
    if (count < kLeastCount || count > kMostCount)
        throw Error(Errc::usage, fmt::format("{} is {}; expected {} to {}", name, count,
                                             kLeastCount, kMostCount));
}

// Angles of incidence, closer together towards grazing where albedos change; there are models that
// break down in the last tenth of a degree.
constexpr double kAngles[] = {0, 15, 30, 45, 60, 70, 75, 80, 85, 87.5, 89.5, 89.9, 89.999};
constexpr int kAngleCount = std::size(kAngles), kAzimuthCount = 4;

Vec3d incidence(int angle, int azimuth) {
    // not along the axes of an anisotropic model alone
    return spherical(std::cos(kAngles[angle] * kPi / 180), azimuth * kPi / 6);
}

const Integral& brighter(const Integral& a, const Integral& b) {
    return largest(b.value) > largest(a.value) ? b : a;
}

AlbedoPoint albedo_at(const Brdf& brdf, int angle, int point_count) {
    AlbedoPoint point{.theta = kAngles[angle] * kPi / 180, .albedo = {}, .furnace = {}};
    for (int azimuth = 0; azimuth < kAzimuthCount; ++azimuth) {
        const Vec3d w = incidence(angle, azimuth);
        point.albedo = brighter(point.albedo, directional_albedo(brdf, w, point_count));
        point.furnace = brighter(point.furnace, furnace_radiance(brdf, w, point_count));
    }
    return point;
}

// A pair of directions: each spread by the cosine, or wi by the model's sampling for wo.
struct Pair {
    Vec3d wi, wo;
    double turn;
};

Pair pair(const Brdf& brdf, int i, int count) {
    const auto u = lattice_point6(i, count);
    const Vec3d wo = detail::cosine_direction(u[0], u[1]);
    const bool by_model = i % 2 == 1;
    const Vec3d wi = by_model ? brdf.sample(wo, {u[2], u[3], u[4]}).direction
                              : detail::cosine_direction(u[2], u[3]);
    return {wi, wo, 2 * kPi * u[5]};
}

Vec3d turned(const Vec3d& w, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * w.x - s * w.y, s * w.x + c * w.y, w.z};
}

double relative_difference(const Vec3d& a, const Vec3d& b) {
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
        const double larger = std::max(std::abs(a[c]), std::abs(b[c]));
        // denormals have no digits left to compare
        if (larger > 1e-290) worst = std::max(worst, std::abs(a[c] - b[c]) / larger);
    }
    return worst;
}

void keep_larger(Violation& violation, double value, const Pair& at) {
    if (value <= violation.largest) return;
    violation.largest = value;
    violation.wi = at.wi;
    violation.wo = at.wo;
}

// What a stretch of the pairs shows.
struct Findings {
    Violation reciprocity, isotropy;
    double smallest = 0;
    int not_finite_count = 0;
};

Findings examine(const Brdf& brdf, int first, int last, int count) {
    Findings found;
    for (int i = first; i < last; ++i) {
        const Pair at = pair(brdf, i, count);
        if (at.wi.z <= 0 || at.wo.z <= 0) continue;
        const Vec3d f = brdf.evaluate(at.wi, at.wo), swapped = brdf.evaluate(at.wo, at.wi);
        const Vec3d turn = brdf.evaluate(turned(at.wi, at.turn), turned(at.wo, at.turn));
        for (int c = 0; c < 3; ++c) {
            if (!std::isfinite(f[c])) ++found.not_finite_count;
            found.smallest = std::min(found.smallest, f[c]);
        }
        keep_larger(found.reciprocity, relative_difference(f, swapped), at);
        keep_larger(found.isotropy, relative_difference(f, turn), at);
    }
    return found;
}

void join(Violation& all, const Violation& part) {
    if (part.largest > all.largest) all = part;
}

// In the order of the pairs, whatever the order in which they were examined.
void join(BrdfProperties& properties, const std::vector<Findings>& parts) {
    Violation first_reciprocity, first_isotropy;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        join(properties.reciprocity, parts[i].reciprocity);
        join(properties.isotropy, parts[i].isotropy);
        properties.smallest = std::min(properties.smallest, parts[i].smallest);
        properties.not_finite_count += parts[i].not_finite_count;
        if (i + 1 == parts.size() / 2) {
            first_reciprocity = properties.reciprocity;
            first_isotropy = properties.isotropy;
        }
    }
    properties.reciprocity.error = properties.reciprocity.largest - first_reciprocity.largest;
    properties.isotropy.error = properties.isotropy.largest - first_isotropy.largest;
}

}  // namespace

Integral directional_albedo(const Brdf& brdf, const Vec3d& wi, int point_count) {
    return integrate_cube(point_count, [&](const Vec3d& u) { return scattered(brdf, wi, u); });
}

Integral furnace_radiance(const Brdf& brdf, const Vec3d& wo, int point_count) {
    return integrate_cube(point_count, [&](const Vec3d& u) { return brdf.sample(wo, u).weight; });
}

Integral mean_albedo(const Brdf& brdf, int point_count) {
    const int count = std::max(1, point_count / kSetCount);
    return mean_of_sets(count, [&](int set, int i) {
        detail::SixNumbers shift;
        for (int d = 0; d < 6; ++d) shift[d] = lattice_shift(set, d);
        const auto u = lattice_point6(i, count, shift);
        return scattered(brdf, detail::cosine_direction(u[0], u[1]), {u[2], u[3], u[4]});
    });
}

const AlbedoPoint& BrdfProperties::brightest() const {
    return *std::max_element(albedo.begin(), albedo.end(), [](const auto& a, const auto& b) {
        return largest(a.albedo.value) < largest(b.albedo.value);
    });
}

bool BrdfProperties::conserves_energy() const {
    // an albedo of exactly 1 comes out on either side of it
    constexpr double kTolerance = 1e-5;
    return std::all_of(albedo.begin(), albedo.end(), [](const AlbedoPoint& point) {
        return largest(point.albedo.value) <= 1 + kTolerance + 3 * point.albedo.error;
    });
}

BrdfProperties measure_brdf(const Brdf& brdf, const BrdfCheckOptions& options,
                            const Progress& progress) {
    check_count("pair_count", options.pair_count);
    check_count("point_count", options.point_count);
    constexpr int kPartCount = 32;
    BrdfProperties properties;
    properties.albedo.resize(kAngleCount);
    std::vector<Findings> parts(kPartCount);
    // one piece of work per angle, one for the mean, one per part of the pairs
    detail::parallel_for(
        kAngleCount + 1 + kPartCount,
        [&](std::int64_t piece) {
            const int i = static_cast<int>(piece);
            if (i < kAngleCount) {
                properties.albedo[i] = albedo_at(brdf, i, options.point_count);
            } else if (i == kAngleCount) {
                properties.mean_albedo = mean_albedo(brdf, options.point_count);
            } else {
                const std::int64_t part = i - kAngleCount - 1, count = options.pair_count;
                parts[part] =
                    examine(brdf, static_cast<int>(count * part / kPartCount),
                            static_cast<int>(count * (part + 1) / kPartCount), options.pair_count);
            }
        },
        progress);
    join(properties, parts);
    return properties;
}

}  // namespace mirrorball
