"""Search: sketches of clips say which to read, the likeliest first, until no other can be among the hits."""

from __future__ import annotations

import os
import zlib
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import daft
import numpy as np
import pyarrow.parquet as pq
from daft import DataFrame, DataType, col

from .. import _morec
from ._layout import clip_number, clip_of
from ._sketches import SketchTable
from ._store import Store, patiently
from ._tasks import Example, Nearest

#: No more clips than these are all looked at closely.
FEW_CLIPS = 1 << 14

#: A clip's number, bones and packed rows.
KeptRows = tuple[int, int, bytes]
#: A clip's key and name.
Names = tuple[str, str]


@dataclass(frozen=True)
class Wanted:
    """Options of a search."""

    limit: int
    mirror: bool
    one_a_clip: bool
    #: If not, it ends when the likeliest clips have been read, although others could be among the hits.
    exact: bool = True

    def native(self) -> tuple[int, bool, bool]:
        """As the native part takes them."""
        return self.limit, self.mirror, self.one_a_clip


@dataclass
class Found:
    """Hits, and how much was looked at for them."""

    hits: list[tuple[str, str, float, float, float, float, bool]]
    #: Clips of which there are sketches, and how many of these were read.
    sketched: int
    read: int


def search(
    store: Store, sketches: Sketched, unsketched: DataFrame | None, example: Example, wanted: Wanted
) -> Found:
    """The hits among the clips of which there are sketches and those of a frame (clip, name, bones, rows) that have none."""
    plan = _morec.SearchPlan(sketches.clips, example.native(), *wanted.native())
    #: Names of clips, and places of those that have sketches.
    names: dict[int, Names] = {}
    read: dict[int, int] = {}
    if unsketched is not None:
        nearest = _nearest_of(unsketched, example, wanted)
        plan.take([row for row, _ in nearest])
        names = {row[0]: name for row, name in nearest}
    while len(places := plan.next_to_read(wanted.exact)):
        rows = sketches.rows(store, places)
        plan.take(rows)
        read |= {row[0]: place for row, place in zip(rows, places.tolist())}
    hits = plan.hits()
    names |= {hit[0]: sketches.name(read[hit[0]]) for hit in hits if hit[0] not in names}
    return Found([(*names[hit[0]], *hit[1:]) for hit in hits], len(sketches), len(read))


class Sketched:
    """Tables of sketches, one after the other; clips are known by their places in all of them together."""

    def __init__(self, tables: Sequence[SketchTable]) -> None:
        self.tables = list(tables)
        self.clips = _morec.SketchedClips([table.native() for table in tables], FEW_CLIPS)
        self.firsts = np.cumsum([0, *(len(table.clip) for table in tables)])

    def __len__(self) -> int:
        return len(self.clips)

    def name(self, place: int) -> Names:
        """Key and name of the clip at a place."""
        at = int(np.searchsorted(self.firsts, place, side="right")) - 1
        table, row = self.tables[at], place - int(self.firsts[at])
        return clip_of(int(table.clip[row])), table.name[row].as_py()

    def rows(self, store: Store, places: Any) -> list[KeptRows]:
        """Rows of the clips at these places, in their order."""
        at_table = np.searchsorted(self.firsts, places, side="right") - 1
        of_parts: dict[str, list[Place]] = {}
        for order, (at, place) in enumerate(zip(at_table.tolist(), places.tolist())):
            table, row = self.tables[at], place - int(self.firsts[at])
            of_parts.setdefault(table.parts[table.part[row]][0], []).append(Place(order, table, row))
        read: list[KeptRows | None] = [None] * len(places)

        def of_part(name: str) -> None:
            for place, packed in zip(of_parts[name], _packed(store, name, of_parts[name])):
                table, row = place.table, place.row
                if zlib.crc32(packed) != table.rows_crc[row]:
                    raise ValueError(f"{store.url(name)}: not what its sketches were made of; create the archive again")
                read[place.order] = (int(table.clip[row]), int(table.bones[row]), packed)

        with ThreadPoolExecutor(min(8, 2 * (os.cpu_count() or 1))) as pool:
            list(pool.map(of_part, of_parts))
        return [row for row in read if row is not None]


@dataclass(frozen=True)
class Place:
    """A clip that is read: its place among those that are asked for, and where it is described."""

    order: int
    table: SketchTable
    row: int


def _packed(store: Store, part: str, places: list[Place]) -> list[bytes]:
    """Packed rows of clips of a part, which is read by positions where these are known, and else by row groups."""
    places.sort(key=lambda place: int(place.table.rows_at[place.row]))
    spans = [(int(place.table.rows_at[place.row]), int(place.table.rows_bytes[place.row])) for place in places]
    if spans[0][0] >= 0:
        return store.ranges(part, spans)
    file = patiently(lambda: pq.ParquetFile(store.open(part)))

    def rows_of(group: int) -> Any:
        return patiently(lambda: file.read_row_group(group, columns=["rows"])).column(0)

    groups = {group: rows_of(group) for group in {int(place.table.row_group[place.row]) for place in places}}
    return [groups[int(p.table.row_group[p.row])][int(p.table.row[p.row])].as_py() or b"" for p in places]


def _nearest_of(frame: DataFrame, example: Example, wanted: Wanted) -> list[tuple[KeptRows, Names]]:
    """The nearest clips of a frame, every row of which is read."""
    numbered = frame.with_column("number", _number(col("clip")))
    worker: Any = Nearest(example, *wanted.native())
    near = worker.run(col("number"), col("bones"), col("rows"))
    answers = numbered.select(near.alias("near")).explode("near").where(~col("near").is_null())
    answers = answers.select(col("near").get("clip").alias("clip"), col("near").get("distance").alias("distance"))
    near_clips = sorted(answers.to_pylist(), key=lambda row: (row["distance"], row["clip"]))
    # Of all parts together as many of the nearest as of each.
    chosen = sorted({row["clip"] for row in near_clips[: _morec.search_windows(wanted.limit)]})
    if not chosen:
        return []
    few = daft.from_pydict({"number": chosen})
    rows = numbered.join(few, on="number").select("number", "name", "clip", "bones", "rows").to_pylist()
    rows.sort(key=lambda row: row["number"])
    return [((row["number"], row["bones"], row["rows"]), (row["clip"], row["name"])) for row in rows]


@daft.func(return_dtype=DataType.int64())
def _number(clip: str) -> int:
    return clip_number(clip)
