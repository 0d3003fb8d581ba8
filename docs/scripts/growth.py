"""Training and recognition by the number of classes: growth.py MOREC DATA [CLASSES...]

Each class is made of `gestures`: the left arm of one gesture, the right arm of another, the legs of a third, every second class
backwards; six samples of six people. Prints time and memory of training, bytes of the index, and frames a second of `morec bench` over
one sample of each of the first twenty classes (30 Hz) and over a clip of 120 Hz; then the power with which each grows from one number of
classes to the next.
"""

import csv, itertools, math, os, subprocess, sys, tempfile, time
from pathlib import Path

# Channels of the skeleton of `gestures`.
ARMS = {"left": range(6, 18), "right": range(18, 30)}
SAMPLES = 6


def clips(data):
    """For each gesture, header and frames of a clip of each person."""
    found = {}
    with open(data / "gestures/clips.tsv") as table:
        for row in csv.DictReader(table, delimiter="\t"):
            if row["class"] != "dontcare":
                found.setdefault(row["class"], {}).setdefault(row["person"], row["clip"])

    def read(clip):
        text = (data / "gestures/clips" / f"{clip}.bvh").read_text()
        head, motion = text.split("MOTION", 1)
        frames = [line.split() for line in motion.strip().splitlines()[2:]]
        return head, [frame for frame in frames if frame]

    return {name: [read(clip) for clip in people.values()] for name, people in found.items()}


def write(classes, data, folder):
    gestures = clips(data)
    names = sorted(gestures)
    made = itertools.islice(itertools.cycle(itertools.product(names, names, names, (False, True))), 0, classes * 7, 7)
    labels = ["clip\tclass\tperson"]
    for number, (legs, left, right, backwards) in enumerate(made):
        for sample in range(SAMPLES):
            head, base = gestures[legs][sample % len(gestures[legs])]
            arms = [gestures[name][sample % len(gestures[name])][1] for name in (left, right)]
            frames = []
            for place in range(len(base)):
                frame = list(base[place])
                for channels, arm in zip(ARMS.values(), arms):
                    source = arm[place * len(arm) // len(base)]
                    for channel in channels:
                        frame[channel] = source[channel]
                frames.append(" ".join(frame))
            if backwards:
                frames.reverse()
            clip = f"c{number}_{sample}"
            text = f"{head}MOTION\nFrames: {len(frames)}\nFrame Time: 0.033333\n" + "\n".join(frames) + "\n"
            (folder / f"{clip}.bvh").write_text(text)
            labels.append(f"{clip}\tc{number}\tp{sample}")
    (folder / "labels.tsv").write_text("\n".join(labels) + "\n")


def run(command):
    """Seconds, and the most memory in MB."""
    start = time.time()
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    text = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        sys.exit(text)
    return time.time() - start, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, text


def rate(morec, index, clips):
    """Frames a second."""
    *_, text = run([morec, "bench", index, *clips])
    return int(next(line.split()[-1] for line in text.splitlines() if line.startswith("whole path")))


def main():
    morec, data = sys.argv[1], Path(sys.argv[2])
    print("classes\ttraining, s\tprocessor, s\tMB\tindex, kB\tframes a second, 30 Hz\t120 Hz")
    made = []
    for classes in map(int, sys.argv[3:] or ["5", "20", "100"]):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            write(classes, data, folder)
            index = folder / "made.index"
            seconds, processor, memory, _ = run(
                [morec, "train", "--clips", folder, "--labels", folder / "labels.tsv", "-o", index]
            )
            few = [folder / f"c{number}_0.bvh" for number in range(min(classes, 20))]
            rates = [rate(morec, index, few), rate(morec, index, [data / "referee/clips/signals_1.bvh"])]
            kilobytes = index.stat().st_size / 1000
            print(f"{classes}\t{seconds:.1f}\t{processor:.1f}\t{memory:.0f}\t{kilobytes:.0f}\t{rates[0]}\t{rates[1]}", flush=True)
            made.append((classes, seconds, processor, memory, kilobytes, *rates))
    for few, many in itertools.pairwise(made):
        powers = (math.log(b / a) / math.log(many[0] / few[0]) for a, b in zip(few[1:], many[1:]))
        print(f"{few[0]} to {many[0]}\t" + "\t".join(f"{power:.2f}" for power in powers))


main()
