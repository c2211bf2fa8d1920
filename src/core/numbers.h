// Numbers out of text, with a decimal point in every locale.
#pragma once

#include <charconv>

namespace mirrorball::detail {

using std::from_chars;

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 200000
/// std::from_chars() for floating point, which this standard library has not yet.
std::from_chars_result from_chars(const char* first, const char* last, float& value);
std::from_chars_result from_chars(const char* first, const char* last, double& value);
#endif

}  // namespace mirrorball::detail
