// BRDFs as the command line names them.
#pragma once

#include <string>

#include <mirrorball/brdf.h>

#include "command.h"

namespace mirrorball::cli {

inline constexpr const char* kBrdfHelp =
    "a model with its parameters (ggx:roughness=0.3,metal=gold), a preset ('brushed gold') or a "
    "measured one (FILE.binary of MERL, or a table FILE.txt); mirrorball brdf --list shows all";

/// parse_brdf(), or a file that ends in .binary (MERL) or .txt (a table).
/// \throws Error as parse_brdf(), read_merl() and read_brdf_table() do
[[nodiscard]] Brdf read_brdf(const std::string& text);

/// Models, presets and files, for completion.
[[nodiscard]] Choices brdf_choices();

}  // namespace mirrorball::cli
