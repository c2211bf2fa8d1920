// The truth that faster ways are measured against: every source texel, in double precision.
#include <mirrorball/prefilter.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/for_each_texel.h"
#include "prefilter/lobe_kernel.h"
#include "prefilter/target.h"

namespace mirrorball {
namespace {

struct SourceTexel {
    Vec3d direction;  // in the world
    double solid_angle;
    Vec3d radiance;
};

std::vector<SourceTexel> used_texels(const EnvironmentMap& source) {
    std::vector<SourceTexel> texels;
    detail::for_each_direction(
        source, 0, [&](const Vec3d& direction, const Vec3f& radiance, double solid_angle) {
            texels.push_back({direction, solid_angle, Vec3d(radiance)});
        });
    return texels;
}

// Where no texel is within the lobe's reach (an exponent in the millions), the one nearest to where
// the lobe peaks is all that it could see.
const SourceTexel& nearest(const std::vector<SourceTexel>& texels, const Vec3d& axis,
                           double peak_cosine) {
    const auto distance = [&](const SourceTexel& texel) {
        return std::abs(texel.direction.dot(axis) - peak_cosine);
    };
    return *std::min_element(
        texels.begin(), texels.end(),
        [&](const SourceTexel& a, const SourceTexel& b) { return distance(a) < distance(b); });
}

Vec3d filtered(const std::vector<SourceTexel>& texels, const detail::LobeKernel& kernel,
               double integral, const Vec3d& axis) {
    Vec3d sum(0.0);
    double weights = 0;
    for (const SourceTexel& texel : texels) {
        // a dot product of unit vectors may round to above 1
        const double cosine = std::min(1.0, texel.direction.dot(axis));
        const double weight = kernel(cosine) * texel.solid_angle;
        sum += texel.radiance * weight;
        weights += weight;
    }
    if (weights < std::numeric_limits<double>::min())
        return nearest(texels, axis, kernel.peak_cosine()).radiance * integral;
    return sum * (integral / weights);
}

}  // namespace

EnvironmentMap prefilter_reference(const EnvironmentMap& source, const PrefilterTarget& target,
                                   const Progress& progress) {
    if (target.lobe.is_delta()) return detail::mirror_target(source, target, progress);
    const std::vector<SourceTexel> texels = used_texels(source);
    const detail::LobeKernel kernel(target.lobe);
    return detail::fill_target(
        target,
        [&](const Vec3d& axis) { return filtered(texels, kernel, target.lobe.integral(), axis); },
        progress);
}

}  // namespace mirrorball
