// The truth that faster ways are measured against: every source texel, in double precision.
#include <mirrorball/prefilter.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <mirrorball/resample.h>

#include "core/parallel.h"
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
    const int width = source.width(), height = source.height();
    const std::vector<double> solid_angles = solid_angle_table(source.projection, width, height);
    std::vector<SourceTexel> texels;
    visit(source.projection, [&](auto p) {
        using P = decltype(p);
        for (int face = 0; face < P::face_count; ++face) {
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    const double solid_angle = solid_angles[static_cast<std::size_t>(y) * width + x];
                    if (solid_angle == 0) continue;
                    const FacePoint<double> centre{face, (x + 0.5) / width, (y + 0.5) / height};
                    texels.push_back({source.axes.to_world(P::direction(centre)), solid_angle,
                                      Vec3d(source.levels[0].faces[face].rgb(x, y))});
                }
            }
        }
    });
    return texels;
}

// Where no texel is within the lobe's reach (an exponent in the millions), the nearest one is all
// that the lobe could see.
const SourceTexel& nearest(const std::vector<SourceTexel>& texels, const Vec3d& axis) {
    return *std::max_element(texels.begin(), texels.end(),
                             [&](const SourceTexel& a, const SourceTexel& b) {
                                 return a.direction.dot(axis) < b.direction.dot(axis);
                             });
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
    if (weights < std::numeric_limits<double>::min()) return nearest(texels, axis).radiance * integral;
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
        [&](const Vec3d& axis) {
            return filtered(texels, kernel, target.lobe.integral(), axis);
        },
        progress);
}

}  // namespace mirrorball
