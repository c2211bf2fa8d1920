// What is shared by all that is a mean over the triangles around a vertex: which vertices are one,
// and by how much a triangle counts.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include <mirrorball/vector.h>

namespace mirrorball::detail {

/// For each of the vertices 0 to count - 1 the first of those whose key is equal. Keys are ordered
/// and have no NaN.
template <class Key>
[[nodiscard]] std::vector<std::uint32_t> first_of_equals(std::size_t count, const Key& key) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto ka = key(a), kb = key(b);
        return ka != kb ? ka < kb : a < b;
    });
    std::vector<std::uint32_t> first(count);
    for (std::size_t i = 0; i < count; ++i) {
        const bool equal = i > 0 && key(order[i]) == key(order[i - 1]);
        first[order[i]] = equal ? first[order[i - 1]] : order[i];
    }
    return first;
}

/// 0 if either is 0.
[[nodiscard]] inline double angle_between(const Vec3d& a, const Vec3d& b) {
    return std::atan2(a.cross(b).length(), a.dot(b));
}

}  // namespace mirrorball::detail
