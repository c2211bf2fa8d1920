// The value type: what every model leaves to it is checked and divided here, once.
#include <mirrorball/brdf.h>

#include "brdf/directions.h"
#include "brdf/model.h"
#include "brdf/sum.h"

namespace mirrorball {

Brdf::Brdf() : Brdf(Lambert{Vec3d(0)}) {}
Brdf::Brdf(const Lambert& model) : model_(detail::make_model(model)) {}
Brdf::Brdf(const OrenNayar& model) : model_(detail::make_model(model)) {}
Brdf::Brdf(const Phong& model) : model_(detail::make_model(model)) {}
Brdf::Brdf(const BlinnPhong& model) : model_(detail::make_model(model)) {}
Brdf::Brdf(const Lafortune& model) : model_(detail::make_model(model)) {}
Brdf::Brdf(const Ward& model) : model_(detail::make_model(model)) {}
Brdf::Brdf(const Banks& model) : model_(detail::make_model(model)) {}
Brdf::Brdf(const Microfacet& model) : model_(detail::make_model(model)) {}
Brdf::Brdf(const Sheen& model) : model_(detail::make_model(model)) {}
Brdf::Brdf(const Mirror& model) : model_(detail::make_model(model)) {}
Brdf::Brdf(const Plastic& model) : model_(detail::make_model(model)) {}

Vec3d Brdf::evaluate(const Vec3d& wi, const Vec3d& wo) const {
    return wi.z > 0 && wo.z > 0 ? model_->evaluate(wi, wo) : Vec3d(0);
}

double Brdf::density(const Vec3d& wi, const Vec3d& wo) const {
    return wo.z > 0 ? model_->density(wi, wo) : 0;
}

Brdf::Sample Brdf::sample(const Vec3d& wo, const Vec3d& u) const {
    if (!(wo.z > 0)) return {};
    const auto choice = model_->choose(wo, u);
    if (choice.is_delta) return {choice.direction, choice.delta_weight, true};
    const Vec3d& wi = choice.direction;
    if (wi.z <= 0) return {wi, Vec3d(0)};
    // far out in a narrow lobe's tail f and its density both come to nothing
    const double density = model_->density(wi, wo);
    if (!(density > 0)) return {wi, Vec3d(0)};
    return {wi, model_->evaluate(wi, wo) * (wi.z / density)};
}

Vec3d Brdf::mirror_reflectance(const Vec3d& wo) const {
    return wo.z > 0 ? model_->mirror_reflectance(wo) : Vec3d(0);
}

Brdf operator+(const Brdf& a, const Brdf& b) {
    std::vector<detail::SumTerm> terms = detail::terms_of(a.model_);
    for (detail::SumTerm& term : detail::terms_of(b.model_)) terms.push_back(std::move(term));
    return Brdf(detail::make_sum(std::move(terms)));
}

Brdf operator*(const Vec3d& weight, const Brdf& brdf) {
    std::vector<detail::SumTerm> terms = detail::terms_of(brdf.model_);
    for (detail::SumTerm& term : terms) term.weight *= weight;
    return Brdf(detail::make_sum(std::move(terms)));
}

std::string to_string(const Brdf& brdf) {
    return brdf.model_->text();
}

bool operator==(const Brdf& a, const Brdf& b) {
    return a.model_ == b.model_ || a.model_->text() == b.model_->text();
}

}  // namespace mirrorball
