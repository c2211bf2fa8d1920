// NameTable: how the values of an enumeration are spelled.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include <mirrorball/error.h>

#include "core/nearest.h"

namespace mirrorball::detail {

/// Values count up from 0 in the order of the names.
template <class Value, std::size_t count>
struct NameTable {
    std::string_view what;  ///< one of them, with its article, for messages
    std::array<std::string_view, count> names;

    [[nodiscard]] std::string_view name(Value value) const {
        return names[static_cast<std::size_t>(value)];
    }
    /// \throws Error(Errc::usage)
    [[nodiscard]] Value parse(std::string_view name) const {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) fail(name);
        return static_cast<Value>(found - names.begin());
    }

  private:
    [[noreturn]] void fail(std::string_view name) const {
        const std::string near = nearest(name, {names.begin(), names.end()});
        throw Error(Errc::usage,
                    fmt::format("\"{}\" is not {}{}; there are: {}", name, what,
                                near.empty() ? "" : fmt::format(", did you mean \"{}\"?", near),
                                fmt::join(names, ", ")));
    }
};

}  // namespace mirrorball::detail
