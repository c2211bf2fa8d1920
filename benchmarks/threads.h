// How many threads a benchmark may use.
#pragma once

#include <tbb/global_control.h>

namespace mirrorball {

/// While one lives, work runs on this many threads at most.
class Threads {
  public:
    explicit Threads(int count)
        : limit_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count)) {}

  private:
    tbb::global_control limit_;
};

}  // namespace mirrorball
