// Vectors are Imath's; the names here only fix which of them the library uses.
#pragma once

#include <ImathVec.h>

namespace mirrorball {

template <class T>
using Vec3 = Imath::Vec3<T>;
using Vec3d = Imath::V3d;
using Vec3f = Imath::V3f;
using Vec2f = Imath::V2f;

inline constexpr double kPi = 3.14159265358979323846;

}  // namespace mirrorball
