// Colours that stand for numbers.
#pragma once

#include <mirrorball/vector.h>

namespace mirrorball::cli {

/// Black, violet, red, orange, white as t goes from 0 to 1; brightness rises all the way.
[[nodiscard]] Vec3f false_color(double t);

}  // namespace mirrorball::cli
