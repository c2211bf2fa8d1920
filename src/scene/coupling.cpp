#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/scene.h>

namespace mirrorball {
namespace {

constexpr std::array<std::string_view, 3> kNames = {"added", "layered", "split-sum"};

}  // namespace

std::string_view name(Coupling coupling) {
    return kNames[static_cast<std::size_t>(coupling)];
}

Coupling parse_coupling(std::string_view name) {
    const auto found = std::find(kNames.begin(), kNames.end(), name);
    if (found == kNames.end()) {
        throw Error(Errc::usage, fmt::format("\"{}\" is not a coupling; there are: {}", name,
                                             fmt::join(kNames, ", ")));
    }
    return static_cast<Coupling>(found - kNames.begin());
}

}  // namespace mirrorball
