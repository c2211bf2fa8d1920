// DFG tables as files: which channel holds what, and the words that go with them.
#pragma once

#include <string>
#include <vector>

#include <mirrorball/dfg.h>
#include <mirrorball/io.h>

#include "command.h"

namespace mirrorball::cli {

/// `albedo` is scale + bias.
enum class DfgChannel { scale, bias, albedo, charlie };
[[nodiscard]] std::string name(DfgChannel channel);
[[nodiscard]] std::string names(const std::vector<DfgChannel>& channels);

/// "scale,bias" or a program's name: "gltf", "unreal", "filament". \throws Error(Errc::usage)
[[nodiscard]] std::vector<DfgChannel> parse_dfg_channels(const std::string& text);
[[nodiscard]] Choices dfg_channel_choices();

/// One channel is grey; of two, blue is left at 0, since two would be grey and alpha to most files.
[[nodiscard]] Image dfg_image(const DfgTable& table, const std::vector<DfgChannel>& channels);

/// What columns, rows and channels mean, for formats that hold metadata.
[[nodiscard]] Metadata dfg_metadata(const std::vector<DfgChannel>& channels);

/// A C header with the table as an array and a function that looks it up; its names begin with
/// `prefix`.
[[nodiscard]] std::string dfg_header(const DfgTable& table, const std::vector<DfgChannel>& channels,
                                     const std::string& prefix);

}  // namespace mirrorball::cli
