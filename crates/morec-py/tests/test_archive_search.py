"""Searching an archive by the sketches of its clips: the hits of reading all rows, of few."""

from __future__ import annotations

import hashlib
import io
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import morec
from morec import _morec

pytest.importorskip("daft")
import pyarrow as pa
import pyarrow.parquet as pq

import morec.archive as ma
from morec.archive import _layout as layout
from morec.archive._search import Found, Sketched, Wanted, search
from morec.archive._store import Store, _by_requests


def slices(archive: ma.Archive, count: int, name: str) -> list[dict[str, Any]]:
    """Stretches of the archive's clips as clips, none quite like another but for every tenth, which is there twice."""
    rng = np.random.default_rng(len(name))
    (part,) = archive._parts("clips")
    rows = [row for row in archive._read_part(part).to_pylist() if row["clip"] is not None]
    values = [_morec.rows_kept(row["bones"], row["rows"]) for row in rows]
    made: list[dict[str, Any]] = []
    for number in range(count):
        at = int(rng.integers(len(rows)))
        start, length = int(rng.integers(0, 200)), int(rng.integers(20, 120))
        cut = values[at][start : start + length]
        moved = np.ascontiguousarray(cut + rng.normal(0, 0.02, cut.shape).astype(np.float32))
        packed = _morec.rows_packed(moved)
        if number % 10 == 9:
            packed = made[-1]["rows"]
        key = hashlib.sha256(f"{name} {number}".encode()).hexdigest()[:16]
        secs = len(moved) / 30
        made.append(rows[at] | {"clip": key, "name": key, "rows": packed, "secs": secs, "file_path": f"{key}.bvh"})
    return made


#: Clips in each of three parts, and in all.
IN_A_PART, IN_ALL = 150, 450


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory, clips: list[morec.Clip]) -> ma.Archive:
    folder = tmp_path_factory.mktemp("search")
    for clip in clips:
        clip[:14.0].save(folder / f"{clip.name}.bvh")
    return ma.create(folder / "base", from_files=f"{folder}/*.bvh")


@pytest.fixture()
def many(tmp_path: Path, base: ma.Archive) -> ma.Archive:
    made = ma.create(tmp_path / "many")
    for name in ("one", "other", "third"):
        content = layout.parquet(slices(base, IN_A_PART, name), layout.CLIP_SCHEMA)
        made.store.write(layout.part_name("clips", [name]), content)
    return made


HOW = [Wanted(1, False, False), Wanted(20, True, False), Wanted(5, False, True), Wanted(200, True, True)]


def found(archive: ma.Archive, example: Any, start: float, stop: float, wanted: Wanted) -> tuple[Found, Found]:
    """By sketches, and by all rows."""
    asked = archive._example(example, start, stop)
    slow = search(archive.store, Sketched([]), archive._clips("name", "bones", "rows"), asked, wanted)
    return archive._search(asked, wanted), slow


def test_the_hits_are_those_of_all_rows(many: ma.Archive, base: ma.Archive, clips: list[morec.Clip]) -> None:
    assert many.add_sketches() == 3 and many.add_sketches() == 0
    own = many.clips().to_pylist()[7]["clip"]
    for example, start, stop in [(clips[0], 2.0, 3.5), (clips[1], 4.0, 4.6), (own, 0.0, 1e6), (clips[2], 0.0, 1e6)]:
        for wanted in HOW:
            fast, slow = found(many, example, start, min(stop, 14.0), wanted)
            assert fast.hits == slow.hits and len(fast.hits) > 0
            assert (fast.sketched, slow.sketched) == (IN_ALL, 0) and fast.read <= IN_ALL
    fast, _ = found(many, clips[0], 2.0, 3.5, HOW[0])
    assert fast.read < 0.9 * IN_ALL, "some clips are not read"


def test_of_many_clips_the_likeliest_are_searched_first(
    many: ma.Archive, clips: list[morec.Clip], monkeypatch: pytest.MonkeyPatch
) -> None:
    many.add_sketches()
    monkeypatch.setattr("morec.archive._search.FEW_CLIPS", 100)
    for wanted in HOW:
        fast, slow = found(many, clips[0], 2.0, 3.5, wanted)
        assert fast.hits == slow.hits and len(fast.hits) > 0
        likely, _ = found(many, clips[0], 2.0, 3.5, replace(wanted, exact=False))
        assert likely.read <= fast.read and len(likely.hits) == len(fast.hits)
    table = many.search(clips[0], 2.0, 3.5, exact=False)
    assert table == many.search(clips[0], 2.0, 3.5), "so few are all read"


def test_sketches_are_missing_stale_or_damaged(many: ma.Archive, base: ma.Archive, clips: list[morec.Clip]) -> None:
    def same(sketched: int) -> None:
        for one in (many, ma.open(many.store.uri)):
            fast, slow = found(one, clips[0], 2.0, 3.5, HOW[1])
            assert fast.hits == slow.hits and fast.sketched == sketched

    same(0)
    many.add_sketches()
    same(IN_ALL)
    # A part that came later, without: it is read whole.
    late = slices(base, 30, "late")
    many.store.write(layout.part_name("clips", ["late"]), layout.parquet(late, layout.CLIP_SCHEMA))
    same(IN_ALL)
    ma.create(many.store.uri)
    same(IN_ALL + 30)
    # A part that is written again with less in it: sketches of what was there do not count.
    many.store.write(layout.part_name("clips", ["late"]), layout.parquet(late[:20], layout.CLIP_SCHEMA))
    same(IN_ALL)
    assert many.add_sketches() == 1
    same(IN_ALL + 20)
    for name, _ in many.store.list("sketches"):
        many.store.write(name, b"PAR1 no table")
    same(0)
    assert many.add_sketches() == 4
    same(IN_ALL + 20)
    for name, _ in many.store.list("sketches"):
        many.store.delete(name)
    same(0)


def test_rows_of_compressed_columns_are_read_by_row_groups(
    many: ma.Archive, clips: list[morec.Clip]
) -> None:
    """As earlier releases wrote them, and one part as it is written now."""
    for name in many._parts("clips")[:2]:
        table = many._read_part(name)
        out = io.BytesIO()
        pq.write_table(table, out, compression="zstd", use_dictionary=False, row_group_size=90)
        many.store.write(name, out.getvalue())
    many.add_sketches()
    known = [table.rows_at >= 0 for table in many._sketches.of(many.store)]
    assert sum(int(of.sum()) for of in known) == IN_A_PART
    for wanted in HOW:
        fast, slow = found(many, clips[0], 2.0, 3.5, wanted)
        assert fast.hits == slow.hits and len(fast.hits) > 0


def test_rows_that_are_not_those_of_the_sketches_are_an_error(many: ma.Archive, clips: list[morec.Clip]) -> None:
    many.add_sketches()
    (table,) = many._sketches.of(many.store)
    for name, _ in table.parts:
        content = bytearray(many.store.read(name))
        for at in table.rows_at[[table.parts[part][0] == name for part in table.part]].tolist():
            content[at + 20] ^= 1
        many.store.write(name, bytes(content))
    with pytest.raises(ValueError, match="not what its sketches were made of"):
        many.search(clips[0], 2.0, 3.5)


def test_stretches_of_a_file_are_those_asked_for(tmp_path: Path) -> None:
    content = bytes(range(256)) * 4000
    store = Store(str(tmp_path))
    store.write("some", content)
    places = [(0, 3), (3, 0), (100, 50), (120, 300), (600_000, 10), (900_000, 7), (len(content) - 2, 9)]
    asked = [content[at : at + size] for at, size in places]
    assert store.ranges("some", places) == asked
    with pa.OSFile(str(tmp_path / "some")) as file:
        assert _by_requests(file, places) == asked
    assert store.ranges("some", []) == []


def test_tables_of_earlier_versions_are_made_again(many: ma.Archive, clips: list[morec.Clip]) -> None:
    many.add_sketches()
    before = sorted(name for name, _ in many.store.list("sketches"))
    many.store.write("sketches/part-0123.parquet", b"PAR1 of an earlier version")
    many.store.delete(before[0])
    assert many.add_sketches() == 3
    assert sorted(name for name, _ in many.store.list("sketches")) == before


def test_clips_that_show_nothing_are_no_hits(many: ma.Archive, base: ma.Archive, clips: list[morec.Clip]) -> None:
    """No bones, no rows, rows that are none, rows beyond what a sketch holds."""
    rows = slices(base, 4, "odd")
    rows[0] |= {"bones": 0, "rows": b"\0\0\0\0"}
    rows[1] |= {"rows": _morec.rows_packed(np.zeros((0, 70), np.float32))}
    rows[2] |= {"rows": b"no rows"}
    rows[3] |= {"rows": _morec.rows_packed(np.full((40, 70), 900, np.float32))}
    many.store.write(layout.part_name("clips", ["odd"]), layout.parquet(rows, layout.CLIP_SCHEMA))
    many.add_sketches()
    for wanted in HOW:
        fast, slow = found(many, clips[0], 2.0, 3.5, wanted)
        assert fast.hits == slow.hits and fast.sketched == IN_ALL + 4


def test_mistakes_are_plain_errors() -> None:
    table = (np.zeros(2, np.int64), np.array([0, 4, 9], np.int32), np.zeros(4, np.uint8))
    with pytest.raises(ValueError, match="beyond the bytes"):
        _morec.SketchedClips([table], 9)
    with pytest.raises(ValueError, match="expected 3, found 2"):
        _morec.SketchedClips([(table[0], table[1][:2], table[2])], 9)
    with pytest.raises(ValueError, match="6 columns for each bone"):
        _morec.rows_packed(np.zeros((3, 8), np.float32))
