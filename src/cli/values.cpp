// Values as people type them: numbers, lists, and words that are nearly right.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <mirrorball/error.h>

#include "command.h"

namespace mirrorball::cli {
std::string unknown(std::string_view kind, std::string_view word,
                    const std::vector<std::string>& candidates) {
    const std::string near = nearest(word, candidates);
    std::string message = fmt::format("\"{}\" is not {}", word, kind);
    if (!near.empty()) message += fmt::format("; did you mean \"{}\"?", near);
    return message +
           fmt::format("{} there are: {}", near.empty() ? ";" : "", fmt::join(candidates, ", "));
}

int parse_whole_number(const std::string& text, int least, int most) {
    long long value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    const bool in_range = error == std::errc() && value >= least && value <= most;
    if (stop != end || text.empty() || !in_range) {
        throw Error(Errc::usage,
                    fmt::format("\"{}\" is not a whole number from {} to {}", text, least, most));
    }
    return static_cast<int>(value);
}

double parse_real_number(const std::string& text, double least, double most) {
    char* stop = nullptr;
    const double value = text.empty() ? 0 : std::strtod(text.c_str(), &stop);
    if (text.empty() || *stop != '\0' || !(value >= least && value <= most)) {
        const std::string range = std::isinf(most) ? fmt::format("of {} or more", least)
                                                   : fmt::format("from {} to {}", least, most);
        throw Error(Errc::usage, fmt::format("\"{}\" is not a number {}", text, range));
    }
    return value;
}

std::vector<std::string> split(std::string_view text, char separator) {
    std::vector<std::string> parts;
    for (std::size_t start = 0;;) {
        const std::size_t end = text.find(separator, start);
        parts.emplace_back(text.substr(start, end - start));
        if (end == std::string_view::npos) return parts;
        start = end + 1;
    }
}

SetValue text(std::string& value) {
    return [&value](const std::string& typed) {
        if (typed.empty()) throw Error(Errc::usage, "the value is empty");
        value = typed;
    };
}

SetValue flag(bool& value) {
    return [&value](const std::string&) { value = true; };
}

SetValue whole_number(int& value, int least, int most) {
    return [&value, least, most](const std::string& typed) {
        value = parse_whole_number(typed, least, most);
    };
}

SetValue real_number(double& value, double least, double most) {
    return [&value, least, most](const std::string& typed) {
        value = parse_real_number(typed, least, most);
    };
}

}  // namespace mirrorball::cli
