// What every BRDF model gives to Brdf: evaluation, density and sampling side by side.
#pragma once

#include <memory>
#include <string>

#include <mirrorball/brdf.h>

#include "brdf/parameters.h"

namespace mirrorball::detail {

/// Immutable. Brdf has checked that wo.z > 0, and for evaluate() that wi.z > 0.
class BrdfModel {
  public:
    virtual ~BrdfModel() = default;

    [[nodiscard]] virtual Vec3d evaluate(const Vec3d& wi, const Vec3d& wo) const = 0;
    /// Per steradian, over the whole sphere; without the share of deltas.
    [[nodiscard]] virtual double density(const Vec3d& wi, const Vec3d& wo) const = 0;

    /// A direction of that density, anywhere on the sphere; or, `delta`, the mirror direction, with
    /// what the mirror reflects over the probability with which it was chosen.
    struct Choice {
        Vec3d direction;
        bool is_delta = false;
        Vec3d delta_weight{0};
    };
    [[nodiscard]] virtual Choice choose(const Vec3d& wo, const Vec3d& u) const = 0;

    [[nodiscard]] virtual Vec3d mirror_reflectance(const Vec3d& wo) const {
        static_cast<void>(wo);
        return Vec3d(0);
    }

    /// As parse_brdf() reads it.
    [[nodiscard]] virtual std::string text() const = 0;
};

/// A model of checked parameters.
template <class Parameters>
class ModelOf : public BrdfModel {
  public:
    explicit ModelOf(const Parameters& parameters) : p_(parameters) { check_parameters(p_); }
    [[nodiscard]] std::string text() const override { return model_text(p_); }

  protected:
    Parameters p_;
};

using ModelPointer = std::shared_ptr<const BrdfModel>;
[[nodiscard]] ModelPointer make_model(const Lambert& parameters);
[[nodiscard]] ModelPointer make_model(const OrenNayar& parameters);
[[nodiscard]] ModelPointer make_model(const Phong& parameters);
[[nodiscard]] ModelPointer make_model(const BlinnPhong& parameters);
[[nodiscard]] ModelPointer make_model(const Lafortune& parameters);
[[nodiscard]] ModelPointer make_model(const Ward& parameters);
[[nodiscard]] ModelPointer make_model(const Banks& parameters);
[[nodiscard]] ModelPointer make_model(const Microfacet& parameters);
[[nodiscard]] ModelPointer make_model(const Sheen& parameters);
[[nodiscard]] ModelPointer make_model(const Mirror& parameters);
[[nodiscard]] ModelPointer make_model(const Plastic& parameters);

class InputFile;
[[nodiscard]] ModelPointer read_merl_model(InputFile& file);
[[nodiscard]] ModelPointer read_table_model(InputFile& file);

}  // namespace mirrorball::detail
