"""Time that clusters of 10, 100 and 1,000 cores would need for an archive, from the measured speed of one core.

    python sizing.py FOLDER INDEX [--hours 100000] [--gigabits 10] [--tasks-a-second 200]

FOLDER holds clips. Measured here: processor time of a second of motion in each step, its spread over row groups, bytes of
an hour. Computed: a list of tasks as long as the archive, drawn from what was measured, given out one by one by a scheduler
that needs a fixed time for each; every machine of 16 cores reads over one link. Nothing else is modelled: no failures, no limit
of the store.
"""

from __future__ import annotations

import argparse
import heapq
import random
import tempfile
import time
from pathlib import Path

import morec
import morec.archive as ma
from morec import _morec

#: Seconds of work in a row group, about.
GROUP_SECS = 60.0
#: Tasks that the scheduler starts in a second: an assumption, not measured. `--tasks-a-second` sets another.
TASKS_A_SECOND = 200.0
#: An assumption too.
CORES_A_MACHINE = 16


def measured(archive: ma.Archive, index: morec.Index) -> dict[str, list[tuple[float, float, int]]]:
    """For each step of each clip: seconds of motion, processor seconds, bytes read."""
    rows = archive._clips("motion", "roles", "rest_frames", "bones", "rows", "secs").to_pylist()
    made: dict[str, list[tuple[float, float, int]]] = {"recognize": [], "cuts": []}
    for row in rows:
        begun = time.process_time()
        _morec.recognize_kept(index, [(row["motion"], row["roles"], row["rest_frames"])])
        made["recognize"].append((row["secs"], time.process_time() - begun, len(row["motion"])))
        begun = time.process_time()
        try:
            _morec.cut_kept(row["bones"], row["rows"], None, None, None)
        except (morec.MorecError, ValueError):
            continue
        made["cuts"].append((row["secs"], time.process_time() - begun, len(row["rows"])))
    return made


def makespan(
    cores: int, tasks: list[tuple[float, int]], bytes_a_second: float, tasks_a_second: float
) -> tuple[float, str]:
    """Seconds until the last task is done, and what was busy all the time."""
    machines = max(1, cores // CORES_A_MACHINE)
    link = [0.0] * machines
    free = [(0.0, core % machines) for core in range(cores)]
    heapq.heapify(free)
    last = 0.0
    for number, (work, size) in enumerate(tasks):
        at, machine = heapq.heappop(free)
        at = max(at, number / tasks_a_second)
        read = max(at, link[machine]) + size / bytes_a_second
        link[machine] = read
        done = read + work
        last = max(last, done)
        heapq.heappush(free, (done, machine))
    limits = {
        "cores": sum(work for work, _ in tasks) / cores,
        "links": sum(size for _, size in tasks) / bytes_a_second / machines,
        "scheduler": len(tasks) / tasks_a_second,
        "the longest task": max(work for work, _ in tasks),
    }
    return last, max(limits, key=lambda name: limits[name])


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    parser.add_argument("index")
    parser.add_argument("--hours", type=float, default=100_000.0)
    parser.add_argument("--gigabits", type=float, default=10.0, help="of each machine's link")
    parser.add_argument("--tasks-a-second", type=float, default=TASKS_A_SECOND, help="that the scheduler starts; assumed")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        begun = time.process_time()
        archive = ma.create(Path(folder) / "archive", from_files=args.folder)
        creating = time.process_time() - begun
        steps = measured(archive, morec.load(args.index))
    secs = sum(clip[0] for clip in steps["recognize"])
    print(f"measured: {secs / 3600:.2f} h of motion; create {secs / creating:.0f} s of motion a processor second")
    random.seed(1)
    for step, clips in steps.items():
        work = sum(clip[1] for clip in clips)
        hour = sum(clip[2] for clip in clips) / sum(clip[0] for clip in clips) * 3600
        print(f"measured: {step} {secs / work:.0f} s of motion a processor second, reads {hour / 1e6:.1f} MB an hour")
        # A row group is as many clips in a row as make a minute of work; groups differ as runs of these clips do.
        rate = work / sum(clip[0] for clip in clips)
        group_motion = GROUP_SECS / rate
        groups = []
        for _ in range(max(1, round(args.hours * 3600 / group_motion))):
            shares = [random.choice(clips) for _ in range(20)]
            skew = sum(clip[1] for clip in shares) / sum(clip[0] for clip in shares) / rate
            groups.append((GROUP_SECS * skew, int(hour / 3600 * group_motion)))
        for cores in (10, 100, 1000):
            last, limit = makespan(cores, groups, args.gigabits / 8 * 1e9, args.tasks_a_second)
            ideal = sum(size for size, _ in groups) / cores
            print(
                f"computed: {step}, {args.hours:.0f} h on {cores} cores: {last / 3600:.2f} h in {len(groups)} tasks, "
                f"{ideal / last:.2f} of the ideal; the limit is {limit}"
            )


if __name__ == "__main__":
    main()
