// Diffuse surfaces: Lambert, and Oren and Nayar's rough one.
#include <algorithm>
#include <cmath>

#include "brdf/directions.h"
#include "brdf/model.h"

namespace mirrorball::detail {
namespace {

class LambertModel : public ModelOf<Lambert> {
  public:
    using ModelOf::ModelOf;

    Vec3d evaluate(const Vec3d&, const Vec3d&) const override { return p_.reflectance / kPi; }
    double density(const Vec3d& wi, const Vec3d&) const override { return cosine_density(wi); }
    Choice choose(const Vec3d&, const Vec3d& u) const override {
        return {cosine_direction(u.x, u.y)};
    }
};

// f = reflectance/pi (A + B max(0, cos(phi_i - phi_o)) sin(a) tan(b)), a the larger of the two
// angles to the normal and b the smaller.
class OrenNayarModel : public ModelOf<OrenNayar> {
  public:
    explicit OrenNayarModel(const OrenNayar& parameters) : ModelOf(parameters) {
        const double sigma = p_.sigma_degrees * kPi / 180, s2 = sigma * sigma;
        a_ = 1 - 0.5 * s2 / (s2 + 0.33);
        b_ = 0.45 * s2 / (s2 + 0.09);
    }

    Vec3d evaluate(const Vec3d& wi, const Vec3d& wo) const override {
        // sin(a) sin(b) cos(phi_i - phi_o) is the scalar product of the tangential parts, and
        // tan(b) = sin(b) / cos(b), cos(b) the larger cosine
        const double across = wi.x * wo.x + wi.y * wo.y;
        return p_.reflectance / kPi * (a_ + b_ * std::max(0.0, across) / std::max(wi.z, wo.z));
    }
    double density(const Vec3d& wi, const Vec3d&) const override { return cosine_density(wi); }
    Choice choose(const Vec3d&, const Vec3d& u) const override {
        return {cosine_direction(u.x, u.y)};
    }

  private:
    double a_, b_;
};

}  // namespace

ModelPointer make_model(const Lambert& parameters) {
    return std::make_shared<LambertModel>(parameters);
}

ModelPointer make_model(const OrenNayar& parameters) {
    return std::make_shared<OrenNayarModel>(parameters);
}

}  // namespace mirrorball::detail
