// Words that are nearly right.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mirrorball::detail {

/// The candidate that `word` is likely a slip or the beginning of; empty if there is none.
[[nodiscard]] std::string nearest(std::string_view word,
                                  const std::vector<std::string>& candidates);

}  // namespace mirrorball::detail
