// Where results go: what every verb that writes a map offers, and checks before it begins to work.
#pragma once

#include <string>

#include <mirrorball/io.h>

#include "command.h"

namespace mirrorball::cli {

/// --format and --layout.
void add_write_options(Command& command, MapWriteOptions& options);
/// --format where all results are .ktx2 files.
[[nodiscard]] Option ktx2_format_option(TexelFormat& format);
/// Help of -o: the endings that maps can be written to.
[[nodiscard]] std::string output_help();

/// \throws Error(Errc::usage) for an ending or a texel format that there is not
void check_format(const std::string& target, const MapWriteOptions& options);
/// Finds out what would fail at the end of long work: an ending or a texel format that there is
/// not, a folder that is not there. \throws Error(Errc::usage), Error(Errc::cannot_write)
void check_target(const std::string& target, const MapWriteOptions& options);
/// Whether the file that the name stands for can hold more than one level.
[[nodiscard]] bool holds_levels(const std::string& target);

}  // namespace mirrorball::cli
