// The bits of one type as those of another.
#pragma once

#include <bit>

namespace mirrorball::detail {

#if defined(__cpp_lib_bit_cast)
using std::bit_cast;
#else
/// std::bit_cast(), for standard libraries that have not got it yet.
template <class To, class From>
constexpr To bit_cast(const From& from) {
    return __builtin_bit_cast(To, from);
}
#endif

}  // namespace mirrorball::detail
