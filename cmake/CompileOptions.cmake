# What every target of ours is compiled with.
#
# -ffp-contract=off: a fused multiply-add rounds once where two operations round twice, so letting the
# compiler choose would give other bits on other processors.
add_library(mirrorball_options INTERFACE)
target_compile_options(mirrorball_options INTERFACE
    -ffp-contract=off
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wno-float-conversion
    # GCC 12 warns of overlaps in its own std::string that cannot be (its bug 105651).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
