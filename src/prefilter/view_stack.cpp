#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/view_lobe.h>

#include "brdf/directions.h"
#include "brdf/lattice.h"
#include "core/parallel.h"
#include "image/for_each_texel.h"
#include "prefilter/lobe_kernel.h"

namespace mirrorball {
namespace {

using namespace detail;

constexpr int kMostLobes = 64;  // along either angle
constexpr double kLowest = 85 * kPi / 180;

Vec3d turned(const Vec3d& d, double azimuth) {
    const double c = std::cos(azimuth), s = std::sin(azimuth);
    return {c * d.x - s * d.y, s * d.x + c * d.y, d.z};
}

// The place of x among evenly spaced nodes: the node before it, and how far it is to the next.
struct Between {
    int before;
    double share;
};

Between between(double position, int last) {
    const double clamped = std::clamp(position, 0.0, static_cast<double>(last));
    const int before = std::clamp(static_cast<int>(clamped), 0, std::max(last - 1, 0));
    return {before, clamped - before};
}

// Any surface and view, by six numbers in [0, 1).
struct Scene {
    Axes frame;
    Vec3d view;  // in the world

    explicit Scene(const SixNumbers& u) {
        const Vec3d normal = spherical(1 - 2 * u[0], 2 * kPi * u[1]);
        const Vec3d tangent = about(normal, spherical(0, 2 * kPi * u[2]));
        frame = {tangent, normal.cross(tangent), normal};
        view = frame.to_world(spherical(1 - (1 - std::cos(kLowest)) * u[3], 2 * kPi * u[4]));
    }
};

}  // namespace

ViewStack::ViewStack(const Brdf& brdf, int elevation_count, int azimuth_count,
                     const Progress& progress)
    : elevation_count_(elevation_count),
      azimuth_count_(azimuth_count) {
    const auto check = [](int count, const char* what) {
        if (count < 1 || count > kMostLobes) {
            throw Error(Errc::usage, fmt::format("{} {} of views were asked for; there can be 1 to "
                                                 "{}",
                                                 count, what, kMostLobes));
        }
    };
    check(elevation_count, "elevations");
    check(azimuth_count, "azimuths");
    lobes_.resize(static_cast<std::size_t>(elevation_count) * azimuth_count);
    parallel_for(
        static_cast<std::int64_t>(lobes_.size()),
        [&](std::int64_t i) {
            const double theta = elevation(static_cast<int>(i) / azimuth_count_);
            const double phi = azimuth(static_cast<int>(i) % azimuth_count_);
            const Vec3d in_plane(std::sin(theta), 0, std::cos(theta));
            lobes_[i] = fit_view_lobe(brdf, turned(in_plane, phi));
        },
        progress);
}

double ViewStack::elevation(int i) const {
    return elevation_count_ > 1 ? kLowest * i / (elevation_count_ - 1) : 0;
}

double ViewStack::azimuth(int j) const {
    return 2 * kPi * j / azimuth_count_;
}

ViewStack::Lookup ViewStack::look_up(const Vec3d& wo) const {
    const double theta = std::acos(std::clamp(wo.z, -1.0, 1.0));
    const double phi = std::atan2(wo.y, wo.x) + (wo.y < 0 ? 2 * kPi : 0);
    const int last = elevation_count_ - 1;
    const Between row = between(theta / kLowest * last, last);
    const double turns = phi / (2 * kPi) * azimuth_count_;
    const int column = static_cast<int>(turns) % azimuth_count_;
    const double across = azimuth_count_ > 1 ? turns - std::floor(turns) : 0;
    Lookup lookup;
    Vec3d axis(0);
    for (int k = 0; k < 4; ++k) {
        const int i = std::min(row.before + k / 2, last), j = (column + k % 2) % azimuth_count_;
        const double weight =
            (k / 2 == 0 ? 1 - row.share : row.share) * (k % 2 == 0 ? 1 - across : across);
        lookup.layers[k] = i * azimuth_count_ + j;
        lookup.weights[k] = weight;
        axis += turned(lobes_[lookup.layers[k]].axis, phi - azimuth(j)) * weight;
    }
    lookup.axis = axis.normalized();
    return lookup;
}

Vec3d reflected_radiance(const EnvironmentMap& map, const Brdf& brdf, const Axes& frame,
                         const Vec3d& view) {
    const Vec3d wo = frame.to_map(view);
    Vec3d sum(0);
    for_each_direction(map, 0, [&](const Vec3d& d, const Vec3f& radiance, double solid_angle) {
        const Vec3d wi = frame.to_map(d);
        if (wi.z > 0) sum += brdf.evaluate(wi, wo) * Vec3d(radiance) * (wi.z * solid_angle);
    });
    return sum;
}

Vec3d reflected_radiance(const EnvironmentMap& map, const ViewStack& stack, const Axes& frame,
                         const Vec3d& view) {
    const ViewStack::Lookup lookup = stack.look_up(frame.to_map(view));
    const Vec3d axis = frame.to_world(lookup.axis);
    Vec3d result(0);
    for (int k = 0; k < 4; ++k) {
        const ViewLobe& layer = stack.lobes()[lookup.layers[k]];
        if (lookup.weights[k] == 0 || layer.lobe.is_delta()) continue;
        const LobeKernel kernel(layer.lobe);
        Vec3d sum(0);
        for_each_direction(map, 0, [&](const Vec3d& d, const Vec3f& radiance, double solid_angle) {
            sum += Vec3d(radiance) * (kernel(axis.dot(d)) * solid_angle);
        });
        result += sum * layer.albedo * lookup.weights[k];
    }
    return result;
}

double measure_fit(const EnvironmentMap& map, const Brdf& brdf, const ViewStack& stack, int count,
                   const Progress& progress) {
    struct Squares {
        double off = 0, all = 0;
    };
    std::vector<Squares> of_each(count);
    parallel_for(
        count,
        [&](std::int64_t i) {
            const Scene scene(lattice_point6(static_cast<int>(i), count));
            const Vec3d truth = reflected_radiance(map, brdf, scene.frame, scene.view);
            const Vec3d fitted = reflected_radiance(map, stack, scene.frame, scene.view);
            of_each[i] = {(fitted - truth).length2(), truth.length2()};
        },
        progress);
    Squares sum;
    for (const Squares& s : of_each) sum.off += s.off, sum.all += s.all;
    return sum.all > 0 ? std::sqrt(sum.off / sum.all) : 0;
}

}  // namespace mirrorball
