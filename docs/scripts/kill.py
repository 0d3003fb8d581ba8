"""Kills every command that writes a database, or a file out of one, at random moments, and looks at what is left.

    python3 docs/scripts/kill.py target/release/morec CLIPS LABELS [TIMES]

CLIPS is a folder of clips, a dozen at most, LABELS their table; at least two classes, and `basketball_1.bvh` or any other name
sorted first must be labelled. Every command runs TIMES times (200) on a fresh copy of a database and is ended by SIGKILL after
a random part of the time that it needs. Afterwards

- `morec db check` finds nothing;
- every table holds what it held before, or what it holds after the whole command. An import commits file by file: it may
  stand between the two, clip by clip, and the same import again must complete it;
- a file that is written holds what it held before, or all of what it should.

Caches (feature rows, which are made again) and times of day are left out of the comparison.
"""

import hashlib
import os
import random
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from pathlib import Path

STATE = {
    "files": "SELECT hash, path, format FROM files",
    "refused": "SELECT path, reason FROM refused",
    "clips": """SELECT c.name, f.hash, frames, rate_hz, roles, motion, source, licence, subject
        FROM clips c JOIN files f ON f.id = c.file""",
    "tags": "SELECT c.name, tag FROM tags JOIN clips c ON c.id = clip",
    "segments": """SELECT c.name, method, kind, start_secs, stop_secs FROM segments s JOIN clips c ON c.id = s.clip""",
    "classes": "SELECT name FROM classes",
    "samples": """SELECT c.name, k.name, start_secs, stop_secs, whole_clip, state, score, set_by
        FROM samples s JOIN clips c ON c.id = s.clip JOIN classes k ON k.id = s.class""",
    "indexes": "SELECT name, samples, bytes FROM indexes",
    "history": "SELECT id, what, undone, open FROM edits",
}


def short(value):
    return hashlib.sha256(value).hexdigest() if isinstance(value, bytes) else value


def state(path):
    """The rows of every table, as a set of (table, row)."""
    if not path.exists():
        return frozenset()
    db = sqlite3.connect(path)
    try:
        known = {name for (name,) in db.execute("SELECT name FROM sqlite_schema")}
        if "clips" not in known:
            return frozenset()
        return frozenset((table, tuple(map(short, row))) for table, query in STATE.items() for row in db.execute(query))
    finally:
        db.close()


class Bench:
    """The databases that commands begin with, and the commands."""


    def __init__(self, morec, clips, labels, folder):
        self.morec, self.clips, self.labels, self.folder = Path(morec).resolve(), clips, labels, folder
        first = sorted(clips.iterdir())[0]
        name = first.stem
        half = folder / "half"
        half.mkdir()
        for clip in sorted(clips.iterdir())[::2]:
            shutil.copy(clip, half)
        (half / "no-clip.bvh").write_text("nothing")
        table = labels.read_text().splitlines()
        fixed = folder / "fixed.tsv"
        fixed.write_text("\n".join([table[0]] + [row for row in table[1:] if row.startswith(name + "\t")][1:]) + "\n")
        classes = sorted({row.split("\t")[3] for row in table[1:]})
        self.bases = {base: folder / f"{base}.mdb" for base in ["none", "half", "labelled", "full", "undone", "cold"]}
        base = self.bases
        self.must("db", "import", base["half"], half)
        shutil.copy(base["half"], base["full"])
        for args in [
            ("db", "import", base["full"], clips),
            ("db", "label", base["full"], labels),
            ("cut", base["full"]),
            ("train", "--db", base["full"], "--everyday", "never", "-o", folder / "kept.index"),
            ("group", base["full"], "--name-as", "group"),
            ("db", "propose", base["full"]),
        ]:
            self.must(*args)
        shutil.copy(base["full"], base["undone"])
        self.must("db", "undo", base["undone"])
        shutil.copy(base["full"], base["cold"])
        self.must("db", "vacuum", base["cold"], "--caches")
        shutil.copy(base["half"], base["labelled"])
        self.must("db", "label", base["labelled"], labels)
        rows = sqlite3.connect(base["full"])
        number = rows.execute("SELECT min(id), max(id) FROM samples WHERE state = 'accepted'").fetchone()
        (step,) = rows.execute("SELECT id FROM edits WHERE what LIKE 'keep the index%'").fetchone()
        rows.close()
        self.out = folder / "out"
        full, other = "full", classes[-1]
        db = folder / "x.mdb"
        self.db = db
        # Name, database to begin with, arguments.
        self.commands = [
            ("init", "none", ("db", "init", db)),
            ("import", "none", ("db", "import", db, clips)),
            ("import more", "half", ("db", "import", db, clips, "--tag", "late")),
            ("import --in-place-of", full, ("db", "import", db, sorted(clips.iterdir())[1], "--in-place-of", name)),
            ("clips --add-tag", full, ("db", "clips", db, "--add-tag", "seen", "--set-subject", "ada", "--set-licence", "CC0")),
            ("clips --rename", full, ("db", "clips", db, "--rename", name, "renamed")),
            ("clips --remove", full, ("db", "clips", db, "--clip", name, "--remove")),
            ("clips --set-role", full, ("db", "clips", db, "--set-role", "head=Neck")),
            ("cut", full, ("cut", db, "--penalty", "1.5")),
            ("cut --at", full, ("cut", db, "--clip", name, "--at", "0.5,1")),
            ("cycles --split", full, ("db", "cycles", db, "--of", "labels", "--split")),
            ("group --name-as", full, ("group", db, "--name-as", "kind")),
            ("classes --rename", full, ("db", "classes", db, "--rename", classes[0], "renamed")),
            ("classes --merge", full, ("db", "classes", db, "--merge", classes[0], "--into", other)),
            ("classes --split", full, ("db", "classes", db, "--split", number[0], "--into", "apart")),
            ("classes --forget", full, ("db", "classes", db, "--forget", "group_*")),
            ("label", "half", ("db", "label", db, labels)),
            ("label --replace", full, ("db", "label", db, fixed, "--replace")),
            ("label --class", full, ("db", "label", db, "--clip", name, "--class", "new", "--start", "0.1", "--stop", "0.7")),
            ("label --undo", "labelled", ("db", "label", db, "--undo")),
            ("samples --remove", full, ("db", "samples", db, "--remove", f"{number[0]},{number[1]}")),
            ("samples --move", full, ("db", "samples", db, "--move", number[0], "--start", "0.2", "--stop", "0.9")),
            ("search", "cold", ("db", "search", db, name, "--start", "0.2", "--stop", "1")),
            ("propose", "labelled", ("db", "propose", db)),
            ("propose --accept", full, ("db", "propose", db, "--accept", "0.5", "--reject", "0.1")),
            ("indexes --remove", full, ("db", "indexes", db, "--remove", "kept")),
            ("indexes --write", full, ("db", "indexes", db, "--write", "kept", "-o", self.out.with_suffix(".index"))),
            ("undo", full, ("db", "undo", db)),
            ("undo of an older step", full, ("db", "undo", db, step)),
            ("redo", "undone", ("db", "redo", db)),
            ("export", full, ("db", "export", db, self.out.with_suffix(".tsv"))),
            ("export --motion", full, ("db", "export", db, self.out.with_suffix(".npz"), "--motion", name)),
            ("report", full, ("db", "report", db, "-o", self.out.with_suffix(".html"))),
            ("check --repair", full, ("db", "check", db, "--repair")),
            ("vacuum", full, ("db", "vacuum", db, "--caches", "--history")),
            ("info --forget-refused", full, ("db", "info", db, "--forget-refused")),
            ("train --db", full, ("train", "--db", db, "--everyday", "never", "-o", self.out.with_suffix(".index"))),
        ]

    def run(self, *args):
        # The date goes into indexes.
        environment = dict(os.environ, SOURCE_DATE_EPOCH="1700000000")
        return subprocess.run([self.morec, *map(str, args)], capture_output=True, text=True, cwd=self.folder, env=environment)

    def must(self, *args):
        done = self.run(*args)
        if done.returncode not in (0, 1) or (done.returncode == 1 and args[1] != "import"):
            raise SystemExit(f"{args}: {done.returncode}: {done.stderr}")

    def fresh(self, base):
        for leftover in [*self.folder.glob("x.mdb*"), *self.folder.glob("out.*"), *self.folder.glob(".*.partial")]:
            leftover.unlink()
        if self.bases[base].exists():
            shutil.copy(self.bases[base], self.db)

    def written(self):
        """The files that commands write, by name."""
        return {path.name: path.read_bytes() for path in self.folder.glob("out.*")}

    def kill(self, args, secs):
        """True if it was still running after `secs`."""
        environment = dict(os.environ, SOURCE_DATE_EPOCH="1700000000")
        process = subprocess.Popen(
            [self.morec, *map(str, args)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=self.folder, env=environment
        )
        time.sleep(secs)
        running = process.poll() is None
        if running:
            process.send_signal(signal.SIGKILL)
        process.wait()
        return running

    def measure(self, name, base, args, times):
        """A line of the table: how often it was killed, and what was there then."""
        self.fresh(base)
        before = state(self.db)
        begun = time.monotonic()
        done = self.run(*args)
        secs = time.monotonic() - begun
        if done.returncode not in (0, 1) or (done.returncode == 1 and "import" not in args):
            raise SystemExit(f"{name}: {done.returncode}: {done.stderr}")
        after, whole = state(self.db), self.written()
        count = dict.fromkeys(["killed", "before", "after", "between", "broken"], 0)
        for number in range(times):
            self.fresh(base)
            if not self.kill(args, random.uniform(0, secs)):
                continue
            count["killed"] += 1
            fault = self.fault(before, after, whole, name.startswith("import"), args, count)
            if fault:
                count["broken"] += 1
                print(f"{name}, run {number}: {fault}", flush=True)
        print("\t".join([name, f"{secs:.2f} s", *(f"{what} {n}" for what, n in count.items())]), flush=True)
        return count

    def fault(self, before, after, whole, by_file, args, count):
        if self.db.exists():
            checked = self.run("db", "check", self.db)
            # A file that was made and has no schema yet is finished by the next command that writes.
            if checked.returncode != 0 and state(self.db):
                return checked.stdout + checked.stderr
        now = state(self.db)
        for file, content in self.written().items():
            if content != whole.get(file):
                return f"{file} has {len(content)} bytes of {len(whole.get(file, b''))}"
        if now == before:
            count["before"] += 1
        elif now == after:
            count["after"] += 1
        elif by_file and before & after <= now | {row for row in before if row[0] == "history"} and self.tables(now - before) <= self.tables(after):
            count["between"] += 1
            self.run(*args)
            left = {row for row in state(self.db) ^ after if row[0] != "history"}
            return f"not completed: {left}" if left else None
        else:
            return f"neither before nor after: {sorted(map(str, (now - before) - after))[:5]}"
        return None

    @staticmethod
    def tables(rows):
        return {row for row in rows if row[0] != "history"}


def main():
    morec, clips, labels, *rest = sys.argv[1:]
    times = int(rest[0]) if rest else 200
    random.seed(1)
    total = {}
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(morec, Path(clips).resolve(), Path(labels).resolve(), Path(folder))
        for name, base, args in bench.commands:
            for what, n in bench.measure(name, base, args, times).items():
                total[what] = total.get(what, 0) + n
    print("\t".join(["all", *(f"{what} {n}" for what, n in total.items())]))
    return total["broken"] > 0


if __name__ == "__main__":
    sys.exit(main())
