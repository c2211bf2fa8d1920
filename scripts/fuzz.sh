#!/bin/sh
# Runs every fuzz target for a bounded number of inputs: scripts/fuzz.sh [RUNS]
# An input that breaks a decoder is left in build/fuzz/found; keep it in tests/fuzz/crashes/NAME, where
# the tests replay it, and mend the decoder.
set -eu
cd "$(dirname "$0")/.."
runs=${1:-100000}
found=build/fuzz/found

# The preset leaves out the program and the tests.
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz

mkdir -p "$found"
for target in build/fuzz/tests/fuzz/*_fuzz; do
    name=$(basename "$target" _fuzz)
    corpus=build/fuzz/corpus/$name  # grows from run to run; the folders in the repository do not
    mkdir -p "$corpus" "tests/fuzz/crashes/$name"
    echo "fuzz: $name, $runs inputs"
    "$target" -runs="$runs" -max_len=4096 -timeout=5 -rss_limit_mb=1024 -verbosity=0 \
        -print_final_stats=1 -artifact_prefix="$found/$name-" \
        "$corpus" "tests/fuzz/seeds/$name" "tests/fuzz/crashes/$name"
done
