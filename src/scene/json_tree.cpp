// nlohmann's parser does the reading; an iterator that tells how far it has come gives positions.
#include "scene/json_tree.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/error.h>

namespace mirrorball::detail {
namespace {

constexpr std::size_t kDeepest = 64;
constexpr std::size_t kMostValues = 1'000'000;

// Over characters; all copies move one mark.
class MarkedIterator {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    MarkedIterator(const char* at, const char*& mark) : at_(at), mark_(&mark) {}
    reference operator*() const { return *at_; }
    MarkedIterator& operator++() {
        *mark_ = ++at_;
        return *this;
    }
    MarkedIterator operator++(int) {
        MarkedIterator before = *this;
        ++*this;
        return before;
    }
    friend bool operator==(const MarkedIterator& a, const MarkedIterator& b) {
        return a.at_ == b.at_;
    }

  private:
    const char* at_;
    const char** mark_;
};

// Skips white space, comments, and the colon or comma between a value and what stood before it.
std::size_t start_of_value(std::string_view text, std::size_t i) {
    while (i < text.size()) {
        if (std::string_view(" \t\r\n:,").find(text[i]) != std::string_view::npos) {
            ++i;
        } else if (text.substr(i, 2) == "//") {
            i = std::min(text.find('\n', i), text.size());
        } else if (text.substr(i, 2) == "/*") {
            const std::size_t end = text.find("*/", i + 2);
            i = end == std::string_view::npos ? text.size() : end + 2;
        } else {
            break;
        }
    }
    return i;
}

// What nlohmann's parser calls. `fail` never returns.
template <class Fail>
class TreeBuilder {
  public:
    TreeBuilder(std::string_view text, const char*& mark, Fail fail)
        : text_(text),
          mark_(mark),
          fail_(std::move(fail)) {}

    JsonNode take() { return std::move(root_); }

    bool null() { return add(make(JsonNode::Kind::null)); }
    bool boolean(bool value) {
        JsonNode node = make(JsonNode::Kind::boolean);
        node.boolean = value;
        return add(std::move(node));
    }
    bool number_integer(std::int64_t value) { return add_number(static_cast<double>(value)); }
    bool number_unsigned(std::uint64_t value) { return add_number(static_cast<double>(value)); }
    bool number_float(double value, const std::string& /*text*/) { return add_number(value); }
    bool string(std::string& value) {
        JsonNode node = make(JsonNode::Kind::text);
        node.text = std::move(value);
        return add(std::move(node));
    }
    bool binary(std::vector<std::uint8_t>& /*value*/) { return false; }  // not in texts

    bool start_object(std::size_t /*count*/) { return open(JsonNode::Kind::object); }
    bool start_array(std::size_t /*count*/) { return open(JsonNode::Kind::array); }
    bool end_object() { return close(); }
    bool end_array() { return close(); }

    bool key(std::string& name) {
        JsonNode& object = open_.back();
        const std::size_t position = start_of_value(text_, end_);
        if (!keys_.back().insert(name).second) {
            fail_(position, fmt::format("the key \"{}\" is there twice", name));
        }
        object.keys.push_back(name);
        object.key_positions.push_back(position);
        end_ = here();
        return true;
    }

    bool parse_error(std::size_t position, const std::string& /*token*/,
                     const nlohmann::detail::exception& error) {
        // Without the library's own words on where and which, "[json...] parse error at ...: ".
        std::string what = error.what();
        if (const std::size_t bracket = what.find("] "); bracket != std::string::npos)
            what.erase(0, bracket + 2);
        if (what.rfind("parse error at ", 0) == 0) what.erase(0, what.find(": ") + 2);
        fail_(position > 0 ? position - 1 : 0, what);
        return false;
    }

  private:
    [[nodiscard]] std::size_t here() const {
        return static_cast<std::size_t>(mark_ - text_.data());
    }

    JsonNode make(JsonNode::Kind kind) {
        if (++count_ > kMostValues) fail_(here(), fmt::format("more than {} values", kMostValues));
        JsonNode node;
        node.kind = kind;
        node.position = start_of_value(text_, end_);
        return node;
    }

    bool add_number(double value) {
        JsonNode node = make(JsonNode::Kind::number);
        node.number = value;
        const std::size_t start = node.position;
        add(std::move(node));
        // To know where a number ends one has to read what comes after it.
        end_ = std::min(text_.find_first_not_of("0123456789+-.eE", start), text_.size());
        return true;
    }

    bool add(JsonNode node) {
        if (open_.empty())
            root_ = std::move(node);
        else
            open_.back().items.push_back(std::move(node));
        end_ = here();
        return true;
    }

    bool open(JsonNode::Kind kind) {
        if (open_.size() == kDeepest)
            fail_(here() - 1, fmt::format("more than {} brackets within each other", kDeepest));
        open_.push_back(make(kind));
        keys_.emplace_back();
        end_ = here();
        return true;
    }

    bool close() {
        JsonNode node = std::move(open_.back());
        open_.pop_back();
        keys_.pop_back();
        return add(std::move(node));
    }

    std::string_view text_;
    const char*& mark_;
    Fail fail_;
    JsonNode root_;
    std::vector<JsonNode> open_;
    std::vector<std::set<std::string>> keys_;  // of the open ones
    std::size_t count_ = 0;
    std::size_t end_ = 0;  // of what was read last
};

}  // namespace

JsonDocument::JsonDocument(std::string name, std::string_view text)
    : name_(std::move(name)),
      text_(text) {
    if (text_.substr(0, 3) == "\xEF\xBB\xBF") text_.remove_prefix(3);  // a byte order mark
    const char* mark = text_.data();
    TreeBuilder builder(
        text_, mark, [&](std::size_t position, const std::string& what) { fail(position, what); });
    nlohmann::json::sax_parse(MarkedIterator(text_.data(), mark),
                              MarkedIterator(text_.data() + text_.size(), mark), &builder,
                              nlohmann::json::input_format_t::json, true, true);
    root_ = builder.take();
}

void JsonDocument::fail(std::size_t position, const std::string& what) const {
    const std::string_view before = text_.substr(0, std::min(position, text_.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::string_view in_line = before.substr(before.rfind('\n') + 1);
    // UTF-8's bytes 10xxxxxx go on with a character.
    const auto column = 1 + std::count_if(in_line.begin(), in_line.end(), [](char c) {
                            return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
                        });
    throw Error(Errc::cannot_read, fmt::format("{}:{}:{}: {}", name_, line, column, what));
}

std::string quoted(const JsonNode& node) {
    switch (node.kind) {
        case JsonNode::Kind::null:
            return "null";
        case JsonNode::Kind::boolean:
            return node.boolean ? "true" : "false";
        case JsonNode::Kind::number:
            return fmt::format("{}", node.number);
        case JsonNode::Kind::text:
            return fmt::format("\"{}\"", node.text.substr(0, 80));
        case JsonNode::Kind::array:
            return fmt::format("an array of {}", node.items.size());
        case JsonNode::Kind::object:
            return "an object";
    }
    return {};
}

}  // namespace mirrorball::detail
