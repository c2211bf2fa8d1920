// Wider vectors where the processor has them, without a second source.
#pragma once

namespace mirrorball::detail {

#if defined(__x86_64__)

template <class Body>
[[gnu::target("avx2"), gnu::flatten]] void run_with_avx2(const Body& body) {
    body();
}

/// Runs `body`, a lambda marked MIRRORBALL_INLINE_BODY around a simple loop, compiled once for the
/// baseline and once for AVX2. Nothing is contracted or reassociated, so the bits are the same.
template <class Body>
void vectorized(const Body& body) {
    static const bool avx2 = __builtin_cpu_supports("avx2") != 0;
    if (avx2)
        run_with_avx2(body);
    else
        body();
}

#else

template <class Body>
void vectorized(const Body& body) {
    body();
}

#endif

#define MIRRORBALL_INLINE_BODY __attribute__((always_inline))

}  // namespace mirrorball::detail
