// Cosine lobes: Phong's in three forms, Blinn's about the half vector, Lafortune's generalised one.
#include <algorithm>
#include <cmath>

#include <mirrorball/error.h>

#include "brdf/directions.h"
#include "brdf/model.h"

namespace mirrorball::detail {
namespace {

class PhongModel : public ModelOf<Phong> {
  public:
    explicit PhongModel(const Phong& parameters) : ModelOf(parameters) {
        if (p_.form == Phong::Form::normalised) scale_ = (p_.exponent + 2) / (2 * kPi);
        if (p_.form == Phong::Form::lewis) scale_ = (p_.exponent + 1) / (2 * kPi);
    }

    Vec3d evaluate(const Vec3d& wi, const Vec3d& wo) const override {
        const double cosine = mirrored(wo).dot(wi);
        if (cosine <= 0) return Vec3d(0);
        const double lobe = scale_ * std::pow(cosine, p_.exponent);
        return p_.reflectance * (p_.form == Phong::Form::lewis ? lobe / wi.z : lobe);
    }
    double density(const Vec3d& wi, const Vec3d& wo) const override {
        return power_density(p_.exponent, mirrored(wo).dot(wi));
    }
    Choice choose(const Vec3d& wo, const Vec3d& u) const override {
        return {about(mirrored(wo), power_direction(p_.exponent, u.x, u.y))};
    }

  private:
    double scale_ = 1;
};

class BlinnPhongModel : public ModelOf<BlinnPhong> {
  public:
    explicit BlinnPhongModel(const BlinnPhong& parameters) : ModelOf(parameters) {
        // At normal incidence h is at half the angle. With u = cos^2(theta/2), from 1/2 to 1, and
        // n = N/2 + 1 the albedo is 4 pi times the integral of u^(N/2) (2u - 1) du:
        const double n = p_.exponent / 2 + 1, power = std::exp2(-n);
        scale_ = 1 / (4 * kPi * (2 * (1 - power / 2) / (n + 1) - (1 - power) / n));
    }

    Vec3d evaluate(const Vec3d& wi, const Vec3d& wo) const override {
        return p_.reflectance * (scale_ * std::pow(half_vector(wi, wo).z, p_.exponent));
    }
    double density(const Vec3d& wi, const Vec3d& wo) const override {
        const Vec3d h = half_vector(wi, wo);
        return reflected_density(power_density(p_.exponent, h.z), wo, h);
    }
    Choice choose(const Vec3d& wo, const Vec3d& u) const override {
        return {reflected(wo, power_direction(p_.exponent, u.x, u.y))};
    }

  private:
    double scale_;
};

class LafortuneModel : public ModelOf<Lafortune> {
  public:
    explicit LafortuneModel(const Lafortune& parameters) : ModelOf(parameters) {
        const Vec3d& k = p_.k;
        const double largest = std::max({std::abs(k.x), std::abs(k.y), std::abs(k.z)});
        if (largest == 0) throw Error(Errc::usage, "kx, ky and kz are all 0");
        unit_k_ = k / largest;
    }

    // |unit_k| <= 1 per axis, so the lobe's own axis q is no longer than 1: the factor that
    // normalises a cosine lobe about the normal bounds it everywhere.
    Vec3d evaluate(const Vec3d& wi, const Vec3d& wo) const override {
        const double cosine = (unit_k_ * wo).dot(wi);
        if (cosine <= 0) return Vec3d(0);
        return p_.reflectance * ((p_.exponent + 2) / (2 * kPi) * std::pow(cosine, p_.exponent));
    }
    double density(const Vec3d& wi, const Vec3d& wo) const override {
        return power_density(p_.exponent, axis(wo).dot(wi));
    }
    Choice choose(const Vec3d& wo, const Vec3d& u) const override {
        return {about(axis(wo), power_direction(p_.exponent, u.x, u.y))};
    }

  private:
    [[nodiscard]] Vec3d axis(const Vec3d& wo) const {
        const Vec3d q = unit_k_ * wo;
        const double length = q.length();
        return length > 0 ? q / length : Vec3d(0, 0, 1);
    }

    Vec3d unit_k_;
};

}  // namespace

ModelPointer make_model(const Phong& parameters) {
    return std::make_shared<PhongModel>(parameters);
}

ModelPointer make_model(const BlinnPhong& parameters) {
    return std::make_shared<BlinnPhongModel>(parameters);
}

ModelPointer make_model(const Lafortune& parameters) {
    return std::make_shared<LafortuneModel>(parameters);
}

}  // namespace mirrorball::detail
