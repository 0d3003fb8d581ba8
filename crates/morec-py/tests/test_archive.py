"""Archives in a local folder, in a store that answers late or with errors, and after accidents."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import morec

daft = pytest.importorskip("daft")
import morec.archive as ma

EVENT = ["class", "start_secs", "stop_secs", "score", "reported_secs"]


@pytest.fixture(scope="module")
def raw(tmp_path_factory: pytest.TempPathFactory, clips: list[morec.Clip]) -> Path:
    """A folder of raw files: six clips, of which one is there twice, and two that are none."""
    made = tmp_path_factory.mktemp("raw")
    (made / "a" / "b").mkdir(parents=True)
    for number, clip in enumerate(clips):
        for half, part in enumerate((clip[:12.0], clip[12.0:24.0])):
            part.save(made / ("a" if number else "a/b") / f"{clip.name}_{half}.bvh")
    first = sorted(made.rglob("*.bvh"))[0]
    (made / "z_copy.bvh").write_bytes(first.read_bytes())
    (made / "broken.bvh").write_text("HIERARCHY\nROOT Hips\n{\n  OFFSET 0 zero 0\n")
    (made / "empty.bvh").write_bytes(b"")
    return made


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory, raw: Path) -> ma.Archive:
    folder = tmp_path_factory.mktemp("archive") / "made"
    return ma.create(folder, from_files=f"{raw}/**/*.bvh", licence="ours")


def tables(archive: ma.Archive) -> dict[str, Any]:
    rows = archive._clips(*[name for name in ma._archive.layout.CLIP_SCHEMA.names if name != "error"]).to_pylist()
    return {row["clip"]: row for row in rows}


def test_files_become_rows_and_faults_become_rows(archive: ma.Archive, raw: Path) -> None:
    info = archive.info()
    assert (info["clips"], info["errors"]) == (6, 3)
    errors = {os.path.basename(row["file_path"]): row["error"] for row in archive.errors().to_pylist()}
    assert "line 4" in errors["broken.bvh"] and "a copy of" in errors["z_copy.bvh"] and errors["empty.bvh"]
    row = next(iter(tables(archive).values()))
    assert row["licence"] == "ours" and row["file_path"].startswith(str(raw)) and row["joints"] > 10


def test_import_again_changes_nothing(archive: ma.Archive, raw: Path) -> None:
    before = archive.store.list()
    ma.create(archive.store.uri, from_files=f"{raw}/**/*.bvh", licence="ours")
    assert archive.store.list() == before


def test_only_what_is_new_is_added(archive: ma.Archive, raw: Path, clips: list[morec.Clip], tmp_path: Path) -> None:
    for path in raw.rglob("*.bvh"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    made = ma.create(tmp_path / "archive", from_files=tmp_path)
    parts = made._parts("clips")
    clips[0][24.0:30.0].save(tmp_path / "new.bvh")
    ma.create(tmp_path / "archive", from_files=f"{tmp_path}/*.bvh")
    assert set(parts) < set(made._parts("clips")) and made.info()["clips"] == 7


def test_tables_are_open_to_others(archive: ma.Archive) -> None:
    import pyarrow.parquet as pq

    parts = [archive.store.url(name) for name in archive._parts("clips")]
    table = pq.read_table(parts[0])
    assert table.schema.names == ma._archive.layout.CLIP_SCHEMA.names
    motion = next(value for value in table.column("motion").to_pylist() if value is not None)
    assert morec.read(motion, name="clip.mclip").frames > 0


def test_recognition_is_that_of_the_clips(archive: ma.Archive, index: morec.Index, tmp_path: Path) -> None:
    found = archive.recognize(index).to_pylist()
    expected = []
    for key, row in tables(archive).items():
        # What is kept, as any reader of .mclip files gets it.
        path = tmp_path / f"{key}.mclip"
        path.write_bytes(row["motion"])
        expected += [(key, *[event[name] for name in EVENT]) for event in index.recognize(morec.read(path))]
    assert sorted((row["clip"], *[row[name] for name in EVENT]) for row in found) == sorted(expected)
    assert len(found) >= 6
    # As an expression over anybody's table, with roles inferred.
    frame = archive._clips("motion").with_column("events", ma.recognize(daft.col("motion"), index))
    again = [(row["clip"], *[event[name] for name in EVENT]) for row in frame.to_pylist() for event in row["events"]]
    assert sorted(again) == sorted(expected)
    nothing = daft.from_pydict({"motion": [b"no motion", None]}).select(ma.recognize(daft.col("motion"), index).alias("e"))
    assert nothing.to_pydict() == {"e": [[], []]}


@pytest.mark.parametrize("parts", [2, 5])
def test_a_divided_index_recognises_the_same(archive: ma.Archive, index: morec.Index, parts: int) -> None:
    whole = archive.recognize(index).to_pylist()
    divided = archive.recognize(index, parts=parts).to_pylist()
    order = lambda rows: sorted(rows, key=repr)  # noqa: E731
    assert whole and order(divided) == order(whole)
    # Less of it in each part, and none of it twice.
    sizes = [len(index.part(part, parts).to_bytes()) for part in range(parts)]
    assert max(sizes) < len(index.to_bytes())
    with pytest.raises(ValueError, match="below 2"):
        index.part(2, 2)


def test_search_and_cuts_are_those_of_a_database(archive: ma.Archive, clips: list[morec.Clip], tmp_path: Path) -> None:
    assert archive.sample().to_database(tmp_path / "all.mdb") == 6
    with morec.Database(tmp_path / "all.mdb") as db:
        name = db.clips().column("clip")[0]
        for how in ({}, {"mirror": True}, {"one_a_clip": True, "limit": 3}):
            for example in (name, clips[0]):
                theirs = db.search(example, 2.0, 3.5, **how)
                ours = archive.search(example, 2.0, 3.5, **how)
                keys = ["start_secs", "stop_secs", "score", "warp_distance", "mirrored"]
                assert [[hit["name"], *[hit[key] for key in keys]] for hit in ours] == [
                    [hit["clip"], *[hit[key] for key in keys]] for hit in theirs
                ]
        cuts = {row["clip"]: row["cuts_secs"] for row in db.cut()}
    assert {row["name"]: row["cuts_secs"] for row in archive.cuts().to_pylist()} == cuts


def test_databases_come_and_go_without_loss(
    archive: ma.Archive, raw: Path, labels: morec.Table, tmp_path: Path
) -> None:
    with morec.Database(tmp_path / "one.mdb", create=True) as db:
        db.import_files(raw / "a", subject="ada", tags=["x", "y"])
        db.label([(name, "wave", 1.0, 2.0) for name in db.clips().column("clip")[:2]])
        names = db.clips().column("clip")
    other = ma.create(tmp_path / "archive", from_database=tmp_path / "one.mdb")
    assert other.add_database(tmp_path / "one.mdb") == 0
    assert other.labels().count_rows() == 2
    other.sample().to_database(tmp_path / "two.mdb")
    ours, theirs = (morec._morec.kept_of_database(str(tmp_path / name)) for name in ("one.mdb", "two.mdb"))
    by_name = lambda rows: {row["name"]: row for row in rows}  # noqa: E731
    assert by_name(ours) == by_name(theirs)
    with morec.Database(tmp_path / "two.mdb") as db:
        assert db.clips().column("clip") == names and len(db.labels()) == 2
    # Files and databases give the same rows.
    mine = tables(archive)
    for key, row in tables(other).items():
        for name in ("motion", "rows", "bones", "roles", "facts", "skeleton", "file_hash", "frames"):
            assert row[name] == mine[key][name], name


def test_labels_groups_moments_and_samples(archive: ma.Archive, labels: morec.Table, tmp_path: Path) -> None:
    names = [row["name"] for row in archive.clips().to_pylist()]
    spans = [(name, "wave" if at % 2 else "bow", 1.0 + at, 2.5 + at) for at in range(4) for name in names]
    assert archive.add_labels(spans) == 24 and archive.add_labels(spans) == 24
    assert archive.labels().count_rows() == 24
    groups = archive.group(groups=3)
    assert len(groups) == 24 and set(groups.column("group")) <= {0, 1, 2}
    assert archive.group(groups=3) == groups and len(archive.group(["bow"])) == 12
    (found,) = archive.moments().values()
    rows = np.concatenate([morec._morec.rows_kept(row["bones"], row["rows"]) for row in tables(archive).values()])
    assert found["rows"] == len(rows)
    np.testing.assert_allclose(found["mean"], rows.mean(axis=0, dtype=np.float64), atol=1e-9)
    np.testing.assert_allclose(found["covariance"], np.cov(rows.T.astype(np.float64), bias=True), atol=1e-9)
    assert archive.sample(2).to_database(tmp_path / "two.mdb") == 2
    assert archive.sample(2, seed=1).keys == archive.sample(2, seed=1).keys
    assert len(archive.sample(names[:3]).keys or ()) == 3
    with pytest.raises(KeyError, match="nobody"):
        archive.add_labels([("nobody", "wave", 1.0, 2.0)])


def test_mistakes_are_plain_errors(archive: ma.Archive, tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        ma.open(tmp_path / "nowhere")
    with pytest.raises(FileNotFoundError, match="no such files"):
        ma.create(tmp_path / "empty", from_files=tmp_path / "*.bvh")
    with pytest.raises(ValueError, match="holds no clip yet"):
        ma.open(tmp_path / "empty").clips()
    (tmp_path / "new").mkdir()
    (tmp_path / "new" / "archive.json").write_text('{"layout": 99}')
    with pytest.raises(ValueError, match="use a newer morec"):
        ma.open(tmp_path / "new")
    (tmp_path / "new" / "archive.json").write_text("[]")
    with pytest.raises(ValueError, match="not that of an archive"):
        ma.open(tmp_path / "new")
    with pytest.raises(KeyError, match="expected one clip"):
        archive.clip("nobody")
    with pytest.raises(ValueError, match="at least 0.1 s"):
        archive.search(archive.clips().to_pylist()[0]["clip"], 1.0, 1.01)


def test_the_commands(archive: ma.Archive, raw: Path, index: morec.Index, tmp_path: Path) -> None:
    index.save(tmp_path / "signs.index")

    def run(*args: object) -> str:
        command = [sys.executable, "-m", "morec.archive", *map(str, args)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    run("create", tmp_path / "archive", "--from-files", f"{raw}/**/*.bvh")
    assert '"clips": 6' in run("info", tmp_path / "archive")
    lines = run("recognize", tmp_path / "archive", tmp_path / "signs.index").splitlines()
    assert len(lines) == 1 + archive.recognize(index).count_rows()
    name = archive.clips().to_pylist()[0]["clip"]
    assert len(run("search", tmp_path / "archive", name, "--start", 1, "--stop", 2.5, "--limit", 3).splitlines()) == 4


def test_a_driver_that_is_killed_leaves_whole_parts(raw: Path, archive: ma.Archive, tmp_path: Path) -> None:
    program = (
        "import sys, morec.archive as ma\n"
        "from morec.archive import _create\n"
        "_create.TASK_FILES = 1\n"
        "ma.create(sys.argv[1], from_files=sys.argv[2])\n"
    )
    target, pattern = tmp_path / "archive", f"{raw}/**/*.bvh"
    child = subprocess.Popen([sys.executable, "-c", program, str(target), pattern])
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline and len(list(target.glob("clips/*.parquet"))) < 2 and child.poll() is None:
        time.sleep(0.01)
    child.send_signal(signal.SIGKILL)
    child.wait()
    made = ma.create(target, from_files=pattern, licence="ours")
    ours, whole = tables(made), tables(archive)
    for rows in (ours, whole):
        for row in rows.values():
            row["licence"] = None
    assert ours == whole and made.info()["errors"] == 3


def test_the_guide_runs(
    index: morec.Index, clips: list[morec.Clip], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "clips").mkdir()
    for number, clip in enumerate(clips[:2], 1):
        clip[:10.0].save(tmp_path / "clips" / f"signals_{number}.bvh")
    index.save(tmp_path / "mine.index")
    text = (Path(__file__).parents[3] / "docs/guide/archive.md").read_text(encoding="utf-8")
    blocks = text.split("```python\n")[1:]
    names: dict[str, Any] = {}
    for block in blocks:
        exec(block.split("```")[0], names)
    assert len(blocks) == 2 and len(names["hits"]) > 0


@pytest.fixture()
def bucket() -> Iterator[dict[str, str]]:
    """A store that answers every fifth request late and every seventh with an error."""
    server = pytest.importorskip("moto.server")
    import threading

    import boto3
    from werkzeug.serving import make_server

    inner = server.DomainDispatcherApplication(server.create_backend_app)
    lock, count = threading.Lock(), [0]

    def unreliable(environ: Any, start: Any) -> Any:
        with lock:
            count[0] += 1
            number = count[0]
        if number > 10 and number % 5 == 0:
            time.sleep(0.05)
        if number > 10 and number % 7 == 0:
            start("503 Service Unavailable", [("Content-Length", "0")])
            return [b""]
        return inner(environ, start)

    served = make_server("127.0.0.1", 0, unreliable, threaded=True)
    thread = threading.Thread(target=served.serve_forever, daemon=True)
    thread.start()
    s3 = {
        "endpoint_url": f"http://127.0.0.1:{served.port}", "key_id": "test", "access_key": "test",
        "region_name": "us-east-1",
    }  # fmt: skip
    client = boto3.client(
        "s3", endpoint_url=s3["endpoint_url"], aws_access_key_id="test", aws_secret_access_key="test",
        region_name="us-east-1",
    )  # fmt: skip
    client.create_bucket(Bucket="bucket")
    yield s3
    served.shutdown()


def test_a_store_that_answers_late_or_with_errors(
    bucket: dict[str, str], raw: Path, archive: ma.Archive, index: morec.Index
) -> None:
    store = ma.Store("s3://bucket/raw", bucket)
    for path in raw.rglob("*.bvh"):
        store.write(str(path.relative_to(raw)), path.read_bytes())
    made = ma.create("s3://bucket/archive", from_files="s3://bucket/raw/**/*.bvh", licence="ours", s3=bucket)
    assert made.info()["clips"] == 6 and made.info()["errors"] == 3
    ours, local = tables(made), tables(archive)
    for rows in (ours, local):
        for row in rows.values():
            row["file_path"] = None
    assert ours == local
    rows = [sorted(map(repr, one.recognize(index).to_pylist())) for one in (made, archive)]
    assert rows[0] == rows[1]


def test_motions_that_repeat_are_found_in_all_clips(tmp_path: Path) -> None:
    from morec.synth import database

    clips, labels = database(7, people=4, repetitions=4, classes=["wave", "bow"])
    for clip in clips:
        clip.save(tmp_path / f"{clip.name}.bvh")
    archive = ma.create(tmp_path / "archive", from_files=f"{tmp_path}/*.bvh")
    half = sum(clip.duration_secs for clip in clips) / 2 / 60
    sets = archive.discover(minutes=half, rounds=2)
    # Not every clip was compared in the first round, and each set has one number in both.
    assert {row["set"] for row in sets.sets} == {int(found["name"].removeprefix("set_")) for found in sets.index.classes}
    of_motion: dict[str, set[str]] = {}
    found = 0
    events = sets.events.to_pylist()
    for label in labels:
        overlapping = [
            event["class"]
            for event in events
            if event["name"] == label["clip"]
            and min(event["stop_secs"], label["stop_secs"]) - max(event["start_secs"], label["start_secs"]) > 0.3
        ]
        found += bool(overlapping)
        of_motion.setdefault(label["class"], set()).update(overlapping)
    assert found >= 0.8 * len(labels) and not of_motion["wave"] & of_motion["bow"]
    with pytest.raises(ValueError, match="more than 0 minutes"):
        archive.discover(minutes=0)
