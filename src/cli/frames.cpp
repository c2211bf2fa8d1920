#include "frames.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>

#include <mirrorball/error.h>

#include "command.h"

namespace mirrorball::cli {
namespace {

constexpr int kWidest = 20;

// A piece of a pattern: plain text, or what begins with a percent sign.
struct Piece {
    enum class Kind { text, number, unknown } kind;
    std::string_view spelling;  // "abc", "%04d", "%-s"
    std::string text = {};      // what a piece of text stands for
};

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// `rest` begins with a percent sign. Conversions of printf end with a letter, which makes the
// spelling of unknown ones.
Piece conversion(std::string_view rest) {
    if (rest.starts_with("%%")) return {Piece::Kind::text, rest.substr(0, 2), "%"};
    const auto after_digits = std::find_if_not(rest.begin() + 1, rest.end(), is_digit);
    if (after_digits != rest.end() && *after_digits == 'd') {
        const auto length = static_cast<std::size_t>(after_digits - rest.begin()) + 1;
        return {Piece::Kind::number, rest.substr(0, length)};
    }
    const auto letter = std::find_if(rest.begin(), rest.end(), is_letter);
    const auto length = static_cast<std::size_t>(letter - rest.begin());
    return {Piece::Kind::unknown, rest.substr(0, length + 1)};
}

std::vector<Piece> pieces(std::string_view pattern) {
    std::vector<Piece> result;
    while (!pattern.empty()) {
        const std::string_view plain = pattern.substr(0, pattern.find('%'));
        result.push_back(plain.empty() ? conversion(pattern)
                                       : Piece{Piece::Kind::text, plain, std::string(plain)});
        pattern.remove_prefix(result.back().spelling.size());
    }
    return result;
}

[[noreturn]] void refuse(const std::string& pattern, const std::string& found) {
    throw Error(Errc::usage,
                fmt::format("{}: found {}; expected one %d, or %04d for four digits, where the "
                            "frame's number goes in the file's name, and %% for a percent sign",
                            pattern, found));
}

// "%04d" -> "{:04}", "%4d" -> "{:4}", "%d" -> "{}"
std::string number_format(const std::string& pattern, std::string_view spelling) {
    std::string_view digits = spelling.substr(1, spelling.size() - 2);
    const bool zeros = digits.starts_with('0');
    while (digits.starts_with('0')) digits.remove_prefix(1);
    if (digits.empty()) return "{}";
    if (digits.size() > 2 || std::stoi(std::string(digits)) > kWidest)
        refuse(pattern, fmt::format("{}, which is wider than {}", spelling, kWidest));
    return fmt::format("{{:{}{}}}", zeros ? "0" : "", digits);
}

}  // namespace

FrameRange parse_frame_range(const std::string& text) {
    const std::vector<std::string> parts = split(text, ':');
    if (parts.size() != 2 && parts.size() != 3) {
        throw Error(Errc::usage,
                    fmt::format("\"{}\" is not FIRST:LAST, as 0:119, or FIRST:LAST:STEP", text));
    }
    FrameRange range;
    range.first = parse_whole_number(parts[0], 0, kLastFrame);
    range.last = parse_whole_number(parts[1], 0, kLastFrame);
    if (parts.size() == 3) range.step = parse_whole_number(parts[2], 1, kLastFrame);
    if (range.first > range.last) {
        throw Error(Errc::usage, fmt::format("the first frame, {}, comes after the last, {}",
                                             range.first, range.last));
    }
    return range;
}

std::vector<int> numbers(const FrameRange& range) {
    std::vector<int> result;
    for (int number = range.first; number <= range.last; number += range.step)
        result.push_back(number);
    return result;
}

FramePattern::FramePattern(const std::string& text) {
    std::string_view number;  // its spelling
    for (const Piece& piece : pieces(text)) {
        if (piece.kind == Piece::Kind::unknown) refuse(text, fmt::format("\"{}\"", piece.spelling));
        if (piece.kind == Piece::Kind::text) {
            (number.empty() ? before_ : after_) += piece.text;
        } else if (number.empty()) {
            number = piece.spelling;
        } else {
            refuse(text, fmt::format("{} and {}", number, piece.spelling));
        }
    }
    if (number.empty()) refuse(text, "none");
    if (after_.find('/') != std::string::npos)
        refuse(text, fmt::format("{} in a folder's name", number));
    number_ = number_format(text, number);
}

std::string FramePattern::file_of(int frame) const {
    return before_ + fmt::format(fmt::runtime(number_), frame) + after_;
}

std::string FramePattern::folder() const {
    return std::filesystem::path(before_).parent_path().string();
}

bool has_frame_number(const std::string& text) {
    const std::vector<Piece> all = pieces(text);
    return std::any_of(all.begin(), all.end(),
                       [](const Piece& piece) { return piece.kind == Piece::Kind::number; });
}

}  // namespace mirrorball::cli
