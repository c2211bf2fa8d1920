// Numbers next to nothing, treated as nothing.
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace mirrorball::detail {

/// While one lives, this thread takes floats below 1.2e-38 for zero. The functions of high orders
/// fade out through that range toward the poles, and x86 processors take 100 times as long over a
/// number in it; others do not.
class FlushDenormals {
  public:
#if defined(__SSE2__)
    FlushDenormals() : before_(_mm_getcsr()) {
        _mm_setcsr(before_ | kFlushToZero | kZeroInputs);
    }
    ~FlushDenormals() {
        _mm_setcsr(before_);
    }

  private:
    static constexpr unsigned kFlushToZero = 0x8000, kZeroInputs = 0x0040;
    unsigned before_;
#else
    FlushDenormals() {}
    ~FlushDenormals() {}
#endif

  public:
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;
};

}  // namespace mirrorball::detail
