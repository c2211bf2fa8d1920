// Plans of prefiltering to the same targets, one per shape of the sources that come.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <mirrorball/prefilter.h>

namespace mirrorball::cli {

/// What a source takes while it is prefiltered, over what it holds: the plan makes a map of its
/// shape, and the transform needs about as much again.
inline constexpr std::uint64_t kSourceWork = 3;

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
