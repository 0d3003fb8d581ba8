"""Cost of an archive on this machine, and its projection to many.

    python archive.py FOLDER INDEX [--command path/of/morec] [--times N] [--ray]

FOLDER holds clips; they are imported, then recognised, cut and searched. With --times the archive holds every clip N times, under
other keys, for searching among more.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import tempfile
import time
from pathlib import Path

import morec
import morec.archive as ma
from morec.archive import _layout as layout


def processor_secs() -> float:
    """Of this program and of all that it started and waited for."""
    own, others = resource.getrusage(resource.RUSAGE_SELF), resource.getrusage(resource.RUSAGE_CHILDREN)
    return own.ru_utime + own.ru_stime + others.ru_utime + others.ru_stime


class Measured:
    def __init__(self, what: str) -> None:
        self.what = what

    def __enter__(self) -> Measured:
        self.begun, self.cpu = time.perf_counter(), processor_secs()
        return self

    def __exit__(self, *_: object) -> None:
        self.secs, self.cpu = time.perf_counter() - self.begun, processor_secs() - self.cpu
        print(f"{self.what}: {self.secs:.2f} s by the clock, {self.cpu:.2f} s of processor time", flush=True)


def multiplied(archive: ma.Archive, times: int) -> None:
    """Copies of every clip under other keys."""
    rows = [
        row for part in archive._parts("clips") for row in archive._read_part(part).to_pylist() if row["clip"] is not None
    ]
    for number in range(1, times):
        copies = [{**row, "clip": f"{(int(row['clip'], 16) + number) % (1 << 64):016x}"} for row in rows]
        archive.store.write(f"clips/part-copy{number:06}.parquet", layout.parquet(copies, layout.CLIP_SCHEMA))


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    parser.add_argument("index")
    parser.add_argument("--command")
    parser.add_argument("--times", type=int, default=1)
    parser.add_argument("--ray", action="store_true")
    args = parser.parse_args()
    if args.ray:
        ma.use_ray()
    with tempfile.TemporaryDirectory() as folder:
        with Measured("create"):
            archive = ma.create(Path(folder) / "archive", from_files=args.folder)
        info = archive.info()
        print(info, flush=True)
        index = morec.load(args.index)
        with Measured("recognize") as ours:
            found = archive.recognize(index).to_pylist()
        hours = info["hours"]
        print(f"  {len(found)} events; {hours * 3600 / ours.cpu:.0f} s of motion a second and core", flush=True)
        if args.command:
            clips = Path(folder) / "mclips"
            clips.mkdir()
            for row in archive._clips("motion").to_pylist():
                (clips / f"{row['clip']}.mclip").write_bytes(row["motion"])
            with Measured("the command, on the same clips") as theirs:
                command = [args.command, "recognize", args.index, str(clips), "-o", str(Path(folder) / "found.tsv")]
                subprocess.run(command, check=True, capture_output=True)
            lines = (Path(folder) / "found.tsv").read_text().splitlines()
            same = len(lines) - 1 == len(found)
            print(f"  as many events: {same}; speed of the archive against the command {theirs.cpu / ours.cpu:.2f}", flush=True)
        with Measured("cuts"):
            archive.cuts().collect()
        if args.times > 1:
            multiplied(archive, args.times)
            print(archive.info()["hours"], "hours to search", flush=True)
        clip = archive.clips().to_pylist()[0]["clip"]
        with Measured("search"):
            archive.search(clip, 1.0, 2.5, limit=20)


if __name__ == "__main__":
    main()
