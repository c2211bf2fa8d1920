# What every target of ours is compiled with.
#
# -ffp-contract=off: a fused multiply-add rounds once where two operations round twice, so letting the
# compiler choose would give other bits on other processors.
add_library(mirrorball_options INTERFACE)
target_compile_options(mirrorball_options INTERFACE
    -ffp-contract=off
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wno-float-conversion)
