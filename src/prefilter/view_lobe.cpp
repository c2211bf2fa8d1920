// One view of a BRDF as a zonal lobe. About a given axis the best is the kernel's mean over each
// circle around it; the best axis is the one that leaves that mean the most energy. Circles are
// dense where the lobe is narrow: their angles are w sinh(a s) for even s.
#include <mirrorball/view_lobe.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "brdf/directions.h"
#include "brdf/lattice.h"

namespace mirrorball {
namespace {

using namespace detail;

constexpr int kSampleCount = 1024;

struct Resolution {
    int circles, points;
};
constexpr Resolution kSearch{64, 48}, kFinal{512, 192};

// A lobe narrower than this is resolved no further.
constexpr double kLeastWidth = 1e-4;

double sum_of(const Vec3d& v) {
    return v.x + v.y + v.z;
}

struct Kernel {
    const Brdf& brdf;
    Vec3d wo;

    Vec3d operator()(const Vec3d& wi) const {
        return wi.z > 0 ? brdf.evaluate(wi, wo) * wi.z : Vec3d(0);
    }
};

// Means over circles about an axis, with what each circle counts in integrals over the sphere.
struct Circles {
    std::vector<double> angles, shares;
    std::vector<Vec3d> means, squares;

    Circles(const Kernel& kernel, const Vec3d& axis, double width, const Resolution& resolution) {
        const double scale = std::asinh(kPi / width), step = 1.0 / (resolution.circles - 1);
        for (int i = 0; i < resolution.circles; ++i) {
            const bool last = i == resolution.circles - 1;
            const double angle = last ? kPi : width * std::sinh(scale * i * step);
            angles.push_back(angle);
            shares.push_back(2 * kPi * std::sin(angle) * width * scale *
                             std::cosh(scale * i * step) * step);
            Vec3d mean(0), square(0);
            // every other circle half a point on
            for (int k = 0; k < resolution.points; ++k) {
                const double azimuth = 2 * kPi * (k + i % 2 * 0.5) / resolution.points;
                const Vec3d value = kernel(about(axis, at_angle(angle, azimuth)));
                mean += value / resolution.points;
                square += value * value / resolution.points;
            }
            means.push_back(mean);
            squares.push_back(square);
        }
    }

    static Vec3d at_angle(double angle, double azimuth) {
        const double sine = std::sin(angle);
        return {sine * std::cos(azimuth), sine * std::sin(azimuth), std::cos(angle)};
    }

    // Of the zonal mean, all channels together.
    [[nodiscard]] double energy() const {
        double sum = 0;
        for (std::size_t i = 0; i < angles.size(); ++i)
            sum += shares[i] * sum_of(means[i]) * sum_of(means[i]);
        return sum;
    }

    [[nodiscard]] Vec3d integral() const {
        Vec3d sum(0);
        for (std::size_t i = 0; i < angles.size(); ++i) sum += means[i] * shares[i];
        return sum;
    }

    // Of what albedo * lobe is off by, relative.
    [[nodiscard]] double error(const Lobe& lobe, const Vec3d& albedo) const {
        double off = 0, all = 0;
        for (std::size_t i = 0; i < angles.size(); ++i) {
            const Vec3d fitted = albedo * lobe.value(std::cos(angles[i]));
            all += shares[i] * sum_of(squares[i]);
            off += shares[i] * sum_of(squares[i] - means[i] * fitted * 2.0 + fitted * fitted);
        }
        return all > 0 ? std::sqrt(std::max(0.0, off) / all) : 0;
    }
};

// Where the BRDF sends light to the view from, by its own samples.
struct Glow {
    std::vector<Vec3d> directions;
    std::vector<double> weights;
    double total = 0;

    explicit Glow(const Kernel& kernel) {
        for (int i = 0; i < kSampleCount; ++i) {
            const Brdf::Sample sample =
                kernel.brdf.sample(kernel.wo, lattice_point(i, kSampleCount));
            if (sample.is_delta || !(sample.direction.z > 0)) continue;
            directions.push_back(sample.direction);
            weights.push_back(sum_of(sample.weight));
            total += weights.back();
        }
    }

    [[nodiscard]] Vec3d centre() const {
        Vec3d sum(0);
        for (std::size_t i = 0; i < directions.size(); ++i) sum += directions[i] * weights[i];
        return sum.normalized();
    }
    [[nodiscard]] Vec3d peak(const Kernel& kernel) const {
        Vec3d best = directions.front();
        for (const Vec3d& d : directions)
            if (sum_of(kernel(d)) > sum_of(kernel(best))) best = d;
        return best;
    }
    // The angle about an axis that holds a quarter of it.
    [[nodiscard]] double width(const Vec3d& axis) const {
        std::vector<std::pair<double, double>> angles;
        for (std::size_t i = 0; i < directions.size(); ++i)
            angles.emplace_back(2 * std::asin(std::min(1.0, (directions[i] - axis).length() / 2)),
                                weights[i]);
        std::sort(angles.begin(), angles.end());
        double sum = 0;
        for (const auto& [angle, weight] : angles) {
            sum += weight;
            if (sum >= total / 4) return std::clamp(angle, kLeastWidth, 1.0);
        }
        return 1;
    }
};

struct Axis {
    Vec3d direction;
    double width, energy;
};

// From a first guess, downhill in ever smaller steps: to each side in the plane of the view and, if
// it is a sideways one, across it.
Axis climb(const Kernel& kernel, const Glow& glow, const Vec3d& start, bool in_plane) {
    Axis best{start, glow.width(start), 0};
    best.energy = Circles(kernel, start, best.width, kSearch).energy();
    const double least = best.width / 64;
    for (double step = best.width / 2; step > least;) {
        const Vec3d across = std::abs(best.direction.y) < 0.9 ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0);
        const Vec3d side = best.direction.cross(across).normalized();
        const Vec3d other = best.direction.cross(side);
        bool moved = false;
        for (const Vec3d& way : {side, -side, other, -other}) {
            if (in_plane && std::abs(way.dot(side)) < 0.5) continue;
            const Vec3d direction = (best.direction + way * std::tan(step)).normalized();
            const double energy = Circles(kernel, direction, best.width, kSearch).energy();
            if (energy <= best.energy) continue;
            best.direction = direction, best.energy = energy;
            moved = true;
            break;
        }
        if (!moved) step /= 2;
    }
    return best;
}

// Is the kernel its own mirror image in the plane of the view?
bool is_symmetric(const Kernel& kernel, const Glow& glow) {
    return std::all_of(glow.directions.begin(), glow.directions.end(), [&](const Vec3d& d) {
        const double a = sum_of(kernel(d)), b = sum_of(kernel({d.x, -d.y, d.z}));
        return std::abs(a - b) <= 1e-9 * std::max(a, b);
    });
}

Axis best_axis(const Kernel& kernel, const Glow& glow) {
    const bool in_plane = std::abs(kernel.wo.y) < 1e-12 && is_symmetric(kernel, glow);
    const auto in_the_plane = [&](Vec3d d) {
        if (in_plane) d.y = 0;
        return d.normalized();
    };
    Axis best{{0, 0, 1}, 1, -1};
    for (const Vec3d& guess : {glow.centre(), mirrored(kernel.wo), glow.peak(kernel)}) {
        const Axis axis = climb(kernel, glow, in_the_plane(guess), in_plane);
        if (axis.energy > best.energy * (1 + 1e-6)) best = axis;
    }
    return best;
}

std::string name_of(const Vec3d& wo) {
    const double polar = std::acos(std::min(1.0, wo.z)) * 180 / kPi;
    const double azimuth = std::atan2(wo.y, wo.x) * 180 / kPi;
    return std::abs(azimuth) < 1e-9 || polar < 1e-9
               ? fmt::format("brdf at {:.4g} degrees", polar)
               : fmt::format("brdf at {:.4g} and {:.4g} degrees", polar, azimuth);
}

}  // namespace

ViewLobe fit_view_lobe(const Brdf& brdf, const Vec3d& wo) {
    const Kernel kernel{brdf, wo};
    const Glow glow(kernel);
    ViewLobe result;
    result.view = wo;
    result.axis = mirrored(wo);
    result.mirror = brdf.mirror_reflectance(wo);
    if (!(glow.total > 0)) return result;
    const Axis axis = best_axis(kernel, glow);
    const Circles circles(kernel, axis.direction, axis.width, kFinal);
    std::vector<double> weights;
    for (const Vec3d& mean : circles.means) weights.push_back(std::max(0.0, sum_of(mean)));
    if (std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0; })) return result;
    result.axis = axis.direction;
    result.lobe = tabulated_lobe(name_of(wo), circles.angles, weights);
    result.albedo = circles.integral();
    result.fit_error = circles.error(result.lobe, result.albedo);
    return result;
}

}  // namespace mirrorball
