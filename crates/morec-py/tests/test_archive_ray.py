"""Archives on Ray, two workers on this machine: the same answers, also when a worker is killed.

Where ray is installed; a minute and a half.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

import morec

pytest.importorskip("ray")
pytest.importorskip("daft")
import morec.archive as ma

PROGRAM = """
import json, os, signal, sys, threading, time
from pathlib import Path
import ray
ray.init(address="local", num_cpus=2, include_dashboard=False, log_to_driver=False, configure_logging=False)
import morec.archive as ma
from morec.archive import _create
ma.use_ray()
_create.TASK_FILES = 1
target, pattern, index, kill = sys.argv[1:]

def children(pid):
    found = []
    for task in Path("/proc").glob("[0-9]*"):
        try:
            if int((task / "stat").read_text().rsplit(")", 1)[1].split()[1]) == pid:
                found += [int(task.name), *children(int(task.name))]
        except (OSError, ValueError, IndexError):
            pass
    return found

def kill_one():
    # As soon as something has been written, a worker of this run dies.
    while not list(Path(target).glob("clips/*.parquet")):
        time.sleep(0.01)
    for pid in children(os.getpid()):
        try:
            name = Path(f"/proc/{pid}/cmdline").read_bytes()
        except OSError:
            continue
        # The worker that computes; Ray's own agents and the coordinator belong to the driver.
        own = (b"ray::IDLE", b"ray::Dashboard", b"ray::RuntimeEnv", b"ray::RemoteFlotilla")
        if name.startswith(b"ray::") and not name.startswith(own):
            os.kill(pid, signal.SIGKILL)
            print("killed", name[:60], file=sys.stderr)
            return

if kill == "kill":
    threading.Thread(target=kill_one, daemon=True).start()
a = ma.create(target, from_files=pattern)
rows = a.recognize(index).to_pylist()
divided = a.recognize(index, parts=2).to_pylist()
cuts = a.cuts().to_pylist()
hits = a.search(sorted(row["clip"] for row in cuts)[0], 1.0, 2.5)
print(json.dumps({"rows": rows, "divided": divided, "cuts": cuts, "hits": list(hits), "errors": a.errors().count_rows()}))
"""


@pytest.mark.parametrize("accident", ["none", "kill"])
def test_two_workers_give_what_one_machine_gives(
    clips: list[morec.Clip], index: morec.Index, tmp_path: Path, accident: str
) -> None:
    raw = tmp_path / "raw"
    raw.mkdir()
    for number, clip in enumerate(clips):
        clip[:12.0].save(raw / f"take_{number}.bvh")
        clip[12.0:24.0].save(raw / f"take_{number + 3}.bvh")
    # Every twentieth file is broken; there are seven here.
    (raw / "broken.bvh").write_text("HIERARCHY nothing")
    index.save(tmp_path / "signs.index")
    pattern = f"{raw}/*.bvh"
    command = [sys.executable, "-c", PROGRAM, tmp_path / "on_ray", pattern, tmp_path / "signs.index", accident]
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False, timeout=900)
    assert done.returncode == 0, done.stderr[-3000:]
    found = json.loads(done.stdout.splitlines()[-1])
    native = ma.create(tmp_path / "native", from_files=pattern)
    order = lambda rows: sorted(rows, key=repr)  # noqa: E731
    assert order(found["rows"]) == order(native.recognize(index).to_pylist())
    assert order(found["divided"]) == order(found["rows"])
    assert order(found["cuts"]) == order(native.cuts().to_pylist())
    name = sorted(row["clip"] for row in native.cuts().to_pylist())[0]
    assert found["hits"] == list(native.search(name, 1.0, 2.5)) and found["errors"] == 1
    if accident == "kill":
        assert "killed" in done.stderr
