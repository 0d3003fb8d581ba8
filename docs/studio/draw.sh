#!/bin/sh
# Draws the pictures of the guide's chapter on the studio. Made people, no display needed:
#     docs/studio/draw.sh
set -eu
cd "$(dirname "$0")/../.."
cargo build --release -p morec-studio
studio=target/release/morec-studio
draw() { panel=$1; at=$2; shift 2; "$studio" --screenshot "docs/studio/$panel.png" --panel "$panel" --at "$at" "$@"; }
draw library 24.2
draw label 24.2
draw classes 24.2
draw train 24.2
draw live 52
