"""Reading a folder of BVH files: morec beside the packages bvh, bvhio and pybvh, in one run, in processor time.

    pip install bvh bvhio pybvh
    python reading.py FOLDER [FILES]

What each gives differs: `bvh` leaves numbers as text, `bvhio.readAsBvh` and `pybvh` give channels; morec gives rotations, roles, units,
and with `positions` the joints in the world.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import morec


def measured(name: str, read: Callable[[Path], object], files: list[Path], bytes_: int) -> None:
    failed = 0
    # Processor time, so that what else the machine does does not count.
    begun = time.process_time()
    for path in files:
        try:
            read(path)
        except Exception:
            failed += 1
    secs = time.process_time() - begun
    print(f"{name}\t{secs:.2f} s\t{bytes_ / 1e6 / secs:.1f} MB/s\t{failed} of {len(files)} refused", flush=True)


def main() -> None:
    files = sorted(Path(sys.argv[1]).rglob("*.bvh"))[: int(sys.argv[2]) if len(sys.argv) > 2 else None]
    bytes_ = sum(path.stat().st_size for path in files)
    print(f"{len(files)} files, {bytes_ / 1e6:.1f} MB")
    for path in files:
        path.read_bytes()
    begun, cpu = time.perf_counter(), time.process_time()
    clips = morec.read_folder(files, progress=False)
    secs, cpu = time.perf_counter() - begun, time.process_time() - cpu
    print(f"morec.read_folder\t{cpu:.2f} s\t{bytes_ / 1e6 / cpu:.1f} MB/s a core\t{len(clips)} clips, {secs:.2f} s by the clock")
    measured("morec.read", morec.read, files, bytes_)
    measured("morec.read and positions", lambda path: morec.read(path).positions, files, bytes_)
    import bvh
    import bvhio
    import pybvh

    measured("pybvh.read_bvh_file", lambda path: pybvh.read_bvh_file(str(path)), files, bytes_)
    measured("bvh.Bvh", lambda path: bvh.Bvh(path.read_text()), files, bytes_)
    measured("bvhio.readAsBvh", lambda path: bvhio.readAsBvh(str(path)), files, bytes_)


if __name__ == "__main__":
    main()
