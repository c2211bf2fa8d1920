// Distributions of microfacet normals and their shadowing, which several models share.
#pragma once

#include <algorithm>
#include <cmath>

#include "brdf/directions.h"

namespace mirrorball::detail {

/// Slopes stretched by alpha_x along x and alpha_y along y.
struct Slopes {
    double alpha_x, alpha_y;

    /// tan^2 of the angle to the normal over alpha^2 for this azimuth; h.z > 0.
    [[nodiscard]] double squared(const Vec3d& h) const {
        const double x = h.x / (alpha_x * h.z), y = h.y / (alpha_y * h.z);
        return x * x + y * y;
    }
    /// The length of a direction's tangential part, stretched: alpha tan(theta) w.z.
    [[nodiscard]] double spread(const Vec3d& w) const {
        return std::hypot(w.x * alpha_x, w.y * alpha_y);
    }
};

// Smith's Lambda comes times w.z, which keeps it finite at grazing angles.

/// Normally distributed slopes. Beckmann and Spizzichino 1963; Walter et al. 2007.
struct Beckmann {
    Slopes slopes;

    /// Per steradian; times h.z it integrates to 1.
    [[nodiscard]] double distribution(const Vec3d& h) const {
        if (h.z <= 0) return 0;
        const double z2 = h.z * h.z;
        const double exponential = std::exp(-slopes.squared(h));
        return exponential > 0 ? exponential / (kPi * slopes.alpha_x * slopes.alpha_y * z2 * z2)
                               : 0;
    }
    /// w.z Lambda(w), with a = w.z / spread: w.z (exp(-a^2) / (2 a sqrt(pi)) - erfc(a) / 2).
    [[nodiscard]] double lambda_z(const Vec3d& w) const {
        const double spread = slopes.spread(w);
        if (spread == 0) return 0;
        const double a = w.z / spread;
        return spread * std::exp(-a * a) / (2 * std::sqrt(kPi)) - w.z * std::erfc(a) / 2;
    }
    /// Of density D(h) h.z.
    [[nodiscard]] Vec3d normal(double u, double v) const {
        const double slope = std::sqrt(-std::log1p(-u));
        return Vec3d(slopes.alpha_x * slope * std::cos(2 * kPi * v),
                     slopes.alpha_y * slope * std::sin(2 * kPi * v), 1)
            .normalized();
    }
};

/// The distribution of normals of an ellipsoid. Trowbridge and Reitz 1975; Walter et al. 2007.
struct Ggx {
    Slopes slopes;

    [[nodiscard]] double distribution(const Vec3d& h) const {
        const double x = h.x / slopes.alpha_x, y = h.y / slopes.alpha_y;
        const double sum = x * x + y * y + h.z * h.z;
        return h.z > 0 ? 1 / (kPi * slopes.alpha_x * slopes.alpha_y * sum * sum) : 0;
    }
    /// w.z Lambda(w) = (sqrt(w.z^2 + spread^2) - w.z) / 2, without cancelling.
    [[nodiscard]] double lambda_z(const Vec3d& w) const {
        const double spread = slopes.spread(w);
        return spread * spread / (2 * (std::hypot(w.z, spread) + w.z));
    }
    /// Of the density of normals that wo sees, D(h) max(0, wo.h) / (wo.z (1 + Lambda(wo))): a
    /// hemisphere as seen from wo, stretched. Dupuy and Benyoub 2023, "Sampling Visible GGX Normals
    /// with Spherical Caps".
    [[nodiscard]] Vec3d visible_normal(const Vec3d& wo, double u, double v) const {
        const Vec3d view = Vec3d(slopes.alpha_x * wo.x, slopes.alpha_y * wo.y, wo.z).normalized();
        const Vec3d cap = spherical((1 - u) * (1 + view.z) - view.z, 2 * kPi * v);
        const Vec3d h = cap + view;
        return Vec3d(slopes.alpha_x * h.x, slopes.alpha_y * h.y, std::max(0.0, h.z)).normalized();
    }
    [[nodiscard]] double visible_density(const Vec3d& wo, const Vec3d& h) const {
        return distribution(h) * std::max(0.0, wo.dot(h)) / (wo.z + lambda_z(wo));
    }
};

}  // namespace mirrorball::detail
