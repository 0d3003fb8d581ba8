"""Speed of two Ray workers of one processor each against one, on this machine.

    python workers.py FOLDER INDEX [--times 40] [--repeats 3]

FOLDER holds clips. They are imported, multiplied under other keys, and recognised by clusters of one and of two workers in turn,
each a program of its own that recognises a few clips first. Printed are the seconds of each and the ratio of their medians.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import morec.archive as ma

from archive import multiplied


def recognise(archive: str, index: str, workers: int) -> None:
    """One measurement; prints seconds and the number of events."""
    import ray
    from ray.cluster_utils import Cluster

    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 0, "include_dashboard": False})
    for _ in range(workers):
        cluster.add_node(num_cpus=1)
    ma.use_ray(cluster.address)
    opened = ma.open(archive)
    # Starts the workers, and loads the library in each.
    opened.recognize(index).limit(1).collect()
    begun = time.perf_counter()
    events = opened.recognize(index).count_rows()
    print(f"{time.perf_counter() - begun:.2f} {events}")
    ray.shutdown()
    # Also forgets the address, which programs that start later would connect to.
    cluster.shutdown()


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    parser.add_argument("index")
    parser.add_argument("--times", type=int, default=40)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--workers", type=int, help="recognise the archive FOLDER once with N workers")
    args = parser.parse_args()
    if args.workers:
        recognise(args.folder, args.index, args.workers)
        return
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "archive")
        archive = ma.create(path, from_files=args.folder)
        multiplied(archive, args.times)
        print(f"{archive.info()['hours']:.2f} hours", flush=True)
        secs: dict[int, list[float]] = {1: [], 2: []}
        for _ in range(args.repeats):
            for workers, found in secs.items():
                command = [sys.executable, __file__, path, args.index, "--workers", str(workers)]
                # One processor for each worker: the library would use all that it finds.
                env = {**os.environ, "RAYON_NUM_THREADS": "1"}
                done = subprocess.run(command, check=True, capture_output=True, text=True, env=env)
                taken, events = done.stdout.split()[-2:]
                found.append(float(taken))
                print(f"{workers} workers: {taken} s, {events} events", flush=True)
        one, two = (statistics.median(secs[n]) for n in (1, 2))
        print(f"two workers are {one / two:.2f} times as fast as one")


if __name__ == "__main__":
    main()
