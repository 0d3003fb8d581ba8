"""A head and two hands that turn: headset.py MOREC DATA

The head and hands of `sessions`, taught by two clips of each class and person, recognised as recorded and turned by a right angle; without and
with a point before the face, which is put at right angles to the shoulders. Prints F1 of events (their middle within the label, 8 frames
more at each side) for the same person and for the five others.
"""

import csv, json, math, subprocess, sys, tempfile
from pathlib import Path

POINTS = {"HEAD": "head", "LEFT_HAND": "left_hand", "RIGHT_HAND": "right_hand"}
TURNED = math.radians(90)


def table(path):
    with open(path) as file:
        return list(csv.DictReader(file, delimiter="\t"))


def poses(morec, clip, folder):
    """Places of the clip's joints in metres, frame by frame."""
    out = folder / f"{clip.stem}.jsonl"
    if not out.exists():
        subprocess.run([morec, "convert", clip, "-o", out], check=True, stderr=subprocess.DEVNULL)
    read = [json.loads(line)["positions"] for line in out.read_text().splitlines()]
    return [{name.rstrip("#"): [value / 1000 for value in at] for name, at in pose.items()} for pose in read]


def tracked(frames, turn, has_face):
    """Lines of JSON of the head and the hands, turned about the vertical."""
    cos, sin = math.cos(turn), math.sin(turn)
    lines = []
    for frame, pose in enumerate(frames):
        at = {name: [x * cos + z * sin, y, z * cos - x * sin] for name, (x, y, z) in pose.items()}
        if not {*POINTS, "LEFT_SHOULDER", "RIGHT_SHOULDER"} <= at.keys():
            continue
        positions = {role: at[name] for name, role in POINTS.items()}
        across = [left - right for left, right in zip(at["LEFT_SHOULDER"], at["RIGHT_SHOULDER"])]
        if has_face:
            wide = math.hypot(across[0], across[2]) or 1
            x, y, z = positions["head"]
            positions["face"] = [x - 0.1 * across[2] / wide, y, z + 0.1 * across[0] / wide]
        lines.append(json.dumps({"t": frame / 30, "positions": positions}))
    return "\n".join(lines)


def counts(found, labels):
    """Events that are right, and labels that none of them is."""
    left, right = list(labels), 0
    for row in found:
        middle = (float(row["start"]) + float(row["stop"])) / 2
        hits = (label for label in left if label[0] == row["class"] and label[1] - 8 <= middle <= label[2] + 8)
        if hit := next(hits, None):
            left.remove(hit)
            right += 1
    return right, len(left)


def measure(morec, data, folder, has_face, turn):
    teach = table(data / "sessions/teach.tsv")
    people = sorted({row["person"] for row in teach})
    labels = {person: [] for person in people}
    for row in table(data / "sessions/labels.tsv"):
        labels[row["person"]].append((row["class"], int(row["start"]), int(row["stop"])))
    for row in teach:
        frames = poses(morec, data / f"gestures/clips/{row['clip']}.bvh", folder / "read")
        (folder / f"{row['clip']}.jsonl").write_text(tracked(frames, 0, has_face))
    for person in people:
        frames = poses(morec, data / f"sessions/clips/session_{person}.bvh", folder / "read")
        (folder / f"session_{person}.jsonl").write_text(tracked(frames, turn, has_face))
    totals = {"same": [0, 0, 0], "others": [0, 0, 0]}
    for person in people:
        own = [row for row in teach if row["person"] == person]
        (folder / "labels.tsv").write_text("clip\tclass\n" + "".join(f"{row['clip']}\t{row['class']}\n" for row in own))
        clips = [folder / f"{row['clip']}.jsonl" for row in own]
        command = [morec, "train", "--clips", *clips, "--labels", folder / "labels.tsv", "-o", folder / "index"]
        subprocess.run(command, check=True, capture_output=True)
        for performer in people:
            command = [morec, "recognize", folder / "index", folder / f"session_{performer}.jsonl"]
            done = subprocess.run(command, check=True, capture_output=True, text=True)
            found = list(csv.DictReader(done.stdout.splitlines(), delimiter="\t"))
            right, missed = counts(found, labels[performer])
            total = totals["same" if performer == person else "others"]
            for at, count in enumerate((right, len(found) - right, missed)):
                total[at] += count
    return {who: 2 * right / (2 * right + wrong + missed) for who, (right, wrong, missed) in totals.items()}


def main():
    morec, data = sys.argv[1], Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "read").mkdir()
        for has_face in (False, True):
            for turn in (0, TURNED):
                found = measure(morec, data, folder, has_face, turn)
                what = "with a face" if has_face else "without one"
                print(f"{what}, turned by {math.degrees(turn):.0f}°: same person {found['same']:.3f}, others {found['others']:.3f}", flush=True)


if __name__ == "__main__":
    main()
