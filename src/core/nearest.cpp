#include "core/nearest.h"

#include <algorithm>

namespace mirrorball::detail {
namespace {

// Edits (insertions, deletions, replacements, swaps of neighbours) that turn one word into the
// other.
int edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<int>> cost(a.size() + 1, std::vector<int>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) {
        for (std::size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                cost[i][j] = static_cast<int>(i + j);
                continue;
            }
            const int replace = cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, replace});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
            }
        }
    }
    return cost[a.size()][b.size()];
}

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
    std::string best;
    // A third of the word wrong is still a slip; more is another word.
    int best_distance = static_cast<int>(word.size()) / 3 + 1;
    for (const std::string& candidate : candidates) {
        const int distance = edit_distance(word, candidate);
        if (distance < best_distance || (best.empty() && distance == best_distance)) {
            best = candidate;
            best_distance = distance;
        }
    }
    // The beginning of one longer word: "dual" for "dual-paraboloid".
    if (best.empty() && word.size() >= 3) {
        const auto longer = std::find_if(candidates.begin(), candidates.end(), [&](const auto& c) {
            return c.compare(0, word.size(), word) == 0;
        });
        if (longer != candidates.end()) best = *longer;
    }
    return best;
}

}  // namespace mirrorball::detail
