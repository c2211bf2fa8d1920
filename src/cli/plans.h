// Plans of prefiltering to the same targets, one per shape of the sources that come.
#pragma once

#include <span>
#include <vector>

#include <mirrorball/prefilter.h>

namespace mirrorball::cli {

/// Makes a plan when a source of a new shape comes and keeps the last few, for sources of few
/// shapes in any order.
class Plans {
  public:
    Plans(std::vector<PrefilterTarget> targets, const PrefilterOptions& options)
        : targets_(std::move(targets)),
          options_(options) {}

    [[nodiscard]] PrefilterPlan plan_for(const EnvironmentMap& source);
    [[nodiscard]] std::span<const PrefilterTarget> targets() const { return targets_; }

  private:
    std::vector<PrefilterTarget> targets_;
    PrefilterOptions options_;
    std::vector<PrefilterPlan> plans_;  // the oldest first
};

}  // namespace mirrorball::cli
