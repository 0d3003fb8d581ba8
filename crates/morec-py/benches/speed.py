"""Cost of a pushed frame and of an hour of features.

    python speed.py INDEX CLIP.bvh

A push is timed from Python, its share included, over the clip played again and again.
"""

from __future__ import annotations

import sys
import time

import numpy as np

import morec


def main() -> None:
    index, clip = morec.load(sys.argv[1]), morec.read(sys.argv[2])
    live = index.recognizer(clip)
    poses = [np.ascontiguousarray(pose) for pose in clip.positions]
    costs, secs = [], 0.0
    cpu = time.process_time()
    while len(costs) < 100_000:
        for pose in poses:
            begun = time.perf_counter_ns()
            live.push(secs, pose)
            costs.append(time.perf_counter_ns() - begun)
            secs += 1 / clip.rate_hz
    cpu = time.process_time() - cpu
    micros = np.array(costs[1000:]) / 1000
    p50, p99 = np.percentile(micros, [50, 99])
    print(f"push: {1e6 * cpu / len(costs):.2f} µs of processor time a frame, the clock's reading in; by the clock median {p50:.2f} µs, p99 {p99:.2f} µs, {len(costs)} frames at {clip.rate_hz:g} Hz")
    nothing = []
    pose = poses[0]
    for _ in range(100_000):
        begun = time.perf_counter_ns()
        # A pose of the past is looked at and left: what the call itself costs.
        live.push(0.0, pose)
        nothing.append(time.perf_counter_ns() - begun)
    print(f"the call alone: median {np.median(nothing) / 1000:.2f} µs")
    full = clip.resampled(120.0)
    times = int(np.ceil(3600 * 120 / len(full)))
    begun = time.process_time()
    rows = sum(len(morec.features(full)) for _ in range(times))
    secs = time.process_time() - begun
    hours = times * full.duration_secs / 3600
    print(f"features: {secs / hours:.2f} s of processor time an hour at 120 Hz ({rows} rows)")


if __name__ == "__main__":
    main()
