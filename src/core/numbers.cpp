#include "core/numbers.h"

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 200000
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <string>

namespace mirrorball::detail {
namespace {

float parse(const char* text, char** end, float) {
    return std::strtof(text, end);
}
double parse(const char* text, char** end, double) {
    return std::strtod(text, end);
}

// strtod() knows more than from_chars(): white space and a plus in front, hexadecimal digits.
template <class T>
std::from_chars_result from_chars_by_strtod(const char* first, const char* last, T& value) {
    std::string text(first, last);
    const std::size_t digits = text.starts_with('-') ? 1 : 0;
    if (text.size() <= digits || text[digits] == '+' || text[digits] == '-' ||
        std::isspace(static_cast<unsigned char>(text[digits])))
        return {first, std::errc::invalid_argument};
    if (const std::size_t x = text.find_first_of("xX"); x != std::string::npos) text.resize(x);

    errno = 0;
    char* end = nullptr;
    const T parsed = parse(text.c_str(), &end, T());
    if (end == text.c_str()) return {first, std::errc::invalid_argument};
    const char* stop = first + (end - text.c_str());
    if (errno == ERANGE && (std::isinf(parsed) || parsed == 0))
        return {stop, std::errc::result_out_of_range};
    value = parsed;
    return {stop, std::errc()};
}

}  // namespace

std::from_chars_result from_chars(const char* first, const char* last, float& value) {
    return from_chars_by_strtod(first, last, value);
}
std::from_chars_result from_chars(const char* first, const char* last, double& value) {
    return from_chars_by_strtod(first, last, value);
}

}  // namespace mirrorball::detail
#endif
