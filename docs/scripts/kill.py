"""Kills commands that write a database at random moments, and checks that it is whole each time.

    python3 docs/scripts/kill.py target/release/morec CLIPS [TIMES]

CLIPS is a folder of clips with labels.tsv beside it or in it, a few dozen at most. Every command runs on a fresh copy of a
database, is ended by SIGKILL after a random part of the time it needs, and `morec db check` must then find nothing.
"""

import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path


def run(morec, *args, **options):
    return subprocess.run([morec, *map(str, args)], capture_output=True, text=True, **options)


def main():
    morec, clips, *rest = sys.argv[1:]
    times = int(rest[0]) if rest else 200
    labels = next(p for p in [Path(clips) / "labels.tsv", Path(clips).parent / "labels.tsv"] if p.is_file())
    random.seed(1)
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        base = folder / "base.mdb"
        for args in [("db", "import", base, clips), ("db", "label", base, labels), ("db", "cut", base)]:
            done = run(morec, *args)
            assert done.returncode in (0, 1), (args, done.stderr)
        commands = {
            "import": lambda db: ("db", "import", db, clips),
            "label": lambda db: ("db", "label", db, labels),
            "cut": lambda db: ("db", "cut", db),
            "group": lambda db: ("db", "group", db),
            "undo": lambda db: ("db", "undo", db),
            "export": lambda db: ("db", "export", db, folder / "out.tsv"),
        }
        tally = {}
        for number in range(times):
            name = list(commands)[number % len(commands)]
            db = folder / "x.mdb"
            for leftover in folder.glob("x.mdb*"):
                leftover.unlink()
            if name != "import":
                shutil.copy(base, db)
            args = [morec, *map(str, commands[name](db))]
            if name not in tally:
                begun = time.monotonic()
                subprocess.run(args, capture_output=True)
                tally[name] = [time.monotonic() - begun, 0, 0]
                for leftover in folder.glob("x.mdb*"):
                    leftover.unlink()
                if name != "import":
                    shutil.copy(base, db)
            process = subprocess.Popen(args, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(random.uniform(0, tally[name][0]))
            killed = process.poll() is None
            process.send_signal(signal.SIGKILL) if killed else None
            process.wait()
            tally[name][1] += killed
            if db.exists():
                checked = run(morec, "db", "check", db)
                if checked.returncode != 0:
                    print(f"run {number}, {name}: {checked.stdout}{checked.stderr}")
                    tally[name][2] += 1
        for name, (secs, killed, broken) in tally.items():
            print(f"{name}\t{secs:.2f} s\tkilled {killed}\tbroken {broken}")


if __name__ == "__main__":
    main()
