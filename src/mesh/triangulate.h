// Polygons cut into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <mirrorball/vector.h>

namespace mirrorball::detail {

/// A polygon of more corners that is not convex is too much work: its cost is their square.
inline constexpr std::size_t kMostConcaveCorners = 1024;

/// Corners of triangles that cover a polygon which is nearly flat and does not cross itself; one
/// that does is covered somehow. Empty for a concave polygon of more than kMostConcaveCorners.
/// \pre at least 3 corners
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Vec3f> corners);

}  // namespace mirrorball::detail
