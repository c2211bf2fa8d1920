#include "plans.h"

namespace mirrorball::cli {
namespace {

// Each holds tables of about the size of its source.
constexpr std::size_t kMostPlans = 3;

}  // namespace

PrefilterPlan Plans::plan_for(const EnvironmentMap& source) {
    const MapShape shape = shape_of(source);
    for (const PrefilterPlan& plan : plans_)
        if (plan.source() == shape) return plan;
    if (plans_.size() == kMostPlans) plans_.erase(plans_.begin());
    return plans_.emplace_back(shape, targets_, options_);
}

}  // namespace mirrorball::cli
