// Environments that need no file: skies, a studio, and charts that show orientation and energy.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <mirrorball/environment_map.h>
#include <mirrorball/progress.h>

namespace mirrorball {

struct Builtin {
    std::string name, description;
};
[[nodiscard]] std::vector<Builtin> builtins();

/// Draws a built-in environment straight into the projection asked for. Texels are means over their
/// solid angle, lights smaller than a texel included: the flux does not depend on the size.
/// \throws Error(Errc::usage) naming the built-ins there are
[[nodiscard]] EnvironmentMap make_builtin(std::string_view name, Projection projection, int size,
                                          const Axes& axes, const Progress& progress = {});

}  // namespace mirrorball
