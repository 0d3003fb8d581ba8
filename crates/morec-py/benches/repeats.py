"""Time and memory of `Archive.discover` on clips that are repeated with noise.

    python repeats.py FOLDER [--hours 100] [--minutes 15] [--rounds 2]

FOLDER holds BVH clips of positions, such as those of `sessions`. Ten copies of each have slow noise on every channel of their own; they are imported again
and again, each time with one value changed, until there are as many hours. Printed are hours, seconds and the most memory so far of each step, and the number of sets.
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time
from pathlib import Path

import numpy as np

import morec.archive as ma

#: Deviation of the noise, millimetres in `sessions`, and frames over which it is smoothed.
NOISE = 10.0
SMOOTHED = 15
#: Copies that are imported together.
TOGETHER = 10


def noisy(text: str, rng: np.random.Generator) -> str:
    head, motion = text.split("MOTION", 1)
    lines = motion.strip().splitlines()
    frames = np.array([line.split() for line in lines[2:] if line.strip()], dtype=float)
    noise = rng.normal(size=(len(frames) + SMOOTHED - 1, frames.shape[1]))
    sums = np.cumsum(np.vstack([np.zeros(noise.shape[1]), noise]), axis=0)
    frames += NOISE * (sums[SMOOTHED:] - sums[:-SMOOTHED]) / SMOOTHED**0.5
    rows = "\n".join(" ".join(f"{value:.2f}" for value in frame) for frame in frames)
    return f"{head}MOTION\n{lines[0]}\n{lines[1]}\n{rows}\n"


def changed(text: str) -> str:
    """The same clip but for one value: an archive holds no motion twice."""
    rest, last = text.rstrip().rsplit("\n", 1)
    value, others = last.split(maxsplit=1)
    return f"{rest}\n{float(value) + 0.01:.2f} {others}\n"


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("--hours", type=float, default=100.0)
    parser.add_argument("--minutes", type=float, default=15.0)
    parser.add_argument("--rounds", type=int, default=2)
    args = parser.parse_args()
    clips = sorted(args.folder.glob("*.bvh"))
    rng = np.random.default_rng(1)

    def say(what: str, begun: float) -> None:
        most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        print(f"{what}: {time.perf_counter() - begun:.0f} s, {most:.0f} MB", flush=True)

    with tempfile.TemporaryDirectory() as folder:
        begun = time.perf_counter()
        made = Path(folder) / "copies"
        made.mkdir()
        for copy in range(TOGETHER):
            for clip in clips:
                (made / f"{clip.stem}_{copy}.bvh").write_text(noisy(clip.read_text(), rng))
        archive = ma.create(f"{folder}/archive", from_files=str(args.folder / "*.bvh"))
        while archive.info()["hours"] < args.hours:
            archive = ma.create(f"{folder}/archive", from_files=f"{made}/*.bvh")
            for file in sorted(made.iterdir()):
                stem, copy = file.stem.rsplit("_", 1)
                (made / f"{stem}_{int(copy) + TOGETHER}.bvh").write_text(changed(file.read_text()))
                file.unlink()
        say(f"{archive.info()['hours']:.1f} hours made", begun)
        begun = time.perf_counter()
        sets = archive.discover(minutes=args.minutes, rounds=args.rounds)
        events = sets.events.count_rows()
        say(f"{len({row['set'] for row in sets.sets})} sets, {events} events", begun)


if __name__ == "__main__":
    main()
