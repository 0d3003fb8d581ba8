"""The database."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import morec


@pytest.fixture()
def db(folder: Path, tmp_path: Path) -> morec.Database:
    made = morec.Database(tmp_path / "moves.mdb", create=True)
    made.import_files(folder)
    return made


def test_clips_come_in_once_and_come_out(db: morec.Database, folder: Path, clips: list[morec.Clip]) -> None:
    assert set(db.import_files(folder).column("outcome")) == {"known"}
    rows = db.clips()
    assert rows.column("clip") == sorted(clip.name for clip in clips)
    out = db.clip(clips[0].name)
    assert out.frames == clips[0].frames and out.roles == clips[0].roles
    assert np.abs(out.positions - clips[0].positions).max() < 0.006
    assert db.summary()["clips"] == 3 and "3 clips" in repr(db)
    with pytest.raises(KeyError, match="no clip is called"):
        db.clip("nobody")


def test_what_cannot_be_read_is_a_row(db: morec.Database, tmp_path: Path) -> None:
    broken = tmp_path / "broken.bvh"
    broken.write_text("HIERARCHY nothing")
    told = db.import_files(broken)
    assert told.column("outcome") == ["refused"] and "line 1" in told[0]["notes"][0]


def test_what_is_nearly_there_is_noted(
    db: morec.Database, clips: list[morec.Clip], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    clips[0][0.0 : 0.9 * clips[0].duration_secs].save(tmp_path / "shorter.bvh")
    monkeypatch.chdir(tmp_path)
    told = db.import_files("shorter.bvh", subject="ada", tags=["again"])
    assert told.column("outcome") == ["imported"]
    assert any(f"shorter is nearly the same as {clips[0].name}" in note for note in told[0]["notes"])
    assert db.clips(tag="again", subject="ada").column("clip") == ["shorter"]
    # The same file is the same path, from whichever folder it is named.
    assert db.import_files(tmp_path / "shorter.bvh").column("outcome") == ["known"]
    with pytest.raises(ValueError, match="did you mean `source`"):
        db.import_files("shorter.bvh", sources="here")  # type: ignore[call-arg]


def test_labels_search_cut_and_propose(db: morec.Database, labels: morec.Table, clips: list[morec.Clip]) -> None:
    first = [row for row in labels if row["clip"] == clips[0].name]
    assert db.label(first)["added"] == len(first)
    assert db.label(first)["added"] == 0
    kept = db.labels()
    assert [row["class"] for row in kept] == [row["class"] for row in sorted(first, key=lambda r: r["start_secs"])]
    example = first[0]
    hits = db.search(clips[0], example["start_secs"], example["stop_secs"], limit=5)
    assert len(hits) == 5 and hits[0]["clip"] == clips[0].name
    assert abs(hits[0]["start_secs"] - example["start_secs"]) < 0.2
    by_name = db.search(clips[0].name, example["start_secs"], example["stop_secs"], limit=5, mirror=True)
    assert len(by_name) == 5
    groups = db.group(of="labels", method="hierarchy", groups=3)
    assert set(groups.column("group")) == {1, 2, 3} and len(groups) == len(first)
    assert set(groups.column("class")) == {row["class"] for row in first}
    cuts = db.cut()
    assert len(db.group()) > 3
    assert len(cuts) == 3 and all(row["cuts_secs"] for row in cuts)
    proposed = db.propose()
    assert len(proposed) > 3 and proposed.column("score") == sorted(proposed.column("score"), reverse=True)
    assert len(db.labels(state="proposed")) == len(proposed)
    accepted, rejected = db.judge(accept=0.5, reject=0.5)
    assert accepted + rejected == len(proposed)
    assert len(db.labels()) == len(first) + accepted
    # What the database holds trains.
    index = morec.train([db.clip(name) for name in db.clips().column("clip")], db.labels(), everyday="never")
    assert index.class_names == ["bow", "clap", "wave"]


def test_mistakes_are_plain_errors(db: morec.Database, tmp_path: Path) -> None:
    name = db.clips().column("clip")[0]
    with pytest.raises(KeyError, match="nobody"):
        db.label([("nobody", "wave", 1.0, 2.0)])
    with pytest.raises(ValueError, match="state"):
        db.labels(state="maybe")
    with pytest.raises(ValueError, match="at least 0.1 s"):
        db.search(name, 5.0, 5.01)
    with pytest.raises(KeyError):
        db.search("nobody")
    with pytest.raises(ValueError, match="method"):
        db.cut(method="scissors")
    with pytest.raises(KeyError):
        db.propose(classes=["nothing"])
    with pytest.raises(KeyError):
        db.group(of="labels", classes=["nothing"])
    with pytest.raises(ValueError, match="k must be 1 or more"):
        db.group(of="clips", method="kwas", k=0)
    with pytest.raises(FileNotFoundError):
        morec.Database(tmp_path / "nowhere.mdb")
    (tmp_path / "no.mdb").write_text("not a database at all, but long enough to be looked at as if it were one" * 20)
    with pytest.raises(morec.MorecError, match=r"no\.mdb"):
        morec.Database(tmp_path / "no.mdb")
    db.close()
    db.close()
    with pytest.raises(ValueError, match="closed"):
        db.clips()
    assert "closed" in repr(db)
