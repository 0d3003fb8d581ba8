"""The package and the command give the same."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

import morec


@pytest.fixture(autouse=True)
def fixed_date(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")


@pytest.fixture(scope="module")
def background(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("background")
    for clip in morec.synth.everyday(7, clips=2):
        clip.save(made / f"{clip.name}.bvh")
    return made


def test_the_same_index_byte_for_byte(
    command: Callable[..., str], folder: Path, labels_tsv: Path, background: Path, tmp_path: Path
) -> None:
    theirs = tmp_path / "theirs.index"
    command(
        "train", "--clips", folder, "--labels", labels_tsv, "--background", background,
        "--everyday", "never", "--param", "rho=0.4", "--mirror", "yes", "--bones", "upper", "-o", theirs,
    )  # fmt: skip
    ours = morec.train(
        folder, labels_tsv, background=background, everyday="never", params={"rho": 0.4}, mirror="yes", bones="upper"
    )
    assert ours.to_bytes() == theirs.read_bytes()


def test_the_same_index_with_the_defaults(
    command: Callable[..., str], folder: Path, labels_tsv: Path, tmp_path: Path
) -> None:
    theirs = tmp_path / "theirs.index"
    command("train", "--clips", folder, "--labels", labels_tsv, "-o", theirs)
    assert morec.train(folder, labels_tsv).to_bytes() == theirs.read_bytes()


def test_the_same_detections(
    command: Callable[..., str], index: morec.Index, folder: Path, tmp_path: Path
) -> None:
    path = tmp_path / "signs.index"
    index.save(path)
    lines = command("recognize", path, folder, "--format", "jsonl").splitlines()
    theirs = [json.loads(line) for line in lines]
    ours = index.recognize(folder)
    keys = ["clip", "class", "start_secs", "stop_secs", "score", "reported_secs"]
    assert [[row[key] for key in keys] for row in theirs] == [[row[key] for key in keys] for row in ours]
    assert len(ours) > 5


def test_the_same_measures(command: Callable[..., str], folder: Path, labels_tsv: Path) -> None:
    theirs = json.loads(
        command("crossval", "--clips", folder, "--labels", labels_tsv, "--by", "person", "--everyday", "never", "--json")
    )
    ours = morec.crossval(folder, labels_tsv, by="person", everyday="never")
    assert theirs.pop("format_version") == 1
    assert ours.missed == theirs.pop("missed")
    assert ours.left_out == theirs.pop("left_out") == "each person in turn, 3 people"
    assert ours.evaluation == theirs


def test_the_same_cuts(command: Callable[..., str], folder: Path) -> None:
    path = sorted(folder.iterdir())[0]
    for method in ("kernel", "ppca"):
        theirs = json.loads(command("cut", path, "--method", method, "--json"))[0]
        ours = morec.cut(morec.read(path), method=method)
        assert [cut["secs"] for cut in theirs["cuts"]] == ours["cuts_secs"].tolist()


def test_the_same_database(command: Callable[..., str], folder: Path, tmp_path: Path) -> None:
    path = tmp_path / "moves.mdb"
    with morec.Database(path, create=True) as db:
        db.import_files(folder)
        name = db.clips().column("clip")[0]
        hits = db.search(name, 2.0, 3.5, limit=5)
        cuts = db.cut()
    theirs = json.loads(command("db", "search", path, name, "--start", 2.0, "--stop", 3.5, "--limit", 5, "--json"))
    assert [(hit["clip"], hit["start_secs"], hit["score"]) for hit in theirs["hits"]] == [
        (hit["clip"], hit["start_secs"], pytest.approx(hit["score"], abs=1e-7)) for hit in hits
    ]
    theirs = json.loads(command("cut", path, "--json"))
    assert [clip.pop("format_version") for clip in theirs] == [1] * len(theirs)
    assert theirs == list(cuts)
