// Banks' fibres.
//
// A fibre along x mirrors a ray into a cone: wi.x = -wo.x, the angle about x being free. So with
// psi = asin(w.x) and gamma the angle about x away from the normal,
//
//     w = (sin psi, cos psi sin gamma, cos psi cos gamma),   dw = cos psi dpsi dgamma,
//
// the lobe is cos(delta)^N, delta = psi_i + psi_o, with gamma free.
#include <cmath>

#include "brdf/directions.h"
#include "brdf/model.h"

namespace mirrorball::detail {
namespace {

// integral of cos(x)^N from -pi/2 to pi/2
double cosine_power_integral(double exponent) {
    return std::sqrt(kPi) *
           std::exp(std::lgamma((exponent + 1) / 2) - std::lgamma(exponent / 2 + 1));
}

class BanksModel : public ModelOf<Banks> {
  public:
    explicit BanksModel(const Banks& parameters)
        : ModelOf(parameters),
          // At normal incidence the albedo is the integral of (1 - x^2)^(N/2) over the unit disc:
          // over chords, that of 2 (1 - x^2)^((N+1)/2), or 2 cos^(N+2) in the angle.
          scale_(1 / (2 * cosine_power_integral(p_.exponent + 2))),
          density_scale_(1 / cosine_power_integral(p_.exponent)) {}

    Vec3d evaluate(const Vec3d& wi, const Vec3d& wo) const override {
        const double cosine = cos_delta(wi, wo);
        if (cosine <= 0) return Vec3d(0);
        return p_.reflectance * (scale_ * std::pow(cosine, p_.exponent));
    }

    // delta by the lobe, gamma by its cosine. Where delta carries psi past the fibre's end, the
    // direction comes out below the surface, which tells it from the others.
    double density(const Vec3d& wi, const Vec3d& wo) const override {
        const double cos_psi = std::copysign(across(wi), wi.z);
        if (cos_psi == 0) return 0;
        const double cosine = cos_psi * across(wo) - wi.x * wo.x;
        if (cosine <= 0) return 0;
        const double cos_gamma = wi.z / cos_psi;
        return density_scale_ * std::pow(cosine, p_.exponent) * cos_gamma / 2 / std::abs(cos_psi);
    }
    Choice choose(const Vec3d& wo, const Vec3d& u) const override {
        // sin(delta) of density (1 - s^2)^((N-1)/2): one coordinate of a point in the disc of
        // density (1 - r^2)^(N/2 - 1)
        const double r =
            p_.exponent > 0 ? std::sqrt(-std::expm1(2 / p_.exponent * std::log1p(-u.x))) : 1;
        const double delta = std::asin(r * std::cos(2 * kPi * u.y));
        const double psi = delta - std::atan2(wo.x, across(wo));
        const double sin_gamma = 2 * u.z - 1, cos_gamma = std::sqrt(1 - sin_gamma * sin_gamma);
        return {{std::sin(psi), std::cos(psi) * sin_gamma, std::cos(psi) * cos_gamma}};
    }

  private:
    // cos(psi), for directions along the fibre as exact as for others
    static double across(const Vec3d& w) { return std::hypot(w.y, w.z); }
    static double cos_delta(const Vec3d& a, const Vec3d& b) {
        return across(a) * across(b) - a.x * b.x;
    }

    double scale_, density_scale_;
};

}  // namespace

ModelPointer make_model(const Banks& parameters) {
    return std::make_shared<BanksModel>(parameters);
}

}  // namespace mirrorball::detail
