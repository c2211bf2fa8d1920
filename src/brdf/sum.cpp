#include "brdf/sum.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "brdf/directions.h"
#include "brdf/lattice.h"
#include "brdf/parameters.h"

namespace mirrorball::detail {
namespace {

constexpr double kMostWeight = 1000;
// Of the choices: to all terms alike, so that none is missed where it alone is bright.
constexpr double kEvenShare = 0.1;

double mean(const Vec3d& colour) {
    return (colour.x + colour.y + colour.z) / 3;
}

// Roughly what a term reflects: enough to choose by.
double rough_albedo(const BrdfModel& model) {
    constexpr int kPointCount = 32;
    double sum = 0;
    for (const double cosine : {0.9, 0.6, 0.3}) {
        const Vec3d wo = spherical(cosine, 0.5);
        sum += mean(model.mirror_reflectance(wo));
        for (int i = 0; i < kPointCount; ++i) {
            const auto choice = model.choose(wo, lattice_point(i, kPointCount));
            const Vec3d& wi = choice.direction;
            if (choice.is_delta || wi.z <= 0) continue;
            const double density = model.density(wi, wo);
            if (density > 0) sum += mean(model.evaluate(wi, wo)) * wi.z / density / kPointCount;
        }
    }
    return sum / 3;
}

class SumModel : public BrdfModel {
  public:
    explicit SumModel(std::vector<SumTerm> terms) : terms_(std::move(terms)) {
        double total = 0;
        for (const SumTerm& term : terms_) {
            probabilities_.push_back(mean(term.weight) * rough_albedo(*term.model));
            total += probabilities_.back();
        }
        const double even = 1.0 / static_cast<double>(terms_.size());
        for (double& p : probabilities_)
            p = total > 0 ? kEvenShare * even + (1 - kEvenShare) * p / total : even;
    }

    [[nodiscard]] const std::vector<SumTerm>& terms() const { return terms_; }

    Vec3d evaluate(const Vec3d& wi, const Vec3d& wo) const override {
        Vec3d sum(0);
        for (const auto& [weight, model] : terms_) sum += weight * model->evaluate(wi, wo);
        return sum;
    }
    double density(const Vec3d& wi, const Vec3d& wo) const override {
        double sum = 0;
        for (std::size_t i = 0; i < terms_.size(); ++i)
            sum += probabilities_[i] * terms_[i].model->density(wi, wo);
        return sum;
    }
    Choice choose(const Vec3d& wo, const Vec3d& u) const override {
        std::size_t i = 0;
        double before = 0;
        while (i + 1 < terms_.size() && u.z >= before + probabilities_[i])
            before += probabilities_[i++];
        // what is left of u.z chooses within the term
        const double rest =
            std::clamp((u.z - before) / probabilities_[i], 0.0, std::nextafter(1.0, 0.0));
        Choice choice = terms_[i].model->choose(wo, {u.x, u.y, rest});
        choice.delta_weight *= terms_[i].weight / probabilities_[i];
        return choice;
    }
    Vec3d mirror_reflectance(const Vec3d& wo) const override {
        Vec3d sum(0);
        for (const auto& [weight, model] : terms_) sum += weight * model->mirror_reflectance(wo);
        return sum;
    }
    std::string text() const override {
        std::string text;
        for (const auto& [weight, model] : terms_) {
            if (!text.empty()) text += " + ";
            if (weight != Vec3d(1)) text += fmt::format("{}*", colour_text(weight));
            text += model->text();
        }
        return text;
    }

  private:
    std::vector<SumTerm> terms_;
    std::vector<double> probabilities_;
};

}  // namespace

std::vector<SumTerm> terms_of(const ModelPointer& model) {
    const auto* sum = dynamic_cast<const SumModel*>(model.get());
    return sum != nullptr ? sum->terms() : std::vector<SumTerm>{{Vec3d(1), model}};
}

ModelPointer make_sum(std::vector<SumTerm> terms) {
    for (const SumTerm& term : terms) {
        for (int c = 0; c < 3; ++c) check_parameter("weight", term.weight[c], 0, kMostWeight);
    }
    if (terms.size() == 1 && terms[0].weight == Vec3d(1)) return terms[0].model;
    return std::make_shared<SumModel>(std::move(terms));
}

}  // namespace mirrorball::detail
