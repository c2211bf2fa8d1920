#!/bin/sh
# Makes the pictures of docs/gallery again by the commands in its README: scripts/gallery.sh [FOLDER]
# FOLDER has the program, build/release unless it is said.
set -eu
cd "$(dirname "$0")/.."
PATH=$(realpath "${1:-build/release}"):$PATH
mkdir -p build/gallery docs/gallery/methods
commands=build/gallery/commands.sh
sed -n '/^```sh$/,/^```$/{/^```/!p;}' docs/gallery/README.md >"$commands"
exec sh -eux "$commands"
