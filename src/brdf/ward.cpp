// Ward's model, as it was in 1992 and with bounded albedo.
#include <cmath>

#include "brdf/microfacets.h"
#include "brdf/model.h"

namespace mirrorball::detail {
namespace {

// Both forms are sampled as Ward proposed: half vectors by slope, which is Beckmann's distribution.
class WardModel : public ModelOf<Ward> {
  public:
    explicit WardModel(const Ward& parameters)
        : ModelOf(parameters),
          normals_{{p_.roughness_x * p_.roughness_x, p_.roughness_y * p_.roughness_y}} {}

    Vec3d evaluate(const Vec3d& wi, const Vec3d& wo) const override {
        const Vec3d sum = wi + wo;
        const double hz = sum.z / sum.length();
        const double area = kPi * normals_.slopes.alpha_x * normals_.slopes.alpha_y;
        const double scale = p_.form == Ward::Form::bounded
                                 ? 1 / (area * hz * hz * sum.z * sum.z)
                                 : 1 / (4 * area * std::sqrt(wi.z * wo.z));
        // the slope is the same of h and of the sum that h is along
        const double exponential = std::exp(-normals_.slopes.squared(sum));
        return exponential > 0 ? p_.reflectance * (scale * exponential) : Vec3d(0);
    }
    double density(const Vec3d& wi, const Vec3d& wo) const override {
        const Vec3d h = half_vector(wi, wo);
        return reflected_density(normals_.distribution(h) * h.z, wo, h);
    }
    Choice choose(const Vec3d& wo, const Vec3d& u) const override {
        return {reflected(wo, normals_.normal(u.x, u.y))};
    }

  private:
    Beckmann normals_;
};

}  // namespace

ModelPointer make_model(const Ward& parameters) {
    return std::make_shared<WardModel>(parameters);
}

}  // namespace mirrorball::detail
