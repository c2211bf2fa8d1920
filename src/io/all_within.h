// A question that is asked of every value of every map that is read or written.
#pragma once

#include <cstdint>
#include <span>

#include "core/vectorized.h"

namespace mirrorball::detail {

/// Whether every value is within a range; NaN is in none. Looks at all of them, which for a vector
/// unit is quicker than to stop at the first that is not.
inline bool all_within(std::span<const float> values, float lowest, float largest) {
    std::uint32_t beyond = 0;
    vectorized([&]() MIRRORBALL_INLINE_BODY {
        const float least = lowest, most = largest;
        std::uint32_t found = 0;
        for (const float value : values)
            found |= static_cast<std::uint32_t>(!(value >= least)) |
                     static_cast<std::uint32_t>(!(value <= most));
        beyond = found;
    });
    return beyond == 0;
}

}  // namespace mirrorball::detail
