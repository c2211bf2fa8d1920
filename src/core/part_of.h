// The progress of a part of some work, as that of the whole.
#pragma once

#include <mirrorball/progress.h>

namespace mirrorball::detail {

/// For work that begins at the share `from` of the whole and ends at `to`.
inline Progress part_of(const Progress& progress, double from, double to) {
    if (!progress) return {};
    return [=](double fraction) { return progress(from + (to - from) * fraction); };
}

}  // namespace mirrorball::detail
