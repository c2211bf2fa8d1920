// A glossy layer over a diffuse base that gets what the layer lets through.
//
// The layer's directional albedo E is integrated once, when the model is made, at nodes that lie
// closer together towards grazing incidence, where it rises; straight lines between them. The mean
// albedo is that of the lines, so that with a white base the sum is off by no more than they are.
#include <algorithm>
#include <array>
#include <cmath>

#include "brdf/directions.h"
#include "brdf/lattice.h"
#include "brdf/model.h"

namespace mirrorball::detail {
namespace {

constexpr int kIntervalCount = 96, kPointCount = 2048;

class PlasticModel : public ModelOf<Plastic> {
  public:
    explicit PlasticModel(const Plastic& parameters)
        : ModelOf(parameters),
          layer_(make_model(Microfacet{
              .roughness_x = p_.roughness, .roughness_y = p_.roughness, .fresnel = p_.fresnel})) {
        for (int i = 0; i <= kIntervalCount; ++i) albedo_[i] = layer_albedo(node(i));
        Vec3d mean(0);
        for (int i = 0; i < kIntervalCount; ++i) {
            // 2 c times a line, integrated
            const double a = node(i), b = node(i + 1), h = b - a;
            mean += albedo_[i] * (h * (2 * a + b) / 3) + albedo_[i + 1] * (h * (a + 2 * b) / 3);
        }
        mean_ = mean;
    }

    Vec3d evaluate(const Vec3d& wi, const Vec3d& wo) const override {
        const Vec3d base = diffuse_coupling(albedo(wi.z), albedo(wo.z), mean_);
        return layer_->evaluate(wi, wo) + p_.reflectance * base / kPi;
    }
    double density(const Vec3d& wi, const Vec3d& wo) const override {
        const double share = base_share(wo);
        return (1 - share) * layer_->density(wi, wo) + share * cosine_density(wi);
    }
    Choice choose(const Vec3d& wo, const Vec3d& u) const override {
        const double share = base_share(wo);
        if (u.z < share) return {cosine_direction(u.x, u.y)};
        Choice choice = layer_->choose(wo, u);
        choice.delta_weight /= 1 - share;
        return choice;
    }
    Vec3d mirror_reflectance(const Vec3d& wo) const override {
        return layer_->mirror_reflectance(wo);
    }

  private:
    static double node(int i) {
        const double x = static_cast<double>(i) / kIntervalCount;
        return x * x;
    }

    [[nodiscard]] Vec3d layer_albedo(double cosine) const {
        if (cosine == 0) return p_.fresnel(0);
        const Vec3d wo = spherical(cosine, 0);
        Vec3d sum = layer_->mirror_reflectance(wo);
        for (int i = 0; i < kPointCount; ++i) {
            const Choice choice = layer_->choose(wo, lattice_point(i, kPointCount));
            const Vec3d& wi = choice.direction;
            if (choice.is_delta || wi.z <= 0) continue;
            const double density = layer_->density(wi, wo);
            if (density > 0) sum += layer_->evaluate(wi, wo) * (wi.z / density / kPointCount);
        }
        return sum;
    }

    [[nodiscard]] Vec3d albedo(double cosine) const {
        const double position = std::sqrt(std::min(cosine, 1.0)) * kIntervalCount;
        const int left = std::min(static_cast<int>(position), kIntervalCount - 1);
        const double share = (cosine - node(left)) / (node(left + 1) - node(left));
        return albedo_[left] * (1 - share) + albedo_[left + 1] * share;
    }

    // Of the choices: as much as the base reflects of the whole, seen from wo.
    [[nodiscard]] double base_share(const Vec3d& wo) const {
        const Vec3d layer = albedo(wo.z), base = p_.reflectance * (Vec3d(1) - layer);
        const double sum = base.x + base.y + base.z;
        return std::clamp(sum / (sum + layer.x + layer.y + layer.z), 0.1, 0.9);
    }

    ModelPointer layer_;
    std::array<Vec3d, kIntervalCount + 1> albedo_;
    Vec3d mean_;
};

}  // namespace

ModelPointer make_model(const Plastic& parameters) {
    return std::make_shared<PlasticModel>(parameters);
}

}  // namespace mirrorball::detail
