// parallel_for() where there is one thread.
#include <mirrorball/error.h>

#include "core/parallel.h"

namespace mirrorball::detail {

void parallel_for(std::int64_t count, const std::function<void(std::int64_t)>& f,
                  const Progress& progress) {
    for (std::int64_t i = 0; i < count; ++i) {
        f(i);
        const double share = static_cast<double>(i + 1) / static_cast<double>(count);
        if (progress && !progress(share)) throw Error(Errc::cancelled, "cancelled");
    }
}

}  // namespace mirrorball::detail
