# What every target of ours is compiled with.
#
# -ffp-contract=off: a fused multiply-add rounds once where two operations round twice, so letting the
# compiler choose would give other bits on other processors.
#
# Nobody here reads errno or floating-point flags after mathematics; saying so changes no result and
# lets square roots and choices become vector code.
#
# -mssse3: what every x86-64 processor since 2008 has, and the least that Highway has vectors for.
add_library(mirrorball_options INTERFACE)
target_compile_options(mirrorball_options INTERFACE
    -ffp-contract=off -fno-math-errno -fno-trapping-math
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wno-float-conversion
    # GCC 12 warns of overlaps in its own std::string that cannot be (its bug 105651).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
    # A browser's memory has 32-bit addresses. What is large is held against the limit of memory
    # before room is made for it, so that no size is cut off.
    $<$<BOOL:${EMSCRIPTEN}>:-Wno-shorten-64-to-32>)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    target_compile_options(mirrorball_options INTERFACE -mssse3)
endif()
