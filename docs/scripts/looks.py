"""Naming twenty sets in place of labelling every gesture: three people's sessions teach, the other three are recognised, and the other way round.

    looks.py MOREC [--plain]        (clips and labels in MOREC_DATA, default ../shared/data)

Somebody looks at the first twenty sets and names those of which half or more lies in labels of one class; their repetitions train an index. Beside it, the
index of all true labels. F1 of events: the middle of a detection lies within a label of its class, 8 frames more on either side, one to one.
"""

import collections
import csv
import json
import os
import subprocess
import sys
import tempfile

LOOKS = 20
SESSIONS = os.environ.get("MOREC_DATA", "../shared/data") + "/sessions"
morec, *options = sys.argv[1:]


def run(*args):
    return subprocess.run([morec, *args], check=True, capture_output=True, text=True).stdout


def paths(clips):
    return [f"{SESSIONS}/clips/{clip}.bvh" for clip in clips]


labels = collections.defaultdict(list)
with open(f"{SESSIONS}/labels.tsv", encoding="utf-8") as file:
    for row in csv.DictReader(file, delimiter="\t"):
        labels[row["clip"]].append((int(row["start"]) / 30, int(row["stop"]) / 30, row["class"]))


def named(clips):
    rows = []
    for found in json.loads(run("discover", "--json", *options, *paths(clips)))["sets"][:LOOKS]:
        middles = [(i["clip"], 0.5 * (i["start_secs"] + i["stop_secs"])) for i in found["instances"]]
        seen = [next((c for a, b, c in labels[clip] if a <= at <= b), None) for clip, at in middles]
        name, count = collections.Counter(seen).most_common(1)[0]
        if name is not None and count >= 0.5 * len(seen):
            rows += [(i["clip"], name, i["start_secs"], i["stop_secs"]) for i in found["instances"]]
    return rows


def counts(clips, rows, test, folder):
    table, index = f"{folder}/labels.tsv", f"{folder}/taught.index"
    with open(table, "w", encoding="utf-8") as file:
        file.write("clip\tclass\tstart_secs\tstop_secs\n")
        file.writelines("\t".join(map(str, row)) + "\n" for row in rows)
    run("train", "--clips", *paths(clips), "--labels", table, "-o", index)
    lines = run("recognize", index, *paths(test), "--form", "jsonl").splitlines()
    right, used = 0, set()
    for found in map(json.loads, lines):
        at = 0.5 * (found["start_secs"] + found["stop_secs"])
        for i, (a, b, name) in enumerate(labels[found["clip"]]):
            if (found["clip"], i) not in used and name == found["class"] and a - 8 / 30 <= at <= b + 8 / 30:
                used.add((found["clip"], i))
                right += 1
                break
    return right, len(lines) - right, sum(len(labels[clip]) for clip in test) - right


halves = [sorted(labels)[::2], sorted(labels)[1::2]]
total = collections.defaultdict(collections.Counter)
with tempfile.TemporaryDirectory() as folder:
    for teach, test in (halves, halves[::-1]):
        truth = [(clip, name, a, b) for clip in teach for a, b, name in labels[clip]]
        for what, rows in ((f"{LOOKS} looks", named(teach)), ("all labels", truth)):
            total[what].update(dict(zip(("right", "false", "missed"), counts(teach, rows, test, folder))))
for what, c in total.items():
    print(f"{what}: F1 {2 * c['right'] / (2 * c['right'] + c['false'] + c['missed']):.3f}", dict(c))
