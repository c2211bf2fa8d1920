#!/bin/sh
# Tests the page in a real browser.
#
#     scripts/web-test.sh BUILD_FOLDER PROGRAM     as `make web` built it; the program of this machine
#
# Exit: what the tests exit with; 77, and the reason, where something that they need is missing. With
# MIRRORBALL_WEB_REQUIRED=1 that is a failure, too.
set -eu
build=$1
program=$(realpath "$2")
tests=$(dirname "$(realpath "$0")")/../tests/web

skip() {
    printf 'The tests of the page were skipped: %s\n' "$1" >&2
    if [ "${MIRRORBALL_WEB_REQUIRED:-}" = 1 ]; then exit 1; fi
    exit 77
}

[ -f "$build/page/mirrorball.wasm" ] && [ -f "$build/page/embed.js" ] || skip "$build/page is not there (make web builds it)"
[ -x /usr/bin/chromium ] || skip 'there is no /usr/bin/chromium (the package chromium)'
for tool in node npm; do
    command -v $tool >/dev/null 2>&1 || skip "there is no $tool (scripts/install-packages.sh web)"
done
node -e 'process.exit(+process.versions.node.split(".")[0] >= 20 ? 0 : 1)' ||
    skip "Node.js is $(node --version); the driver of browsers needs 20 or newer"

# What npm installs is not for the source tree.
mkdir -p "$build/test"
cp "$tests"/package.json "$tests"/package-lock.json "$tests"/*.mjs "$build/test"
cd "$build/test"
if ! cmp -s package-lock.json installed-lock.json; then
    npm ci --ignore-scripts --no-audit --no-fund --loglevel=error >npm.log 2>&1 ||
        skip "npm could not install playwright-core: $(tail -n 1 npm.log)"
    cp package-lock.json installed-lock.json
fi

here=$(pwd)
MIRRORBALL_PAGE=$here/../page MIRRORBALL_PROGRAM=$program MIRRORBALL_OUTPUT=$here/pictures \
    exec node --test --test-reporter=tap page_test.mjs report_test.mjs
