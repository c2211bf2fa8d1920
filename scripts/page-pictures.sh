#!/bin/sh
# Makes the pictures of the page in docs/images again:
#
#     scripts/page-pictures.sh [BUILD_FOLDER]     as `make web-test` left it, build/web unless it is said
#
# Chromium draws; ImageMagick (Debian's imagemagick, with libwebp's plugin) packs.
set -eu
cd "$(dirname "$0")/.."
build=$(realpath "${1:-build/web}")
[ -d "$build/test/node_modules" ] || { echo "$build/test has no driver of browsers (make web-test)" >&2; exit 1; }
cp tests/web/server.mjs scripts/page-pictures.mjs "$build/test"
frames=$build/test/frames
rm -rf "$frames"
mkdir -p "$frames"
MIRRORBALL_PAGE=$build/page node "$build/test/page-pictures.mjs" "$frames"

convert "$frames/desktop.png" -quality 88 docs/images/page.jpg
convert "$frames/phone.png" -resize 50% -quality 88 docs/images/page-phone.jpg
convert -delay 10 -loop 0 "$frames"/frame-*.png -quality 62 -define webp:method=6 docs/images/page.webp
ls -l docs/images/page*
