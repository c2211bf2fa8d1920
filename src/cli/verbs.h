// The verbs, one file each. To add one: write NAME.cpp by the example of its neighbours, declare it
// here and add it to the list in main.cpp.
#pragma once

#include "command.h"
#include "options.h"

namespace mirrorball::cli {

/// Fresh command with its options at their defaults; `shared` is where the options of every verb
/// go.
[[nodiscard]] Command info_command(Shared& shared);
[[nodiscard]] Command convert_command(Shared& shared);
[[nodiscard]] Command prefilter_command(Shared& shared);
[[nodiscard]] Command bake_command(Shared& shared);
[[nodiscard]] Command irradiance_sh_command(Shared& shared);
[[nodiscard]] Command compare_command(Shared& shared);
[[nodiscard]] Command sky_command(Shared& shared);
[[nodiscard]] Command serve_command(Shared& shared);
[[nodiscard]] Command bump_command(Shared& shared);
[[nodiscard]] Command projections_command(Shared& shared);
[[nodiscard]] Command brdf_command(Shared& shared);
[[nodiscard]] Command fresnel_command(Shared& shared);
[[nodiscard]] Command dfg_command(Shared& shared);
[[nodiscard]] Command view_stack_command(Shared& shared);
[[nodiscard]] Command render_command(Shared& shared);
[[nodiscard]] Command view_command(Shared& shared);
[[nodiscard]] Command compare_methods_command(Shared& shared);
/// The script for the shell, from the table of all commands.
[[nodiscard]] Command completion_command(Shared& shared, const std::vector<Command>& commands);

}  // namespace mirrorball::cli
