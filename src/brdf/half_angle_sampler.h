// Sampling for BRDFs that are known by their values only.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "brdf/directions.h"

namespace mirrorball::detail {

/// Half of the choices by the cosine, half by a table of how bright the BRDF is by the angle of the
/// half vector, its bins narrow near the normal where highlights are. Isotropic BRDFs only.
class HalfAngleSampler {
  public:
    /// \param value  f(wi, wo), any mean of its channels
    template <class F>
    explicit HalfAngleSampler(F&& value) {
        std::array<double, kBinCount> mass{};
        double total = 0;
        for (int bin = 0; bin < kBinCount; ++bin) {
            const double cosine = (edge(bin) + edge(bin + 1)) / 2;
            for (const double view : {0.95, 0.7, 0.4, 0.15}) {
                const Vec3d wo = spherical(view, 0);
                for (int i = 0; i < kAzimuthCount; ++i) {
                    const Vec3d h = spherical(cosine, kPi * (i + 0.5) / kAzimuthCount);
                    const Vec3d wi = reflected(wo, h);
                    // f wi.z dwi, dwi = 4 |wo.h| dh
                    if (wi.z > 0)
                        mass[bin] += value(wi, wo) * wi.z * std::abs(wo.dot(h)) * solid_angle(bin);
                }
            }
            total += mass[bin];
        }
        half_share_ = total > 0 ? 0.5 : 0;
        for (int bin = 0; bin < kBinCount; ++bin)
            sums_[bin + 1] = sums_[bin] + (total > 0 ? mass[bin] / total : 1.0 / kBinCount);
        sums_[kBinCount] = 1;
    }

    [[nodiscard]] double density(const Vec3d& wi, const Vec3d& wo) const {
        const Vec3d h = half_vector(wi, wo);
        const double scaled = std::sqrt(std::acos(std::min(h.z, 1.0)) * 2 / kPi) * kBinCount;
        const int bin = std::min(static_cast<int>(scaled), kBinCount - 1);
        const double by_half = (sums_[bin + 1] - sums_[bin]) / solid_angle(bin);
        return half_share_ * reflected_density(by_half, wo, h) +
               (1 - half_share_) * cosine_density(wi);
    }

    [[nodiscard]] Vec3d choose(const Vec3d& wo, const Vec3d& u) const {
        if (u.z >= half_share_) return cosine_direction(u.x, u.y);
        const auto after = std::upper_bound(sums_.begin() + 1, sums_.end() - 1, u.x);
        const int bin = static_cast<int>(after - sums_.begin()) - 1;
        const double mass = sums_[bin + 1] - sums_[bin];
        const double within = mass > 0 ? std::clamp((u.x - sums_[bin]) / mass, 0.0, 1.0) : 0.5;
        const double cosine = edge(bin) + (edge(bin + 1) - edge(bin)) * within;
        return reflected(wo, spherical(cosine, 2 * kPi * u.y));
    }

  private:
    static constexpr int kBinCount = 90, kAzimuthCount = 16;

    // The cosine at the start of a bin.
    static double edge(int bin) {
        const double x = static_cast<double>(bin) / kBinCount;
        return std::cos(x * x * kPi / 2);
    }
    static double solid_angle(int bin) { return 2 * kPi * (edge(bin) - edge(bin + 1)); }

    std::array<double, kBinCount + 1> sums_{};
    double half_share_;
};

}  // namespace mirrorball::detail
