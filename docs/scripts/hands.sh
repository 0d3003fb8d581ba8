#!/usr/bin/env bash
# The contest's measure of `hands`: each quarter of the streams is recognised by what the others teach. Prints detection rate (DR) and
# false reports a gesture (FP) of each quarter. Usage: hands.sh MOREC DATA
set -euo pipefail
morec=$1 hands=$2/hands
out=$(mktemp -d)
trap 'rm -r "$out"' EXIT
for part in 0 1 2 3; do
    taught=() tested=() number=0
    head -n 1 "$hands/labels.tsv" >"$out/labels.tsv"
    for clip in "$hands"/clips/*.npz; do
        if ((number++ % 4 == part)); then
            tested+=("$clip")
            grep -P "^$(basename "$clip" .npz)\t" "$hands/labels.tsv" >>"$out/labels.tsv" || true
        else
            taught+=("$clip")
        fi
    done
    "$morec" train --clips "${taught[@]}" --labels "$hands/labels.tsv" -o "$out/hands.index" >"$out/train.log"
    "$morec" recognize "$out/hands.index" "${tested[@]}" -o "$out/found.tsv"
    python3 "$hands/score.py" "$out/labels.tsv" "$out/found.tsv"
done
