"""Search in an archive of many hours, made of real clips that are perturbed.

    python search.py FOLDER... [--hours 1300] [--archive PATH] [--compare N] [--seed 1]

The clips below the folders are imported; then their feature rows (not their motion, which importing 1,300 hours would take an
hour for) are perturbed until there are enough hours: another pace, wider or smaller movements, poses that lean another way,
smooth noise, beginnings and ends cut off. Rows are packed as an import packs them, in parts of an hour of motion; beside them lies
the motion of the clip that they are from, so that files have their usual size. Then it searches by stretches of the clips as
they were: movements at random, the quietest and the liveliest one, and whole clips; exactly, and by the likeliest clips alone. With --compare N, N
of the answers are compared with those of reading all rows.
"""

from __future__ import annotations

import argparse
import hashlib
import multiprocessing
import resource
import shutil
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

import morec
import morec.archive as ma
from morec import _morec
from morec.archive import _layout as layout
from morec.archive._search import Found, Sketched, Wanted, search
from morec.archive._sketches import Part, made_of, table_name
from morec.archive._store import Store

HZ = 30.0
#: Seconds of motion by which cuts are counted: what `morec cut` finds on average in the clips of signals.
SEGMENT_SECS = 4.7


def perturbed(rows: Any, rng: np.random.Generator) -> Any:
    """Rows as somebody else might have moved."""
    bones = (rows.shape[1] - 4) // 6
    pace = float(np.exp(rng.uniform(np.log(0.75), np.log(1.33))))
    count = max(int(len(rows) / pace), 3)
    at = np.linspace(0, len(rows) - 1, count)
    below = np.minimum(at.astype(int), len(rows) - 2) if len(rows) > 1 else np.zeros(count, int)
    share = (at - below)[:, None].astype(np.float32)
    made = rows[below] * (1 - share) + rows[np.minimum(below + 1, len(rows) - 1)] * share
    directions = made[:, : 3 * bones]
    mean = directions.mean(axis=0)
    directions = mean + (directions - mean) * rng.uniform(0.8, 1.2)
    lean = rng.normal(0, 0.06, 3 * bones)
    knots = rng.normal(0, 0.03, (count // 10 + 2, 3 * bones))
    places = np.arange(count) / 10
    floor = places.astype(int)
    noise = knots[floor] + (knots[floor + 1] - knots[floor]) * (places - floor)[:, None]
    shaped = (directions + lean + noise).reshape(count, bones, 3)
    shaped /= np.maximum(np.linalg.norm(shaped, axis=2, keepdims=True), 1e-6)
    made[:, : 3 * bones] = shaped.reshape(count, 3 * bones)
    made[:, 3 * bones :] *= pace * rng.uniform(0.9, 1.1)
    first, last = rng.integers(0, max(count // 8, 1), 2)
    return np.ascontiguousarray(made[first : count - last], dtype=np.float32)


def parts(task: tuple[str, range, str, int]) -> int:
    """Writes parts of an hour each, and their sketches; how many clips they hold."""
    uri, numbers, base, seed = task
    store = ma.open(uri).store
    if base not in _BASE:
        _BASE[base] = base_rows(ma.open(base))
    done = [part(store, number, _BASE[base], seed) for number in numbers]
    made = [one for one, _ in done]
    store.write(table_name(made), made_of(store, made))
    return sum(clips for _, clips in done)


def part(store: Store, number: int, clips: list[dict[str, Any]], seed: int) -> tuple[Part, int]:
    rng = np.random.default_rng([seed, number])
    rows: list[dict[str, Any]] = []
    ticks = 0
    while ticks < 3600 * HZ:
        row = clips[rng.integers(len(clips))]
        values = perturbed(row["values"], rng)
        ticks += len(values)
        key = hashlib.sha256(f"{number} {len(rows)} {seed}".encode()).hexdigest()[:16]
        fields = {name: value for name, value in row.items() if name != "values"}
        packed = _morec.rows_packed(values)
        rows.append(fields | {"clip": key, "rows": packed, "secs": len(values) / HZ, "file_path": f"{key}.bvh"})
    name, content = layout.part_name(layout.CLIPS, [f"{number} {seed}"]), layout.parquet(rows, layout.CLIP_SCHEMA)
    store.write(name, content)
    return (name, len(content)), len(rows)


_BASE: dict[str, list[dict[str, Any]]] = {}


def base_rows(archive: ma.Archive) -> list[dict[str, Any]]:
    rows = []
    for name in archive._parts(layout.CLIPS):
        for row in archive._read_part(name).to_pylist():
            if row["clip"] is not None and row["bones"]:
                row["values"] = _morec.rows_kept(row["bones"], row["rows"])
                if len(row["values"]) >= 10:
                    rows.append(row)
    return rows


def make(uri: str, base: ma.Archive, hours: float, seed: int) -> None:
    ma.create(uri)
    count = max(round(hours), 1)
    # As many parts to a table of sketches as `create` gives it.
    tasks = [(uri, range(at, min(at + 10, count)), base.store.uri, seed) for at in range(0, count, 10)]
    begun = time.perf_counter()
    with multiprocessing.get_context("spawn").Pool() as pool:
        clips = sum(pool.imap_unordered(parts, tasks))
    print(f"{clips} clips made in {time.perf_counter() - begun:.0f} s", flush=True)


def examples(base: ma.Archive, seed: int, count: int) -> list[tuple[str, str, float, float, dict[str, Any]]]:
    """The example and the options: name, clip, start, stop, options."""
    rng = np.random.default_rng(seed)
    found, moved = [], []
    clips = _BASE.get(base.store.uri) or base_rows(base)
    for row in clips:
        values = row["values"][:, : (row["values"].shape[1] - 4) // 2]
        for start in range(0, len(values) - 45, 15):
            moved.append((float(values[start : start + 45].std(axis=0).sum()), row, start / HZ))
    moved.sort(key=lambda one: one[0])
    places = {"the quietest": 0, "of the quietest tenth": len(moved) // 20, "the middle": len(moved) // 2, "the liveliest": -1}
    for name, place in places.items():
        _, row, start = moved[place]
        found.append((f"{name}, {row['name']}", row["clip"], start, start + 1.5, {}))
    for at in rng.integers(len(moved), size=count):
        _, row, start = moved[at]
        found.append((f"at random, {row['name']}", row["clip"], start, start + 1.5, {}))
    _, row, start = moved[len(moved) // 2]
    found.append((f"mirrored too, {row['name']}", row["clip"], start, start + 1.5, {"mirror": True}))
    found.append((f"whole clips, {row['name']}", row["clip"], 0.0, 1e6, {"one_a_clip": True}))
    found.append((f"100 hits, {row['name']}", row["clip"], start, start + 1.5, {"limit": 100}))
    return found


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--hours", type=float, default=1300.0)
    parser.add_argument("--archive")
    parser.add_argument("--compare", type=int, default=0)
    parser.add_argument("--examples", type=int, default=8)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    home = Path(tempfile.mkdtemp(prefix="morec-search-"))
    try:
        base = ma.create(home / "base")
        for folder in args.folders:
            ma.create(home / "base", from_files=folder)
        uri = args.archive or str(home / "archive")
        if not Path(uri).exists():
            make(uri, base, args.hours, args.seed)
        archive = ma.open(uri)
        begun = time.perf_counter()
        new = archive.add_sketches()
        print(f"sketches of {new} parts in {time.perf_counter() - begun:.0f} s", flush=True)
        size = {table: sum(size for _, size in archive.store.list(table)) / 1e6 for table in ("clips", "sketches")}
        info = archive.info()
        hours = info["hours"]
        print(
            f"{info['clips']} clips, {hours:.0f} hours ({hours * 3600 / SEGMENT_SECS:.0f} segments of {SEGMENT_SECS} s); "
            f"clips {size['clips']:.0f} MB, sketches {size['sketches']:.0f} MB",
            flush=True,
        )
        report(archive, base, args.compare, args.seed, args.examples)
    finally:
        shutil.rmtree(home)


@dataclass
class Timed:
    """An answer, the time that it took by the clock and of the processor."""

    found: Found
    secs: float
    processor: float

    @staticmethod
    def of(answer: Callable[[], Found]) -> Timed:
        begun, used = time.perf_counter(), time.process_time()
        found = answer()
        return Timed(found, time.perf_counter() - begun, time.process_time() - used)

    def __str__(self) -> str:
        return f"{self.secs:.2f} s ({self.processor:.2f} of processor time), {self.found.read} clips read"


def stretches(found: Found) -> set[tuple[str, float, float, bool]]:
    """Where hits are; scores depend on the other windows that are found."""
    return {(clip, start, stop, mirrored) for clip, _, start, stop, _, _, mirrored in found.hits}


def report(archive: ma.Archive, base: ma.Archive, compare: int, seed: int, count: int) -> None:
    answers = []
    for number, (name, clip, start, stop, options) in enumerate(examples(base, seed, count)):
        wanted = Wanted(options.get("limit", 20), options.get("mirror", False), options.get("one_a_clip", False))
        shown = base.clip(clip)
        asked = archive._example(shown, start, min(stop, shown.duration_secs))
        # As a new process would, with the sketches to read; then with them in memory.
        archive = ma.open(archive.store.uri)
        first, again = (Timed.of(lambda: archive._search(asked, wanted)) for _ in range(2))
        quick = Timed.of(lambda: archive._search(asked, replace(wanted, exact=False)))
        answers.append((first, again, quick))
        same = len(stretches(again.found) & stretches(quick.found))
        said = f"{same} of {len(again.found.hits)} hits"
        if number < compare:
            begun = time.perf_counter()
            slow = search(archive.store, Sketched([]), archive._clips("name", "bones", "rows"), asked, wanted)
            said += f"; all rows: {time.perf_counter() - begun:.1f} s, the same hits: {slow.hits == again.found.hits}"
        print(f"{name}: first {first}; again {again}; likeliest {quick}, {said}", flush=True)
    for what, of_all in zip(("first", "again", "likeliest"), zip(*answers)):
        for kind, of_kind in (("", lambda one: one.secs), (" (processor)", lambda one: one.processor)):
            values = sorted(map(of_kind, of_all))
            print(f"{what}{kind}: median {values[len(values) // 2]:.2f} s, most {values[-1]:.2f} s")
    print(f"{resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6:.1f} GB of memory at most")


if __name__ == "__main__":
    main()
