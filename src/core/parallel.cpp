#include "core/parallel.h"

#include <atomic>
#include <mutex>

#include <mirrorball/error.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace mirrorball::detail {

void parallel_for(std::int64_t count, const std::function<void(std::int64_t)>& f,
                  const Progress& progress) {
    std::atomic<std::int64_t> done_count = 0;
    std::mutex mutex;
    std::int64_t reported = 0;
    const auto report = [&](std::int64_t done) {
        // whoever finds another thread reporting goes on with its work
        const std::unique_lock lock(mutex, std::try_to_lock);
        if (!lock || done <= reported) return;
        reported = done;
        if (!progress(static_cast<double>(done) / static_cast<double>(count)))
            throw Error(Errc::cancelled, "cancelled");
    };
    tbb::parallel_for(
        tbb::blocked_range<std::int64_t>(0, count),
        [&](const tbb::blocked_range<std::int64_t>& range) {
            for (std::int64_t i = range.begin(); i != range.end(); ++i) {
                f(i);
                if (progress) report(++done_count);
            }
        },
        tbb::simple_partitioner());
    // the last piece may have found another thread reporting
    if (progress) report(count);
}

}  // namespace mirrorball::detail
