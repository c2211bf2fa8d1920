// Loops over threads, with progress. The only place that knows about TBB, so that a build without
// threads needs no other change.
#pragma once

#include <cstdint>
#include <functional>

#include <mirrorball/progress.h>

namespace mirrorball::detail {

/// Calls f(i) for each i in [0, count), on as many threads as the caller's TBB arena has. Each i is
/// one piece of work (a row, a tile) that writes only what is its own, so results do not depend on
/// the threads. The first exception thrown by f is thrown on; so is Error(Errc::cancelled).
void parallel_for(std::int64_t count, const std::function<void(std::int64_t)>& f,
                  const Progress& progress = {});

}  // namespace mirrorball::detail
