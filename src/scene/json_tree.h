// JSON that remembers where it stood, so that errors can point at it. Comments are allowed.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mirrorball::detail {

struct JsonNode {
    enum class Kind { null, boolean, number, text, array, object };

    Kind kind = Kind::null;
    std::size_t position = 0;  ///< of its first byte
    bool boolean = false;
    double number = 0;
    std::string text;
    std::vector<std::string> keys;  ///< of an object
    std::vector<std::size_t> key_positions;
    std::vector<JsonNode> items;  ///< of an array, or the values of an object
};

/// A text and its tree. Errors are Error(Errc::cannot_read), "NAME:LINE:COLUMN: WHAT".
class JsonDocument {
  public:
    /// \throws Error for what is no JSON, keys that are there twice, brackets deeper than 64, and
    /// more than a million values
    JsonDocument(std::string name, std::string_view text);

    [[nodiscard]] const JsonNode& root() const { return root_; }
    [[noreturn]] void fail(std::size_t position, const std::string& what) const;

  private:
    std::string name_;
    std::string_view text_;
    JsonNode root_;
};

/// A value as an error quotes it: `1.5`, `"red"`, `an array`.
[[nodiscard]] std::string quoted(const JsonNode& node);

}  // namespace mirrorball::detail
