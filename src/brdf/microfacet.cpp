// Cook and Torrance's model with normals as Beckmann or GGX have them.
#include <cmath>
#include <type_traits>

#include "brdf/microfacets.h"
#include "brdf/model.h"

namespace mirrorball::detail {
namespace {

template <class Normals>
class MicrofacetModel : public ModelOf<Microfacet> {
  public:
    explicit MicrofacetModel(const Microfacet& parameters)
        : ModelOf(parameters),
          normals_{{alpha(p_.roughness_x), alpha(p_.roughness_y)}} {}

    Vec3d evaluate(const Vec3d& wi, const Vec3d& wo) const override {
        const Vec3d h = half_vector(wi, wo);
        // G / (wi.z wo.z) = 1 / (wi.z wo.z (1 + Lambda(wi) + Lambda(wo)))
        const double area =
            wi.z * wo.z + wo.z * normals_.lambda_z(wi) + wi.z * normals_.lambda_z(wo);
        const double d = normals_.distribution(h);
        return d > 0 ? p_.fresnel(wi.dot(h)) * (d / (4 * area)) : Vec3d(0);
    }
    double density(const Vec3d& wi, const Vec3d& wo) const override {
        const Vec3d h = half_vector(wi, wo);
        if constexpr (std::is_same_v<Normals, Ggx>)
            return reflected_density(normals_.visible_density(wo, h), wo, h);
        else
            return reflected_density(normals_.distribution(h) * h.z, wo, h);
    }
    Choice choose(const Vec3d& wo, const Vec3d& u) const override {
        if constexpr (std::is_same_v<Normals, Ggx>)
            return {reflected(wo, normals_.visible_normal(wo, u.x, u.y))};
        else
            return {reflected(wo, normals_.normal(u.x, u.y))};
    }

  private:
    static double alpha(double roughness) {
        const double least = std::max(roughness, kLeastRoughness);
        return least * least;
    }

    Normals normals_;
};

// Too smooth to be told from a mirror: one, under its own name.
class SmoothModel : public ModelOf<Microfacet> {
  public:
    explicit SmoothModel(const Microfacet& parameters)
        : ModelOf(parameters),
          mirror_(make_model(Mirror{p_.fresnel})) {}

    Vec3d evaluate(const Vec3d&, const Vec3d&) const override { return Vec3d(0); }
    double density(const Vec3d&, const Vec3d&) const override { return 0; }
    Choice choose(const Vec3d& wo, const Vec3d& u) const override { return mirror_->choose(wo, u); }
    Vec3d mirror_reflectance(const Vec3d& wo) const override {
        return mirror_->mirror_reflectance(wo);
    }

  private:
    ModelPointer mirror_;
};

}  // namespace

ModelPointer make_model(const Microfacet& parameters) {
    if (parameters.roughness_x < kLeastRoughness && parameters.roughness_y < kLeastRoughness)
        return std::make_shared<SmoothModel>(parameters);
    if (parameters.distribution == Microfacet::Distribution::ggx)
        return std::make_shared<MicrofacetModel<Ggx>>(parameters);
    return std::make_shared<MicrofacetModel<Beckmann>>(parameters);
}

}  // namespace mirrorball::detail
