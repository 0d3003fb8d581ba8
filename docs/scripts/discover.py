"""How well `morec discover` finds what is labelled, without the labels. Needs nothing but Python.

    discover.py MOREC referee|sessions|kinect_actions|segmentation [--plain]     (clips and labels in MOREC_DATA, default ../shared/data)

own: share of labelled samples that have a repetition of their own, one to one, sharing half of their union. drag: the same once each set is
taken as repetitions or as runs and all its instances are moved by one share of their length, both chosen by the labels: an upper bound.
purity: share of these samples that are of the class most frequent in their set. wrong: sets with two samples or more of a second class.
looks: sets to look at, in their order, until 0.8 of the samples are named right; none if they never are.
segmentation: share of frames that are of the behaviour most frequent in their set, what is in no set counted to the nearest; cuts of people
with a bound of a repetition within their range, 0.5 s more on either side.
"""

import collections
import csv
import json
import os
import resource
import subprocess
import sys

DATA = os.environ.get("MOREC_DATA", "../shared/data")
REFEREE = [f"basketball_{n}" for n in range(1, 5)] + [f"signals_{n}" for n in range(1, 4)]
REFEREE += [f"walking_{n:02}" for n in (1, 2, 3, 4, 5, 13, 15, 17, 19, 21, 27, 29, 31, 33)]


def labels(name):
    scale = {"referee": ("start", "stop", 1 / 120), "sessions": ("start", "stop", 1 / 30)}
    start, stop, secs = scale.get(name, ("start_secs", "stop_secs", 1.0))
    found = collections.defaultdict(list)
    with open(f"{DATA}/{name}/labels.tsv", encoding="utf-8") as file:
        for row in csv.DictReader(file, delimiter="\t"):
            if name != "referee" or row["clip"] in REFEREE:
                found[row["clip"]].append((float(row[start]) * secs, float(row[stop]) * secs, row["class"]))
    return found


def paths(name):
    if name == "referee":
        return [f"{DATA}/referee/clips/{clip}.bvh" for clip in REFEREE]
    return [f"{DATA}/{name}/{'sessions' if name == 'kinect_actions' else 'clips'}"]


def shared(a, b):
    both = min(a[1], b[1]) - max(a[0], b[0])
    return both / (max(a[1], b[1]) - min(a[0], b[0])) if both > 0 else 0.0


def matches(truth, stretches):
    """Set of each labelled sample: one to one, the greatest share first; stretches are clip, start, stop, set."""
    of_clip = collections.defaultdict(list)
    for place, stretch in enumerate(stretches):
        of_clip[stretch[0]].append(place)
    found = {}
    for clip, samples in truth.items():
        pairs = ((shared(s, stretches[at][1:3]), i, at) for i, s in enumerate(samples) for at in of_clip[clip])
        used, done = set(), set()
        for share, i, at in sorted((p for p in pairs if p[0] >= 0.5), reverse=True):
            if i not in done and at not in used:
                done.add(i)
                used.add(at)
                found[clip, i] = stretches[at][3]
    return found


def runs(stretches):
    """Instances of one set joined where they follow each other at once: within 0.35 of their median length."""
    lengths = sorted(stop - start for _, start, stop, _ in stretches)
    gap, joined = 0.35 * lengths[len(lengths) // 2], []
    for clip, start, stop, number in sorted(stretches):
        if joined and joined[-1][0] == clip and start - joined[-1][2] <= gap:
            joined[-1] = (clip, joined[-1][1], max(stop, joined[-1][2]), number)
        else:
            joined.append((clip, start, stop, number))
    return joined


def dragged(truth, stretches):
    best = []
    for kind in (stretches, runs(stretches)):
        for share in sorted((step / 10 for step in range(-5, 6)), key=abs):
            moved = [(c, a + share * (b - a), b + share * (b - a), n) for c, a, b, n in kind]
            best.append((len(matches(truth, moved)), moved))
    return max(best, key=lambda of: of[0])[1]


def measured(truth, stretches):
    count = sum(map(len, truth.values()))
    found = matches(truth, stretches)
    in_sets = collections.defaultdict(collections.Counter)
    for (clip, i), number in found.items():
        in_sets[number][truth[clip][i][2]] += 1
    right = {number: classes.most_common(1)[0][1] for number, classes in in_sets.items()}
    wrong = sum(len(c) > 1 and c.most_common(2)[1][1] >= 2 for c in in_sets.values())
    named, looks = 0, None
    for number in range(1, 1 + max((s[3] for s in stretches), default=0)):
        named += right.get(number, 0)
        if looks is None and named >= 0.8 * count:
            looks = number
    purity = sum(right.values()) / max(1, len(found))
    return f"own {len(found) / count:.2f} purity {purity:.2f} wrong {wrong} looks {looks}"


def behaviours(sets):
    with open(f"{DATA}/segmentation/cuts.tsv", encoding="utf-8") as file:
        cuts = [(row["label_before"], *(int(row[c]) / 120 for c in ("earliest", "best", "latest"))) for row in csv.DictReader(file, delimiter="\t")]
    spans = [(i["start_secs"], i["stop_secs"], s["set"]) for s in sets for i in s["instances"]]
    in_sets, frames = collections.defaultdict(collections.Counter), int(cuts[-1][2] * 120)
    for secs in (frame / 120 for frame in range(frames)):
        number = min((max(a - secs, secs - b, 0.0), n) for a, b, n in spans)[1]
        in_sets[number][next(label for label, _, best, _ in cuts if secs < best)] += 1
    right = sum(classes.most_common(1)[0][1] for classes in in_sets.values()) / frames
    near = [any(first - 0.5 <= end <= last + 0.5 for a, b, _ in spans for end in (a, b)) for _, first, _, last in cuts[:-1]]
    return f"frames {right:.2f} cuts {sum(near)} of {len(near)}"


morec, name, *options = sys.argv[1:]
answer = subprocess.run([morec, "discover", "--json", *options, *paths(name)], check=True, capture_output=True)
secs = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
sets = json.loads(answer.stdout)["sets"]
print(f"{name}: {len(sets)} sets, {secs:.1f} s of processor with reading")
if name == "segmentation":
    print("  as found  ", behaviours(sets))
    sys.exit()
truth = labels(name)
by_set = [[(i["clip"], i["start_secs"], i["stop_secs"], s["set"]) for i in s["instances"]] for s in sets]
print("  as found  ", measured(truth, [i for s in by_set for i in s]))
print("  drag      ", measured(truth, [i for s in by_set for i in dragged(truth, s)]))
