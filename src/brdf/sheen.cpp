// Charlie: fibres that stand up from the surface.
#include <cmath>

#include "brdf/directions.h"
#include "brdf/model.h"

namespace mirrorball::detail {
namespace {

// Sampled uniformly, as its authors advise: half vectors by D would mostly send light below the
// horizon, and f wi.z is bounded.
class SheenModel : public ModelOf<Sheen> {
  public:
    explicit SheenModel(const Sheen& parameters)
        : ModelOf(parameters),
          sharpness_(1 / (p_.roughness * p_.roughness)) {}

    Vec3d evaluate(const Vec3d& wi, const Vec3d& wo) const override {
        const Vec3d h = half_vector(wi, wo);
        const double sine = std::hypot(h.x, h.y);
        const double d = (2 + sharpness_) * std::pow(sine, sharpness_) / (2 * kPi);
        const double v = 1 / (4 * (wi.z + wo.z - wi.z * wo.z));
        return p_.reflectance * (d * v);
    }
    double density(const Vec3d& wi, const Vec3d&) const override {
        return wi.z > 0 ? 1 / (2 * kPi) : 0;
    }
    Choice choose(const Vec3d&, const Vec3d& u) const override {
        return {spherical(1 - u.x, 2 * kPi * u.y)};
    }

  private:
    double sharpness_;  // 1/alpha
};

}  // namespace

ModelPointer make_model(const Sheen& parameters) {
    return std::make_shared<SheenModel>(parameters);
}

}  // namespace mirrorball::detail
