#!/bin/sh
# Installs the Debian packages that the build needs and that are missing; does nothing, and needs no
# network, where all are there. Never asks a question.
#
#     scripts/install-packages.sh [SET...]       sets of packages (default: build test), or `all`
#     scripts/install-packages.sh --list         the table
#     scripts/install-packages.sh --missing [SET...]   names of those that are not installed
#
# Exit: 0 all are installed, 1 installing failed, 2 wrong use, 3 some are missing and this user may
# not install them (what to run is printed).
set -eu

# One package a line: the set it belongs to, its name, and what it is for.
packages() {
    cat <<'TABLE'
build   g++                    C++20 compiler (12 or newer)
build   cmake                  configures the build (3.25 or newer)
build   ninja-build            runs the build
build   pkg-config             finds Zstandard
build   libopenexr-dev         OpenEXR files
build   libimath-dev           vectors and half floats
build   libpng-dev             PNG files, and the pictures of the bake report
build   libjpeg62-turbo-dev    JPEG files (reading)
build   libtiff-dev            TIFF files
build   libzstd-dev            Zstandard supercompression in KTX2 files
build   libtbb-dev             threads
build   libhwy-dev             Highway: vector code for every processor from one source
build   libfmt-dev             messages (g++ 12 has no std::format)
build   libcli11-dev           the program's options
build   nlohmann-json3-dev     bake.json and the output of --json
build   libtinyobjloader-dev   OBJ meshes
build   libtinygltf-dev        glTF meshes
build   libepoxy-dev           OpenGL and EGL, loaded when they are used
build   libglfw3-dev           the window of `mirrorball view`
build   libimgui-dev           its controls
build   fonts-dejavu-core      their letters
build   libegl1                OpenGL without a window
build   libgl1                 OpenGL itself
build   libgles2               OpenGL ES, as browsers have it
build   libgl1-mesa-dri        a driver for it that needs no graphics card
test    libgtest-dev           the tests
test    xvfb                   a screen that no one sees, for tests of the window
test    xauth                  xvfb-run needs it
test    xdotool                a mouse and keys on that screen
test    libtinyexr-dev         the page's OpenEXR reader, tested beside the usual one
bench   libbenchmark-dev       the benchmarks
fuzz    clang                  libFuzzer comes with it
fuzz    libclang-rt-14-dev     the sanitizers' and libFuzzer's run-time libraries
fuzz    llvm                   llvm-symbolizer: names and lines in sanitizer reports
web     emscripten             compiles the page to WebAssembly
web     libtinyexr-dev         OpenEXR files in a browser
web     chromium               the browser that tests the page
web     nodejs                 runs those tests, and parts of emscripten
web     npm                    gets the tests' driver of browsers
format  clang-format           make format
format  clang-tidy             checks of .clang-tidy
TABLE
}

say() { printf '%s\n' "$*" >&2; }

known_set() { packages | cut -d ' ' -f 1 | grep -qx -e "$1"; }

# Names of the packages of the sets given.
names() {
    for set_name in "$@"; do
        packages | while read -r set name _; do
            if [ "$set_name" = all ] || [ "$set" = "$set_name" ]; then printf '%s\n' "$name"; fi
        done
    done
}

# npm comes with Node.js where that is not Debian's, and the package npm would not go with it.
installed() {
    if [ "$1" = npm ] && command -v npm >/dev/null 2>&1; then return 0; fi
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null | cut -c 1-9)" = installed ]
}

missing() {
    names "$@" | while read -r name; do
        installed "$name" || printf '%s\n' "$name"
    done
}

show_missing=no
case "${1:-}" in
    --list) packages; exit 0 ;;
    --help | -h) sed -n '2,/^set /{/^set /d;s/^# \{0,1\}//;p;}' "$0"; exit 0 ;;
    --missing) show_missing=yes; shift ;;
esac
[ $# -gt 0 ] || set -- build test
for set_name in "$@"; do
    if [ "$set_name" != all ] && ! known_set "$set_name"; then
        say "install-packages.sh: '$set_name' is no set of packages (there are: build test bench fuzz web format all)"
        exit 2
    fi
done

if ! command -v dpkg-query >/dev/null 2>&1; then
    say "install-packages.sh: this is no Debian system, so nothing is checked or installed."
    say "The build needs what these Debian packages hold: $(names "$@" | tr '\n' ' ')"
    exit 0
fi

wanted=$(missing "$@")
if [ "$show_missing" = yes ]; then
    [ -z "$wanted" ] || printf '%s\n' "$wanted"
    exit 0
fi
[ -n "$wanted" ] || exit 0

say "Missing packages:"
packages | while read -r _ name reason; do
    if printf '%s\n' "$wanted" | grep -qxF -e "$name"; then
        say "$(printf '    %-22s %s' "$name" "$reason")"
    fi
done

# Package names hold no spaces: this turns the list into arguments.
# shellcheck disable=SC2086
set -- $wanted

if [ "$(id -u)" -eq 0 ]; then
    as_root=
elif command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then
    as_root="sudo -n"
else
    say "Installing them needs root, and sudo would ask for a password (or is not there). Please run"
    say "this as root, then start again:"
    say ""
    say "    apt-get update && apt-get install --no-install-recommends $*"
    say ""
    exit 3
fi

# `env` because sudo drops the caller's environment.
apt() {
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300 "$@"
}
say "Installing them."
# A failed update is no reason to stop: the lists there may be good enough, and install says if not.
apt update >&2 || say "install-packages.sh: apt-get update failed; trying with the package lists there are"
if ! apt install --no-install-recommends "$@" </dev/null >&2; then
    say "install-packages.sh: apt-get install failed (its message is above)"
    exit 1
fi
