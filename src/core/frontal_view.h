// A ball of radius 1 about the origin as an eye on +z sees it that looks ahead, at -z: what a
// report's viewer shows first, and the still picture that stands there until it does.
#pragma once

namespace mirrorball::detail {

inline constexpr double kFrontalDistance = 4.4;
inline constexpr double kFrontalField = 0.6;  ///< vertical, radians: the ball fills 3/4 of it

}  // namespace mirrorball::detail
