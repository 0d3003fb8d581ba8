#!/bin/sh
# Draws the pictures of the guide's chapter on the studio. Made people, no display needed:
#     docs/studio/draw.sh
# With STUDIO set, that binary draws them.
set -eu
cd "$(dirname "$0")/../.."
if [ -z "${STUDIO:-}" ]; then
    cargo build --release -p morec-studio --features window
    STUDIO=target/release/morec-studio
fi
draw() { file=$1; panel=$2; at=$3; shift 3; "$STUDIO" --screenshot "docs/studio/$file.png" --panel "$panel" --at "$at" "$@"; }
draw library library 24.2
draw label label 24.2
draw label_light label 24.2 --light
draw well label 24.2 --like wave
draw classes classes 24.2
draw like classes 24.2 --like wave
draw train train 24.2
draw tree train 24.2 --tree
draw live live 52
